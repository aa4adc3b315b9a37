// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/simd_level.h"
#include "vera/accel/sphere_crossing.h"
#include "vera/accel/sphere_index.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>

#include "expected_answers.h"
#include "sample_spheres.h"
#include "sphere_brute_force.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::ball_of_balls;
using testing::brute_force_answer;
using testing::brute_force_answers;
using testing::close_shells;
using testing::coherent_mesh_rays;
using testing::expect_answers;
using testing::mixed_spheres;
using testing::places_about;
using testing::random_mesh_rays;
using testing::random_spheres;
using testing::rays_cut_at;
using testing::rays_of_lights;
using testing::SampleMesh;
using testing::SampleSpheres;
using testing::scaled_and_shifted;
using testing::small_spheres_beside_large;
using testing::SphereAnswer;
using testing::told;
using testing::with_broken_numbers;

constexpr IndexQuality both_qualities[] = {IndexQuality::usual, IndexQuality::high};
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Rays of all sorts, some of which begin and end just where others meet the spheres.
std::vector<IndexRay> rays_of_all_sorts(const SampleSpheres& spheres, std::uint64_t seed) {
    const SampleMesh places = places_about(spheres);
    std::vector<IndexRay> rays = random_mesh_rays(seed, places, 400);
    for (const IndexRay& ray : coherent_mesh_rays(seed, places, 400))
        rays.push_back(ray);
    for (const IndexRay& ray : rays_of_lights(seed, places, 400))
        rays.push_back(ray);
    const std::size_t uncut = rays.size();
    for (std::size_t i = 0; i < uncut; i += 7) {
        const SphereAnswer answer = brute_force_answer(spheres, rays[i]);
        if (!answer.met)
            continue;
        for (const SphereHit& hit : {answer.nearest, answer.all[answer.all.size() / 2]})
            for (const IndexRay& ray : rays_cut_at(rays[i], hit.t))
                rays.push_back(ray);
    }
    return rays;
}

struct Family {
    std::string name;
    std::uint64_t seeds = 1;
    std::function<SampleSpheres(std::uint64_t seed)> make;

    friend void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }
};

Family few_spheres(std::string name, float factor, float offset) {
    return {std::move(name), 12, [=](std::uint64_t seed) {
                return scaled_and_shifted(random_spheres(seed, 1 + 4 * seed), factor, offset);
            }};
}

class EverySpheres : public ::testing::TestWithParam<Family> {};

INSTANTIATE_TEST_SUITE_P(
    Families,
    EverySpheres,
    ::testing::Values(
        few_spheres("FewSpheres", 1, 0),
        few_spheres("FewSmallSpheres", 0x1p-60F, 0),
        few_spheres("FewVerySmallSpheres", 1e-30F, 0),
        few_spheres("FewSpheresAsSmallAsCanBe", 1e-44F, 0),
        few_spheres("FewLargeSpheres", 0x1p60F, 0),
        few_spheres("FewVeryLargeSpheres", 1e30F, 0),
        few_spheres("FewSpheresAsLargeAsCanBe", 5e37F, 0),
        few_spheres("FewSpheresFarAway", 1, 1e6F),
        few_spheres("FewSmallSpheresFarAway", 0.001F, -3),
        Family{"ManySpheres", 2, [](auto seed) { return random_spheres(seed, 600); }},
        Family{
            "SmallBesideLarge",
            12,
            [](auto seed) { return small_spheres_beside_large(seed, 1 + 4 * seed); }},
        Family{"CloseShells", 12, [](auto seed) { return close_shells(seed, 2 + 3 * seed); }},
        Family{"MixedSizes", 12, [](auto seed) { return mixed_spheres(seed, 8 * seed); }},
        Family{
            "BrokenNumbers",
            6,
            [](auto seed) { return with_broken_numbers(random_spheres(seed, 8 * seed), seed); }},
        Family{"BallOfBalls", 2, [](auto seed) { return ball_of_balls(10 + 15 * seed); }}),
    [](const auto& family) { return family.param.name; });

TEST_P(EverySpheres, AreAnsweredLikeByBruteForceOnEveryBit) {
    for (std::uint64_t seed = 0; seed < GetParam().seeds; ++seed) {
        const SampleSpheres spheres = GetParam().make(seed);
        const auto rays = rays_of_all_sorts(spheres, seed);
        const auto expected = brute_force_answers(spheres, rays);
        for (const IndexQuality quality : both_qualities) {
            const SphereIndex index(spheres, quality);
            const std::string name = quality == IndexQuality::usual ? "usual" : "high";
            expect_answers(index, rays, expected, name + ", seed " + std::to_string(seed));
        }
        if (HasFailure())
            return;
    }
}

