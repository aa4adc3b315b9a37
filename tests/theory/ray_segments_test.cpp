// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/growth.h"
#include "vera/theory/ray_segments.h"

#include <bit>
#include <cmath>
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
using testing::any_within;
using testing::Rectangles;
using testing::rectangles_within;
using testing::SlopedRays;

TEST(RaySegments, TellTheRaysThatLookingAtEachTells) {
    Random random(1988);
    std::size_t some = 0;
    for (int round = 0; round < 150; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            // Of few values: many cross in one place, and where others begin.
            const SlopedRays rays = family.rays(random() % 25, 5, 2, random);
            const RaySegments segments(rays);
            for (const IsoRectangle& rectangle : rectangles_within(60, 6, 6, random)) {
                const auto expected = brute_force_rays_met(rectangle, rays);
                ASSERT_EQ(segments.rays_met(rectangle), expected) << family.name;
                some += expected.empty() || expected.size() == rays.size() ? 0 : 1;
            }
        }
    EXPECT_GT(some, 4000U);
}

TEST(RaySegments, AnswerWhereRaysCrossAndJustBesideThat) {
    Random random(2);
    std::size_t some = 0;
    for (int round = 0; round < 40; ++round) {
        const std::int32_t reach = round % 2 == 0 ? 1000 : largest_plane_coordinate;
        const SlopedRays rays = testing::sloped_rays_within(12, reach, 50, random);
        const RaySegments segments(rays);
        for (int query = 0; query < 200; ++query) {
            const PlanePoint a = x_point(rays[random() % rays.size()]);
            const PlanePoint b = x_point(rays[random() % rays.size()]);
            std::int64_t z = a.x == b.x ? 0 : (std::int64_t{b.y} - a.y) / (a.x - b.x);
            z += any_within(1, random);
            if (std::abs(z) > largest_plane_coordinate)
                continue;
            const auto at = static_cast<std::int32_t>(z);
            const std::int64_t x = value_at(a, at) + any_within(1, random);
            if (std::abs(x) > largest_plane_coordinate / 2)
                continue;
            const auto border = static_cast<std::int32_t>(x);
            const std::int32_t all = largest_plane_coordinate;
            const IsoRectangle rectangle = query % 2 == 0
                ? IsoRectangle{at, border, all, -all, all}
                : IsoRectangle{at, -all, border, -all, all};
            const auto expected = brute_force_rays_met(rectangle, rays);
            ASSERT_EQ(segments.rays_met(rectangle), expected);
            some += expected.empty() ? 0 : 1;
        }
    }
    EXPECT_GT(some, 1000U);
}

TEST(RaySegments, AreCutByTheirOwnCrossingsAlone) {
    const auto segments = [](SlopedRays rays) {
        for (SlopedRay& ray : rays)
            ray.first_z = -100;
        return RaySegments(rays).segment_count();
    };
    EXPECT_EQ(segments({}), 0U);
    EXPECT_EQ(segments({{1, 0, 0, 0}}), 1U);
    EXPECT_EQ(segments({{1, 0, 0, 0}, {1, 5, 0, 0}}), 2U) << "along each other";
    EXPECT_EQ(segments({{1, 0, 0, 0}, {-1, 5, 0, 0}}), 4U) << "across in x";
    EXPECT_EQ(segments({{1, 0, 2, 0}, {-1, 5, 3, 7}}), 6U) << "and in y, at another z";
    EXPECT_EQ(segments({{1, 0, 0, 0}, {-1, 5, 0, 0}, {0, 9, 0, 0}}), 9U);
    EXPECT_EQ(segments({{1, 0, 0, 0}, {-1, 0, 0, 0}, {0, 0, 0, 0}}), 6U) << "all in one place";
    EXPECT_EQ(segments({{1, 0, 0, 0}, {1, 0, 0, 0}}), 2U) << "equal";
    EXPECT_EQ(segments({{1, 0, 0, 0}, {-1, 1000, 0, 0}}), 4U);
    EXPECT_EQ(segments({{1, 0, 0, 0}, {-1, -1000, 0, 0}}), 2U) << "before they begin";
}

