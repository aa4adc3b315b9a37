// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/mesh_crossing.h"
#include "vera/accel/mesh_index.h"
#include "vera/accel/simd_level.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>

#include "expected_answers.h"
#include "mesh_brute_force.h"
#include "sample_mesh.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using ::testing::AllOf;
using testing::brute_force_answer;
using testing::brute_force_answers;
using testing::close_layers;
using testing::coherent_mesh_rays;
using testing::cube;
using testing::expect_answers;
using testing::expect_answers_by_spans;
using ::testing::HasSubstr;
using testing::MeshAnswer;
using testing::MeshPoint;
using testing::mixed_sizes;
using testing::random_mesh;
using testing::random_mesh_rays;
using testing::rays_cut_at;
using testing::rays_of_lights;
using testing::rough_sphere;
using testing::SampleMesh;
using testing::scaled_and_shifted;
using testing::small_triangles_beside_large;
using testing::sphere;
using testing::told;
using testing::with_broken_vertices;

constexpr MeshIndexQuality both_qualities[] = {MeshIndexQuality::usual, MeshIndexQuality::high};
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Sixteen rays at a time of those of lights, each begun or ended at, just before or just behind
/// where it meets the mesh first: neighbours stay neighbours.
std::vector<MeshRay> rays_of_lights_cut_at_hits(const SampleMesh& mesh, std::uint64_t seed) {
    const std::vector<MeshRay> whole = rays_of_lights(seed, mesh, 192);
    std::vector<MeshRay> rays;
    for (const float side : {-infinity, 0.0F, infinity})
        for (const bool is_end : {false, true})
            for (MeshRay ray : whole) {
                const MeshAnswer answer = brute_force_answer(mesh.spans(), ray);
                if (answer.met) {
                    const float t = answer.nearest.t;
                    (is_end ? ray.t_max : ray.t_min) = side == 0 ? t : std::nextafter(t, side);
                }
                rays.push_back(ray);
            }
    return rays;
}

/// Rays of all sorts, some of which begin and end just where others meet the mesh.
std::vector<MeshRay> rays_of_all_sorts(const SampleMesh& mesh, std::uint64_t seed) {
    std::vector<MeshRay> rays = random_mesh_rays(seed, mesh, 400);
    for (const MeshRay& ray : coherent_mesh_rays(seed, mesh, 400))
        rays.push_back(ray);
    for (const MeshRay& ray : rays_of_lights(seed, mesh, 400))
        rays.push_back(ray);
    const std::size_t uncut = rays.size();
    rays.resize((uncut + 15) / 16 * 16, rays.front()); // groups begin anew
    for (const MeshRay& ray : rays_of_lights_cut_at_hits(mesh, seed))
        rays.push_back(ray);
    for (std::size_t i = 0; i < uncut; i += 7) {
        const MeshAnswer answer = brute_force_answer(mesh.spans(), rays[i]);
        if (!answer.met)
            continue;
        for (const MeshHit& hit : {answer.nearest, answer.all[answer.all.size() / 2]})
            for (const MeshRay& ray : rays_cut_at(rays[i], hit.t))
                rays.push_back(ray);
    }
    return rays;
}

void expect_like_brute_force(const SampleMesh& mesh, std::uint64_t seed) {
    const auto rays = rays_of_all_sorts(mesh, seed);
    const auto expected = brute_force_answers(mesh.spans(), rays);
    for (const MeshIndexQuality quality : both_qualities) {
        const MeshIndex index(mesh.spans(), quality);
        const std::string name = quality == MeshIndexQuality::usual ? "usual" : "high";
        expect_answers(index, rays, expected, name + ", seed " + std::to_string(seed));
    }
}

struct MeshFamily {
    std::string name;
    std::uint64_t seeds = 1;
    std::function<SampleMesh(std::uint64_t seed)> make;

    friend void PrintTo(const MeshFamily& family, std::ostream* out) { *out << family.name; }
};