TEST_P(EverySpheres, GiveTheSameBitsWithEveryInstructionSet) {
    const std::uint64_t seed = GetParam().seeds - 1;
    const SampleSpheres spheres = GetParam().make(seed);
    const auto rays = rays_of_all_sorts(spheres, seed + 1000);
    const auto expected = brute_force_answers(spheres, rays);
    const SphereIndexStatistics statistics = SphereIndex(spheres).statistics();
    for (const std::string& level : simd_levels()) {
        ASSERT_TRUE(limit_simd(level));
        const SphereIndex index(spheres);
        EXPECT_EQ(index.statistics(), statistics) << level;
        expect_answers(index, rays, expected, level);
    }
    EXPECT_TRUE(limit_simd(""));
}

// The arithmetic itself, against the equation in more digits.

/// How far the square of the ray's distance from the center is below that of the radius, and the
/// size of the numbers that it is made of.
struct Depth {
    long double depth = 0;
    long double size = 0;
};

Depth depth_of(const IndexRay& ray, const std::array<float, 4>& sphere) {
    long double dot = 0;
    long double square = 0;
    long double way_square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto d = static_cast<long double>(ray.direction[axis]);
        const long double way =
            static_cast<long double>(sphere[axis]) - static_cast<long double>(ray.origin[axis]);
        dot += d * way;
        square += d * d;
        way_square += way * way;
    }
    const auto r = static_cast<long double>(sphere[3]);
    return {r * r - way_square + dot * dot / square, way_square + r * r};
}

TEST(SphereHits, AreThereWhereMoreDigitsSaySo) {
    const SampleSpheres spheres = random_spheres(5, 60);
    std::size_t met = 0;
    std::size_t passed = 0;
    for (IndexRay ray : random_mesh_rays(2, places_about(spheres), 1500)) {
        if (!detail::is_followed(ray))
            continue;
        ray.t_min = -infinity;
        ray.t_max = infinity;
        const detail::SphereRay prepared(ray);
        for (const auto& sphere : spheres) {
            const Depth depth = depth_of(ray, sphere);
            // Both sides round, this one 2^11 times less but squares of longer ways.
            const long double doubt = 0x1p-50L * depth.size;
            const bool found = detail::sphere_crossings(prepared, sphere).has_value();
            if (depth.depth > doubt) {
                ASSERT_TRUE(found) << told(ray);
                ++met;
            } else if (depth.depth < -doubt) {
                ASSERT_FALSE(found) << told(ray);
                ++passed;
            }
        }
    }
    EXPECT_GT(met, 1000U);
    EXPECT_GT(passed, 1000U);
}

TEST(SphereHits, LieOnTheirSpheres) {
    for (const SampleSpheres& spheres :
         {random_spheres(1, 100),
          ball_of_balls(12),
          scaled_and_shifted(random_spheres(2, 50), 1, 100)}) {
        const SphereIndex index(spheres);
        std::size_t found = 0;
        for (const IndexRay& ray : random_mesh_rays(3, places_about(spheres), 1500))
            for (const SphereHit& hit : index.all_hits(ray)) {
                ASSERT_TRUE(hit.t >= ray.t_min && hit.t <= ray.t_max) << told(hit);
                const auto& sphere = spheres[hit.sphere];
                const Vec3 center = detail::in_double({sphere[0], sphere[1], sphere[2]});
                const Vec3 origin = detail::in_double(ray.origin);
                const Vec3 direction = detail::in_double(ray.direction);
                const Vec3 way = static_cast<double>(hit.t) * direction;
                const auto radius = static_cast<double>(sphere[3]);
                // t is rounded to 2^-24 of itself, or to the smallest number. Before, a ray that
                // grazes the sphere is off by the root of the rounding, 2^-25.
                const double size = length(way) + length(center - origin) + radius;
                const double error = 0x1p-22 * size + 0x1p-149 * length(direction);
                ASSERT_NEAR(length(origin + way - center), radius, error) << told(hit) << "\n"
                                                                          << told(ray);
                ++found;
            }
        EXPECT_GT(found, 1000U);
    }
}