/// All begin before everything.
SlopedRays lines(std::size_t count, Random& random) {
    SlopedRays rays = testing::sloped_rays_within(count, 1'000'000'000, 1000, random);
    for (SlopedRay& ray : rays)
        ray.first_z = -largest_plane_coordinate;
    return rays;
}

/// Where such lines cross each other, each meeting some of them.
Rectangles rectangles_amid(std::size_t count, Random& random) {
    Rectangles made = rectangles_within(count, 1'000'000'000, 1'000'000'000, random);
    for (IsoRectangle& rectangle : made)
        rectangle.z = any_within(1'000'000, random);
    return made;
}

TEST(RaySegments, TakeNoMoreStepsThanTheirTreesAllow) {
    Random random(3);
    for (const std::size_t count : {1U, 7U, 50U, 150U}) {
        const RaySegments segments(lines(count, random));
        const auto bits = static_cast<std::uint64_t>(std::bit_width(count));
        for (const IsoRectangle& rectangle : rectangles_amid(300, random)) {
            StepCounts counts;
            segments.rays_met(rectangle, &counts);
            ASSERT_LE(counts.nodes, segments.height());
            // A row of rays falls into two of each length at most.
            ASSERT_LE(counts.searches, counts.nodes * (1 + 2 * bits));
            ASSERT_LE(counts.points, counts.searches * 2 * (bits + 1));
        }
    }
}

TEST(RaySegments, GrowNoFasterThanThePaperSays) {
    Random random(4);
    std::vector<double> sizes;
    std::vector<double> steps;
    std::vector<double> bytes;
    for (std::size_t count = 16; count <= 256; count *= 2) {
        const RaySegments segments(lines(count, random));
        StepCounts counts;
        for (const IsoRectangle& rectangle : rectangles_amid(1000, random))
            segments.rays_met(rectangle, &counts);
        const double logarithm = std::log2(static_cast<double>(count));
        sizes.push_back(static_cast<double>(count));
        steps.push_back(static_cast<double>(counts.nodes + counts.points) / std::pow(logarithm, 4));
        bytes.push_back(static_cast<double>(segments.bytes()) / std::pow(logarithm, 2));
    }
    const Growth of_steps = growth(sizes, steps);
    EXPECT_LT(of_steps.exponent - of_steps.uncertainty, 0);
    EXPECT_LT(of_steps.uncertainty, 0.3);
    const Growth of_bytes = growth(sizes, bytes);
    EXPECT_LT(of_bytes.exponent - of_bytes.uncertainty, 2);
    EXPECT_LT(of_bytes.uncertainty, 0.3);
    RecordProperty("steps", std::to_string(of_steps.exponent));
    RecordProperty("bytes", std::to_string(of_bytes.exponent));
}

TEST(RaySegments, TakeTheMemoryThatIsForecast) {
    Random random(5);
    for (const testing::RayFamily& family : testing::ray_families())
        for (const std::size_t count : {0U, 1U, 30U, 100U}) {
            const SlopedRays rays = family.rays(count, 100'000, 1000, random);
            const auto bytes = static_cast<double>(RaySegments(rays).bytes());
            const double forecast = RaySegments::bytes_forecast(rays);
            EXPECT_LE(bytes, forecast) << family.name << ' ' << count;
            EXPECT_GE(bytes, 0.99 * forecast) << family.name << ' ' << count;
        }
}

std::string refusal(const SlopedRays& rays) {
    try {
        const RaySegments segments(rays);
    } catch (const std::runtime_error& error) {
        return error.what();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(RaySegments, AreRefusedBeforeMemoryRunsOut) {
    Random random(6);
    const auto ends = ::testing::EndsWith(
        ": fewer rays take less, half of them about a fifth; trees of a part of them each can be "
        "asked in turn");
    const MemoryLimit little(1);
    EXPECT_THAT(
        refusal(SlopedRays(10'000)),
        ::testing::AllOf(
            ::testing::StartsWith("finding where 10000 rays cross each other takes about "), ends));
    EXPECT_THAT(
        refusal(lines(500, random)),
        ::testing::AllOf(
            ::testing::ContainsRegex("^a segment tree of the [0-9]+ segments of 500 rays takes"),
            ends));
}

TEST(RaySegments, RefuseWhatTheyCannotHold) {
    EXPECT_EQ(
        refusal({{}, {0, 1073741825, 0, 0, 0}}),
        "ray 1 has the number 1073741825, and the largest magnitude is 1073741824: scale "
        "everything down");
    const RaySegments segments(SlopedRays(3));
    EXPECT_THROW(segments.rays_met({0, 2, 1, 0, 0}), std::invalid_argument);
}

TEST(RaySegments, TellHowFarTheyAreAndCanBeStopped) {
    Random random(8);
    const SlopedRays rays = lines(60, random);
    double last = 0;
    const RaySegments segments(rays, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(RaySegments(rays, {}, &cancel), Cancelled);
    EXPECT_THROW(RaySegments::bytes_forecast(rays, &cancel), Cancelled);
}

} // namespace
} // namespace vera