MeshFamily few_triangles(std::string name, float factor, float offset) {
    return {std::move(name), 12, [=](std::uint64_t seed) {
                return scaled_and_shifted(random_mesh(seed, 5 * seed), factor, offset);
            }};
}

class EveryMesh : public ::testing::TestWithParam<MeshFamily> {};

INSTANTIATE_TEST_SUITE_P(
    Families,
    EveryMesh,
    ::testing::Values(
        few_triangles("FewTriangles", 1, 0),
        few_triangles("FewSmallTriangles", 0x1p-60F, 0),
        few_triangles("FewVerySmallTriangles", 1e-30F, 0),
        few_triangles("FewTrianglesAsSmallAsCanBe", 1e-44F, 0),
        few_triangles("FewLargeTriangles", 0x1p60F, 0),
        few_triangles("FewVeryLargeTriangles", 1e30F, 0),
        few_triangles("FewTrianglesAsLargeAsCanBe", 1e37F, 0),
        few_triangles("FewTrianglesFarAway", 1, 1e6F),
        few_triangles("FewSmallTrianglesFarAway", 0.001F, -3),
        MeshFamily{"ManyTriangles", 2, [](auto seed) { return random_mesh(seed, 1000); }},
        MeshFamily{"CloseLayers", 12, [](auto seed) { return close_layers(seed, 2 + 3 * seed); }},
        MeshFamily{"MixedSizes", 12, [](auto seed) { return mixed_sizes(seed, 10 * seed); }},
        MeshFamily{
            "SmallBesideLarge",
            12,
            [](auto seed) { return small_triangles_beside_large(seed, 10 * seed); }},
        MeshFamily{
            "BrokenVertices",
            6,
            [](auto seed) { return with_broken_vertices(random_mesh(seed, 8 * seed), seed); }},
        MeshFamily{"Cube", 2, [](auto seed) { return cube(2 * seed); }},
        MeshFamily{"Sphere", 2, [](auto seed) { return sphere(2 + seed); }},
        MeshFamily{"RoughSphere", 2, [](auto seed) { return rough_sphere(3, seed); }}),
    [](const auto& family) { return family.param.name; });

TEST_P(EveryMesh, IsAnsweredLikeByBruteForceOnEveryBit) {
    for (std::uint64_t seed = 0; seed < GetParam().seeds; ++seed) {
        expect_like_brute_force(GetParam().make(seed), seed);
        if (HasFailure())
            return;
    }
}

TEST_P(EveryMesh, GivesTheSameBitsWithEveryInstructionSet) {
    const std::uint64_t seed = GetParam().seeds - 1;
    const SampleMesh mesh = GetParam().make(seed);
    const auto rays = rays_of_all_sorts(mesh, seed + 1000);
    const auto expected = brute_force_answers(mesh.spans(), rays);
    const MeshIndexStatistics statistics = MeshIndex(mesh.spans()).statistics();
    for (const std::string& level : simd_levels()) {
        ASSERT_TRUE(limit_simd(level));
        const MeshIndex index(mesh.spans());
        EXPECT_EQ(index.statistics(), statistics) << level;
        expect_answers(index, rays, expected, level);
    }
    EXPECT_TRUE(limit_simd(""));
}

/// How far a hit's places are from each other, as a part of the numbers that they are made of.
struct PlaceErrors {
    double to_bounds = 0; ///< from where the ray is at t to the triangle's bounds
    double to_place = 0;  ///< to the triangle's place at u and v
    bool grazing = false; ///< whether t is only known to be within the bounds
};

