// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/growth.h"
#include "vera/theory/space_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "theory/rectangles.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using Random = std::mt19937_64;
using testing::Rectangles;
using testing::SlopedRays;

struct Answers {
    std::size_t rays = 0;
    std::size_t met = 0;
};

void compare(const Rectangles& rectangles, const SlopedRays& rays, Answers& answers) {
    const FirstRectangles expected = brute_force_first_rectangles(rectangles, rays);
    ASSERT_EQ(sweep_first_rectangles(rectangles, rays), expected);
    answers.rays += rays.size();
    for (const auto& first : expected)
        answers.met += first ? 1 : 0;
}

TEST(SpaceSweep, FindsTheRectanglesThatLookingAtEachFinds) {
    Random random(1988);
    Answers answers;
    for (int round = 0; round < 500; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            const std::int32_t reach = round % 2 == 0 ? 3 : 7;
            const std::size_t count = random() % 40;
            const Rectangles rectangles = round % 5 == 0
                ? testing::repeated_rectangles(count, random)
                : testing::rectangles_within(count, reach, round % 3 == 0 ? 2 : 2 * reach, random);
            const std::size_t rays = random() % 120;
            compare(rectangles, family.rays(rays, reach + 1, 2, random), answers);
            ASSERT_FALSE(HasFatalFailure()) << family.name << ", round " << round;
        }
    EXPECT_GT(answers.rays, 100000U);
    EXPECT_GT(answers.met, 20000U);
    EXPECT_GT(answers.rays - answers.met, 20000U);
}

TEST(SpaceSweep, AnswersAtTheLargestNumbers) {
    Random random(5);
    Answers answers;
    for (int round = 0; round < 30; ++round) {
        constexpr std::int32_t most = largest_plane_coordinate;
        compare(
            testing::rectangles_within(40, most, most, random),
            testing::sloped_rays_within(60, most, round % 2 == 0 ? most : 1, random),
            answers);
    }
    EXPECT_GT(answers.met, 50U);
}

TEST(SpaceSweep, AnswersManyRaysAmongManyRectangles) {
    Random random(6);
    Answers answers;
    compare(
        testing::rectangles_within(1500, 1000, 100, random),
        testing::sloped_rays_within(2000, 1000, 4, random),
        answers);
    EXPECT_GT(answers.met, 100U);
}

/// All rectangles that a ray meets within where it begins and ends, by looking at each.
std::vector<std::uint32_t>
met_by(const Rectangles& rectangles, const SlopedRay& ray, std::int32_t last_z) {
    std::vector<std::uint32_t> met;
    for (std::uint32_t i = 0; i < rectangles.size(); ++i)
        if (rectangles[i].z <= last_z && meets(ray, rectangles[i]))
            met.push_back(i);
    std::sort(met.begin(), met.end(), [&](std::uint32_t a, std::uint32_t b) {
        return rectangles[a].z != rectangles[b].z ? rectangles[a].z < rectangles[b].z : a < b;
    });
    return met;
}

TEST(SpaceSweep, TellsAllThatARayMeetsUpToItsEndAndNoMore) {
    Random random(7);
    std::size_t told = 0;
    for (int round = 0; round < 200; ++round) {
        const Rectangles rectangles = testing::rectangles_within(30, 6, 9, random);
        const SlopedRays rays = testing::sloped_rays_within(40, 6, 2, random);
        std::vector<std::int32_t> last_z(rays.size());
        for (std::int32_t& z : last_z)
            z = testing::any_within(8, random);
        std::vector<std::vector<std::uint32_t>> met(rays.size());
        // After its second rectangle a ray goes on for one more z.
        sweep(rectangles, {rays, last_z}, [&](std::uint32_t rectangle, std::uint32_t ray) {
            met[ray].push_back(rectangle);
            return met[ray].size() < 2 ? std::numeric_limits<std::int32_t>::max()
                                       : rectangles[met[ray][1]].z + 1;
        });
        for (std::size_t i = 0; i < rays.size(); ++i) {
            auto expected = met_by(rectangles, rays[i], last_z[i]);
            if (expected.size() > 2) {
                const std::int32_t end = rectangles[expected[1]].z + 1;
                std::erase_if(expected, [&](std::uint32_t r) { return rectangles[r].z > end; });
            }
            ASSERT_EQ(met[i], expected);
            told += expected.size();
        }
    }
    EXPECT_GT(told, 2000U);
}