TEST(SphereHits, AreToldWhereARayEntersAndWhereItLeaves) {
    const SampleSpheres spheres = {{0, 0, 0, 1}};
    const SphereIndex index(spheres);
    const IndexRay through = {.origin = {-3, 0, 0}, .direction = {2, 0, 0}};
    EXPECT_EQ(index.nearest_hit(through), (SphereHit{1, 0}));
    EXPECT_EQ(index.all_hits(through), (std::vector<SphereHit>{{1, 0}, {2, 0}}));
    const IndexRay from_inside = {.origin = {0, 0, 0}, .direction = {0, 0.5F, 0}};
    EXPECT_EQ(index.nearest_hit(from_inside), (SphereHit{2, 0}));
    EXPECT_EQ(index.all_hits(from_inside), (std::vector<SphereHit>{{2, 0}}));
    const IndexRay within = {.origin = {0, 0, 0}, .direction = {0, 0.5F, 0}, .t_max = 1.5F};
    EXPECT_FALSE(index.nearest_hit(within).found());
    EXPECT_FALSE(index.meets_any(within));
    const IndexRay behind = {.origin = {3, 0, 0}, .direction = {1, 0, 0}};
    EXPECT_FALSE(index.nearest_hit(behind).found());
    const IndexRay both_ways = {.origin = {3, 0, 0}, .t_min = -infinity, .direction = {1, 0, 0}};
    EXPECT_EQ(index.all_hits(both_ways), (std::vector<SphereHit>{{-4, 0}, {-2, 0}}));
}

TEST(SphereHits, OfARayThatTouchesAreOne) {
    const SampleSpheres spheres = {{0, 0, 0, 1}, {2, 0, 0, 1}, {1, 0, 0, 0}};
    const SphereIndex index(spheres);
    // Both spheres touch at (1, 0, 0), where the third is a point, and so does the ray.
    const IndexRay ray = {.origin = {1, -4, 0}, .direction = {0, 2, 0}};
    EXPECT_EQ(index.all_hits(ray), (std::vector<SphereHit>{{2, 0}, {2, 1}, {2, 2}}));
    EXPECT_EQ(index.nearest_hit(ray), (SphereHit{2, 0}));
    const IndexRay past = {.origin = {0, std::nextafter(1.0F, 2.0F), -4}, .direction = {0, 0, 1}};
    EXPECT_FALSE(index.meets_any(past));
}

TEST(SphereHits, OfOneTAreThoseOfTheSmallestNumber) {
    const SampleSpheres spheres(300, {0, 0, 0, 1});
    const SphereIndex index(spheres);
    const IndexRay ray = {.origin = {0, 0, -3}, .direction = {0, 0, 1}};
    EXPECT_EQ(index.nearest_hit(ray), (SphereHit{2, 0}));
    EXPECT_EQ(index.all_hits(ray).size(), 600U);
}

TEST(SphereHits, AreToldApartByMoreThanSinglePrecision) {
    // Both are met at a t of 1 in single precision; the second is nearer.
    const SampleSpheres spheres = {{0, 0, 0, 1}, {1e-12F, 0, 0, 1}};
    const SphereIndex index(spheres);
    const IndexRay ray = {.origin = {2, 0, 0}, .direction = {-1, 0, 0}};
    EXPECT_EQ(index.all_hits(ray), (std::vector<SphereHit>{{1, 1}, {1, 0}, {3, 1}, {3, 0}}));
    EXPECT_EQ(index.nearest_hit(ray), (SphereHit{1, 1}));
}

TEST(SphereIndex, MeetsNothingBeyondTheLargestT) {
    constexpr float size = 0x1p100F;
    const SampleSpheres spheres = {{0, 0, 0, size}};
    const SphereIndex index(spheres);
    // It would be met at t = 7 * 2^126.
    const IndexRay ray = {.origin = {0, 0, -8 * size}, .direction = {0, 0, 0x1p-26F}};
    EXPECT_FALSE(index.nearest_hit(ray).found());
    EXPECT_FALSE(index.meets_any(ray));
    const std::vector<IndexRay> rays(16, ray);
    std::vector<SphereHit> hits(rays.size());
    std::vector<std::uint8_t> met(rays.size(), 7);
    index.nearest_hits(rays, hits);
    index.meet_any(rays, met);
    EXPECT_EQ(hits, std::vector<SphereHit>(rays.size()));
    EXPECT_EQ(met, std::vector<std::uint8_t>(rays.size(), 0));
}

TEST(SphereIndex, OfNoSpheresIsMetByNoRay) {
    for (const IndexQuality quality : both_qualities) {
        const SphereIndex index({}, quality);
        const std::vector<IndexRay> rays(20, {.direction = {1, 0, 0}});
        expect_answers(index, rays, std::vector<SphereAnswer>(20), "empty");
        index.nearest_hits({}, {});
        index.meet_any({}, {});
        EXPECT_EQ(index.statistics().spheres, 0U);
        EXPECT_EQ(index.statistics().left_out, 0U);
    }
}