PlaceErrors place_errors(const SampleMesh& mesh, const MeshRay& ray, const MeshHit& hit) {
    const auto& corners = mesh.triangles[hit.triangle];
    const Vec3 a = detail::in_double(mesh.vertices[corners[0]]);
    const Vec3 b = detail::in_double(mesh.vertices[corners[1]]);
    const Vec3 c = detail::in_double(mesh.vertices[corners[2]]);
    const Vec3 origin = detail::in_double(ray.origin);
    const Vec3 direction = detail::in_double(ray.direction);
    const Vec3 way = static_cast<double>(hit.t) * direction;
    const Vec3 on_ray = origin + way;
    const auto u = static_cast<double>(hit.u);
    const auto v = static_cast<double>(hit.v);
    const Vec3 on_triangle = (1 - u - v) * a + u * b + v * c;
    const Vec3 in_bounds = max(min(a, min(b, c)), min(max(a, max(b, c)), on_ray));
    const double size = max_component(abs(a)) + max_component(abs(b)) + max_component(abs(c))
        + max_component(abs(origin)) + max_component(abs(way));
    const double across = std::abs(dot(cross(b - a, c - a), direction));
    return {
        max_component(abs(on_ray - in_bounds)) / size,
        max_component(abs(on_ray - on_triangle)) / size,
        across <= 0x1p-20 * max_component(abs(b - a)) * max_component(abs(c - a))
                * max_component(abs(direction))};
}

TEST(MeshHits, LieWhereTheRayAndTheTriangleSay) {
    for (const auto& mesh : {sphere(4), rough_sphere(4, 1), cube(3), random_mesh(1, 300)}) {
        const MeshIndex index(mesh.spans());
        std::size_t across = 0;
        for (const MeshRay& ray : random_mesh_rays(3, mesh, 2000))
            for (const MeshHit& hit : index.all_hits(ray)) {
                ASSERT_TRUE(hit.u >= 0 && hit.u <= 1 && hit.v >= 0 && hit.v <= 1) << told(hit);
                ASSERT_TRUE(hit.t >= ray.t_min && hit.t <= ray.t_max) << told(hit);
                // t, u and v are rounded to 2^-24 of themselves. Before, cancellation leaves them
                // 2^-53 of the numbers, divided by the 2^-20 from which on the plane decides.
                const PlaceErrors errors = place_errors(mesh, ray, hit);
                ASSERT_LE(errors.to_bounds, 0x1p-22) << told(hit) << "\n" << told(ray);
                if (errors.grazing)
                    continue;
                ASSERT_LE(errors.to_place, 0x1p-22) << told(hit) << "\n" << told(ray);
                ++across;
            }
        EXPECT_GT(across, 1000U);
    }
}

TEST(MeshHits, AreNotFarBesideTrianglesThatAreSeenEdgeOn) {
    // In the triangle's plane, past the triangle: rounding leaves one edge's sign, and no others.
    SampleMesh mesh;
    mesh.add_triangle({-1, -1, 0}, {4, -1, 3}, {-1, 3, -3});
    const MeshIndex first(mesh.spans());
    EXPECT_TRUE(first.all_hits({{6.5F, -3, 6}, -1, {-13.75F, -1, -7.5F}, infinity}).empty());
    SampleMesh other;
    other.add_triangle({0, -1, 0}, {0.1F, -1, 0}, {-0.5F, 2, 1});
    const MeshIndex second(other.spans());
    EXPECT_TRUE(second.all_hits({{-1, -1, 0}, 0, {5, -3, -1}, infinity}).empty());
}

TEST(MeshHits, OfOneTAreThoseOfTheSmallestTriangle) {
    SampleMesh mesh;
    for (int i = 0; i < 300; ++i)
        mesh.add_triangle({0, 0, 1}, {4, 0, 1}, {0, 4, 1});
    mesh.triangles.insert(mesh.triangles.begin(), {0, 0, 0});
    const MeshIndex index(mesh.spans());
    const MeshRay ray = {.origin = {1, 2, 0}, .direction = {0, 0, 0.5F}};
    EXPECT_EQ(index.nearest_hit(ray), (MeshHit{2, 1, 0.25F, 0.5F}));
    const std::vector<MeshHit> all = index.all_hits(ray);
    ASSERT_EQ(all.size(), 300U);
    for (std::uint32_t i = 0; i < 300; ++i)
        EXPECT_EQ(all[i], (MeshHit{2, i + 1, 0.25F, 0.5F}));
}