/// How the steps of m rays among m rectangles grow beyond what the paper says of them:
/// (m + k) log^2 m + n log^2 m + I.
Growth growth_beyond_bound(
    SlopedRays (*rays)(std::size_t, std::int32_t, std::int32_t, Random&),
    std::uint64_t& swaps,
    Random& random) {
    constexpr std::int32_t reach = 20000;
    std::vector<double> sizes;
    std::vector<double> ratios;
    for (const std::size_t count : {64U, 96U, 128U, 192U, 256U, 384U, 512U, 768U, 1024U}) {
        const double side = 2 * reach / std::sqrt(static_cast<double>(count));
        const Rectangles rectangles =
            testing::rectangles_within(count, reach, static_cast<std::int32_t>(side), random);
        SweepCounts counts;
        sweep_first_rectangles(rectangles, rays(count, reach, 40, random), &counts);
        const auto m = static_cast<double>(count);
        const double squared_logarithm = std::log2(m) * std::log2(m);
        const auto crossings = static_cast<double>(counts.x_swaps + counts.y_swaps);
        sizes.push_back(m);
        ratios.push_back(
            static_cast<double>(counts.steps())
            / ((2 * m + crossings) * squared_logarithm + static_cast<double>(counts.reports)));
        swaps += counts.x_swaps + counts.y_swaps;
    }
    return growth(sizes, ratios);
}

TEST(SpaceSweep, TakesStepsThatGrowNoFasterThanThePaperSays) {
    Random random(8);
    for (const auto rays :
         {testing::sloped_rays_within, testing::nearly_parallel_rays, testing::pencil_of_rays}) {
        std::uint64_t swaps = 0;
        const Growth found = growth_beyond_bound(rays, swaps, random);
        EXPECT_LT(found.exponent - found.uncertainty, 0) << "beyond the bound";
        EXPECT_LT(found.uncertainty, 0.2) << "tells nothing";
        EXPECT_EQ(swaps == 0, rays == testing::pencil_of_rays) << "those of one point never cross";
    }
}

TEST(SpaceSweep, ComparesNoDepthsSinceRectanglesComeInTheirOrder) {
    Random random(12);
    for (const std::int32_t side : {2000, 5000, 20000}) {
        const Rectangles rectangles = testing::rectangles_within(512, 20000, side, random);
        const SlopedRays rays = testing::pencil_of_rays(512, 20000, 1, random);
        std::uint64_t pairs = 0;
        for (const SlopedRay& ray : rays)
            for (const IsoRectangle& rectangle : rectangles)
                pairs += meets(ray, rectangle) ? 1 : 0;
        // As a depth buffer does it: everything that a ray meets is told, and compared.
        SweepCounts all;
        std::uint64_t told = 0;
        const auto tells = [&](std::uint32_t /*rectangle*/, std::uint32_t /*ray*/) {
            ++told;
            return largest_plane_coordinate;
        };
        sweep(rectangles, {rays}, tells, &all);
        EXPECT_EQ(told, pairs);
        EXPECT_EQ(all.reports, pairs);
        SweepCounts first;
        const FirstRectangles found = sweep_first_rectangles(rectangles, rays, &first);
        const auto met =
            std::ranges::count_if(found, [](const auto& of) { return of.has_value(); });
        EXPECT_EQ(first.reports, static_cast<std::uint64_t>(met)) << "each is told once";
        RecordProperty("pairs_" + std::to_string(side), std::to_string(pairs));
        RecordProperty("told_" + std::to_string(side), std::to_string(first.reports));
    }
}

TEST(SpaceSweep, IsRefusedBeforeMemoryRunsOut) {
    const Rectangles rectangles(3);
    const SlopedRays rays(200'000);
    const MemoryLimit little(1);
    try {
        sweep_first_rectangles(rectangles, rays);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(
            error.what(),
            ::testing::AllOf(
                ::testing::StartsWith("a sweep through 3 rectangles with 200000 rays takes about "),
                ::testing::EndsWith(": fewer rays at a time take less")));
    }
}

TEST(SpaceSweep, RefusesWhatItCannotHold) {
    const auto refusal = [](const Rectangles& rectangles, const SlopedRays& rays) -> std::string {
        try {
            sweep_first_rectangles(rectangles, rays);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(
        refusal({{0, 1, 0, 0, 0}}, {}),
        "rectangle 0 has a lower side above its upper side: exchange the two");
    EXPECT_EQ(
        refusal({}, {{0, 0, 0, 0, 1073741825}}),
        "ray 0 has the number 1073741825, and the largest magnitude is 1073741824: scale "
        "everything down");
}

TEST(SpaceSweep, TellsHowFarItIsAndCanBeStopped) {
    Random random(10);
    const Rectangles rectangles = testing::rectangles_within(500, 1000, 50, random);
    const SlopedRays rays = testing::sloped_rays_within(100, 1000, 3, random);
    double last = 0;
    int calls = 0;
    sweep_first_rectangles(rectangles, rays, nullptr, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
        ++calls;
    });
    EXPECT_EQ(last, 1);
    EXPECT_GT(calls, 3);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(sweep_first_rectangles(rectangles, rays, nullptr, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