TEST(SphereIndex, LeavesOutWhatIsNoSphere) {
    SampleSpheres spheres = random_spheres(1, 50);
    spheres.push_back({0, std::nanf(""), 0, 1});
    spheres.push_back({infinity, 0, 0, 1});
    spheres.push_back({0, 0, 0, std::nanf("")});
    spheres.push_back({0, 0, 0, infinity});
    spheres.push_back({0, 0, 0, -1});
    for (const IndexQuality quality : both_qualities) {
        const SphereIndex index(spheres, quality);
        EXPECT_EQ(index.statistics().spheres, 50U);
        EXPECT_EQ(index.statistics().left_out, 5U);
    }
    const SphereIndex none(SphereSpan(spheres).last(5));
    EXPECT_EQ(none.statistics().left_out, 5U);
    EXPECT_FALSE(none.meets_any({.origin = {-1, 0.25F, 0}, .direction = {1, 0, 0}}));
}

/// Of nearest hits of all rays.
SphereQueryCounts counts_of(const SampleSpheres& spheres, const std::vector<IndexRay>& rays) {
    SphereQueryCounts counts;
    std::vector<SphereHit> hits(rays.size());
    SphereIndex(spheres).nearest_hits(rays, hits, &counts);
    return counts;
}

TEST(SphereIndex, IsNotSlowedDownByWhatItLeavesOut) {
    SampleSpheres spheres = random_spheres(1, 500);
    const std::vector<IndexRay> rays = random_mesh_rays(2, places_about(spheres), 200);
    const SphereQueryCounts before = counts_of(spheres, rays);
    constexpr float huge = std::numeric_limits<float>::max();
    spheres.push_back({huge, huge, huge, -1});
    spheres.push_back({huge, std::nanf(""), 0, 1});
    const SphereQueryCounts after = counts_of(spheres, rays);
    EXPECT_EQ(after.nodes, before.nodes);
    EXPECT_EQ(after.spheres, before.spheres);
    EXPECT_GT(before.spheres, 0U);
}

TEST(SphereIndex, FindsWhatIsSmallBesideWhatIsHugeInNoMoreSteps) {
    SampleSpheres spheres = ball_of_balls(40);
    std::vector<IndexRay> rays;
    for (int i = 0; i < 256; ++i) {
        const auto side = static_cast<float>(i % 16) / 16;
        const auto up = static_cast<float>(i / 16) / 16;
        rays.push_back({.origin = {3, 0.25F, 0.5F}, .direction = {-3, side - 0.75F, up - 1}});
    }
    const SphereQueryCounts before = counts_of(spheres, rays);
    spheres.push_back({0, 0, -1e8F, 0.9e8F});
    const SphereQueryCounts after = counts_of(spheres, rays);
    EXPECT_LT(static_cast<double>(after.nodes), 1.1 * static_cast<double>(before.nodes));
    EXPECT_LE(after.spheres, before.spheres + rays.size()); // the huge one
}

TEST(SphereIndex, RefusesMoreSpheresThanItCanNumberBeforeItReadsThem) {
    const std::array<float, 4> only = {};
    try {
        const SphereIndex index({&only, std::size_t{1} << 31U});
        FAIL() << "it was not refused";
    } catch (const std::length_error& refusal) {
        EXPECT_THAT(refusal.what(), ::testing::HasSubstr("2147483648 spheres"));
        EXPECT_THAT(refusal.what(), ::testing::HasSubstr("at most 2147483647"));
    }
}

TEST(SphereIndex, IsMoved) {
    const SampleSpheres spheres = random_spheres(1, 50);
    const IndexRay ray = {.origin = {-20, 0, 0}, .direction = {1, 0, 0}};
    SphereIndex first(spheres);
    const SphereHit hit = first.nearest_hit(ray);
    EXPECT_TRUE(hit.found());
    SphereIndex second(std::move(first));
    EXPECT_EQ(second.nearest_hit(ray), hit);
    SphereIndex third({});
    third = std::move(second);
    EXPECT_EQ(third.nearest_hit(ray), hit);
}

TEST(SphereIndex, CountsItsStepsBesideWhatWasCounted) {
    const SampleSpheres spheres = ball_of_balls(40);
    const SphereIndex index(spheres);
    const auto rays = coherent_mesh_rays(1, places_about(spheres), 320);
    std::vector<SphereHit> hits(rays.size());
    std::vector<std::uint8_t> met(rays.size());
    SphereQueryCounts once;
    index.nearest_hits(rays, hits, &once);
    EXPECT_GT(once.nodes, 0U);
    EXPECT_GT(once.spheres, 0U);
    EXPECT_LT(once.spheres, rays.size() * spheres.size() / 10);
    SphereQueryCounts twice = once;
    index.nearest_hits(rays, hits, &twice);
    EXPECT_EQ(twice.nodes, 2 * once.nodes);
    EXPECT_EQ(twice.spheres, 2 * once.spheres);
    SphereQueryCounts any;
    index.meet_any(rays, met, &any);
    EXPECT_GT(any.nodes, 0U);
    EXPECT_GT(any.spheres, 0U);
}

} // namespace
} // namespace vera