TEST(MeshHits, AreToldApartByMoreThanSinglePrecision) {
    // Both are met at a t of 1 in single precision; the second is nearer.
    SampleMesh mesh;
    mesh.add_triangle({-1, -1, 0}, {3, -1, 0}, {-1, 3, 0});
    mesh.add_triangle({-1, -1, 1e-12F}, {3, -1, 1e-12F}, {-1, 3, 1e-12F});
    const MeshIndex index(mesh.spans());
    const MeshRay ray = {.origin = {0, 0, 1}, .direction = {0, 0, -1}};
    EXPECT_EQ(index.nearest_hit(ray), (MeshHit{1, 1, 0.25F, 0.25F}));
    EXPECT_EQ(
        index.all_hits(ray), (std::vector<MeshHit>{{1, 1, 0.25F, 0.25F}, {1, 0, 0.25F, 0.25F}}));
}

/// Rays from one place go together until they have come to too many triangles between them.
TEST(MeshIndex, AnswersRaysWithMuchBetweenThemLikeByBruteForce) {
    constexpr int side = 60;
    const auto point = [](int x, int y) -> MeshPoint {
        return {
            static_cast<float>(x) / side,
            static_cast<float>(y) / side,
            0.01F * static_cast<float>((7 * x + 13 * y) % 5)};
    };
    SampleMesh mesh;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            mesh.add_triangle(point(x, y), point(x + 1, y), point(x, y + 1));
            mesh.add_triangle(point(x + 1, y), point(x + 1, y + 1), point(x, y + 1));
        }
    std::vector<MeshRay> rays;
    for (int i = 0; i < 256; ++i) {
        const auto x = static_cast<float>(i % 4) / 3 + 0.01F * static_cast<float>(i / 16 % 4);
        const auto y = static_cast<float>(i / 4 % 4) / 3 + 0.01F * static_cast<float>(i / 64);
        rays.push_back({.origin = {-1, -1, 40}, .direction = {x + 1, y + 1, -40}});
    }
    const auto expected = brute_force_answers(mesh.spans(), rays);
    const MeshIndex index(mesh.spans());
    expect_answers_by_spans(index, rays, expected, rays.size(), "from far away");
}

TEST(MeshIndex, MeetsNothingBeyondTheLargestT) {
    constexpr float size = 0x1p100F;
    SampleMesh mesh;
    mesh.add_triangle({-size, -size, 0}, {size, -size, 0}, {0, size, 0});
    const MeshIndex index(mesh.spans());
    // It would be met at t = 2^129.
    const MeshRay ray = {.origin = {0, 0, -8 * size}, .direction = {0, 0, 0x1p-26F}};
    EXPECT_FALSE(index.nearest_hit(ray).found());
    EXPECT_FALSE(index.meets_any(ray));
    const std::vector<MeshRay> rays(16, ray);
    std::vector<MeshHit> hits(rays.size());
    std::vector<std::uint8_t> met(rays.size(), 7);
    index.nearest_hits(rays, hits);
    index.meet_any(rays, met);
    EXPECT_EQ(hits, std::vector<MeshHit>(rays.size()));
    EXPECT_EQ(met, std::vector<std::uint8_t>(rays.size(), 0));
}

TEST(MeshIndex, AnswersRaysOfDirectionsOfEverySize) {
    constexpr float size = 0x1p-60F; // so that t is a usual number with tiny directions as well
    const SampleMesh mesh = scaled_and_shifted(rough_sphere(3, 1), size, 0);
    constexpr float away = -6 * size;
    std::vector<MeshRay> rays;
    constexpr float few[] = {-0.25F, -0.0F, 0.0F, 0.1875F};
    for (const float x : {-1.0F, 1.0F})
        for (const float y : few)
            for (const float z : few)
                for (const int exponent : {-149, -126, -100, -64, -63, -62, 0, 64, 124, 125, 126})
                    for (const float t_max :
                         {infinity, std::numeric_limits<float>::max(), 0.0F, -0.0F}) {
                        MeshRay ray = {
                            .origin = {away * x, away * y, away * z}, .direction = {x, y, z}};
                        for (float& coordinate : ray.direction)
                            coordinate = std::ldexp(coordinate, exponent);
                        ray.t_max = t_max;
                        rays.push_back(ray);
                    }
    expect_answers(MeshIndex(mesh.spans()), rays, brute_force_answers(mesh.spans(), rays), "sizes");
}

TEST(MeshIndex, OfNoTrianglesIsMetByNoRay) {
    for (const MeshIndexQuality quality : both_qualities) {
        const MeshIndex index({}, quality);
        const std::vector<MeshRay> rays(20, {.direction = {1, 0, 0}});
        expect_answers(index, rays, std::vector<MeshAnswer>(20), "empty");
        index.nearest_hits({}, {});
        index.meet_any({}, {});
        EXPECT_EQ(index.statistics().triangles, 0U);
        EXPECT_EQ(index.statistics().left_out, 0U);
    }
}

TEST(MeshIndex, LeavesOutTrianglesWithCornersThatAreNowhere) {
    SampleMesh mesh = cube(1);
    mesh.add_triangle({0, 0, 0}, {0, std::nanf(""), 0}, {1, 0, 0});
    mesh.add_triangle({infinity, 0, 0}, {0, 1, 0}, {1, 0, 0});
    mesh.add_triangle({0, 0, 0}, {0, 1, 0}, {1, 0, -infinity});
    for (const MeshIndexQuality quality : both_qualities) {
        const MeshIndex index(mesh.spans(), quality);
        EXPECT_EQ(index.statistics().triangles, mesh.triangles.size() - 3);
        EXPECT_EQ(index.statistics().left_out, 3U);
    }
    std::vector<std::array<std::uint32_t, 3>> broken(
        mesh.triangles.end() - 3, mesh.triangles.end());
    const MeshIndex none({mesh.vertices, broken});
    EXPECT_EQ(none.statistics().triangles, 0U);
    EXPECT_EQ(none.statistics().left_out, 3U);
    EXPECT_FALSE(none.meets_any({.origin = {-1, 0.25F, 0}, .direction = {1, 0, 0}}));
}

TEST(MeshIndex, IsNotSlowedDownByWhatItLeavesOut) {
    constexpr float huge = std::numeric_limits<float>::max();
    constexpr float tiny = std::numeric_limits<float>::denorm_min();
    for (const float factor : {1.0F, 0x1p60F}) {
        SampleMesh mesh = scaled_and_shifted(rough_sphere(3, 1), factor, 0);
        const std::vector<MeshRay> rays = random_mesh_rays(2, mesh, 200);
        const auto counted = [&] {
            MeshQueryCounts counts;
            std::vector<MeshHit> hits(rays.size());
            MeshIndex(mesh.spans()).nearest_hits(rays, hits, &counts);
            return counts;
        };
        const MeshQueryCounts before = counted();
        // Vertices of no triangle, and one of a triangle that is left out.
        mesh.vertices.insert(mesh.vertices.end(), {{huge, 0, 0}, {0, -huge, tiny}});
        mesh.add_triangle({huge, huge, huge}, {0, 1, tiny}, {infinity, 0, 0});
        const MeshQueryCounts after = counted();
        EXPECT_EQ(after.nodes, before.nodes) << factor;
        EXPECT_EQ(after.triangles, before.triangles) << factor;
        EXPECT_GT(before.triangles, 0U) << factor;
    }
}

TEST(MeshIndex, FindsWhatIsSmallBesideWhatIsHugeInNoMoreSteps) {
    SampleMesh mesh = rough_sphere(5, 1);
    std::vector<MeshRay> rays;
    for (int i = 0; i < 512; ++i) {
        const auto side = static_cast<float>(i % 16) / 16;
        const auto up = static_cast<float>(i / 16) / 32;
        rays.push_back({.origin = {3, 0.25F, 0.5F}, .direction = {-3, side - 0.75F, up - 1}});
    }
    const auto counted = [&] {
        const MeshIndex index(mesh.spans());
        MeshQueryCounts counts;
        std::vector<MeshHit> hits(rays.size());
        index.nearest_hits(rays, hits, &counts);
        std::vector<std::uint8_t> met(rays.size());
        index.meet_any(rays, met, &counts);
        return counts;
    };
    const MeshQueryCounts before = counted();
    for (const float huge : {1e5F, 1e9F}) {
        mesh.add_triangle({-huge, -huge, -1}, {huge, -huge, -1}, {0, huge, -1});
        const MeshQueryCounts after = counted();
        EXPECT_LT(static_cast<double>(after.nodes), 1.1 * static_cast<double>(before.nodes));
        EXPECT_LT(
            static_cast<double>(after.triangles), 1.1 * static_cast<double>(before.triangles));
    }
}

TEST(MeshIndex, RefusesATriangleOfAVertexThatThereIsNot) {
    SampleMesh mesh = sphere(3);
    const std::size_t vertices = mesh.vertices.size();
    mesh.triangles[321][2] = static_cast<std::uint32_t>(vertices);
    try {
        const MeshIndex index(mesh.spans());
        FAIL() << "it was not refused";
    } catch (const std::invalid_argument& refusal) {
        EXPECT_THAT(
            refusal.what(),
            AllOf(HasSubstr("triangle 321"), HasSubstr("vertex " + std::to_string(vertices))));
    }
    mesh.triangles[321][2] = 0;
    mesh.triangles[5][0] = no_triangle;
    EXPECT_THROW(MeshIndex(mesh.spans()), std::invalid_argument);
    EXPECT_THROW(MeshIndex({{}, mesh.triangles}), std::invalid_argument);
}

TEST(MeshIndex, RefusesMoreTrianglesThanItCanNumberBeforeItReadsThem) {
    const std::array<std::uint32_t, 3> only = {0, 0, 0};
    const MeshPoint vertex = {};
    EXPECT_THROW(MeshIndex({{&vertex, 1}, {&only, std::size_t{1} << 31U}}), std::length_error);
    EXPECT_THROW(MeshIndex({{&vertex, 1}, {&only, std::size_t{1} << 40U}}), std::length_error);
}

TEST(MeshIndex, IsMoved) {
    const SampleMesh mesh = cube(1);
    const MeshRay ray = {.origin = {0.25F, 0.5F, 0}, .direction = {0, 0, 1}};
    MeshIndex first(mesh.spans());
    const MeshHit hit = first.nearest_hit(ray);
    EXPECT_TRUE(hit.found());
    MeshIndex second(std::move(first));
    EXPECT_EQ(second.nearest_hit(ray), hit);
    MeshIndex third({});
    third = std::move(second);
    EXPECT_EQ(third.nearest_hit(ray), hit);
}

TEST(MeshIndex, CountsItsStepsBesideWhatWasCounted) {
    const SampleMesh mesh = sphere(4);
    const MeshIndex index(mesh.spans());
    const auto rays = coherent_mesh_rays(1, mesh, 320);
    std::vector<MeshHit> hits(rays.size());
    std::vector<std::uint8_t> met(rays.size());
    MeshQueryCounts once;
    index.nearest_hits(rays, hits, &once);
    EXPECT_GT(once.nodes, 0U);
    EXPECT_GT(once.triangles, 0U);
    EXPECT_LT(once.triangles, rays.size() * mesh.triangles.size() / 10);
    MeshQueryCounts twice = once;
    index.nearest_hits(rays, hits, &twice);
    EXPECT_EQ(twice.nodes, 2 * once.nodes);
    EXPECT_EQ(twice.triangles, 2 * once.triangles);
    MeshQueryCounts any;
    index.meet_any(rays, met, &any);
    EXPECT_GT(any.nodes, 0U);
    EXPECT_GT(any.triangles, 0U);
    EXPECT_LT(any.triangles, rays.size() * mesh.triangles.size() / 10);
}

} // namespace
} // namespace vera
