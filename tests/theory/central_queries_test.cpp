// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/theory/central_queries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "accel/random_scene.h"
#include "render/test_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// Of few values: along axes, to edges and corners of the cube, and anywhere.
Vec3 random_direction(std::mt19937_64& random) {
    constexpr std::array<double, 7> few = {-1, -0.5, 0, 0.25, 0.5, 1, -0.25};
    Vec3 direction;
    const bool is_any = random() % 2 == 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint64_t bits = random();
        direction[axis] =
            is_any ? static_cast<double>(bits >> 11U) * 0x1p-52 - 1 : few[bits % few.size()];
    }
    return direction;
}

TEST(CubePlace, IsOnTheFaceOfTheLongestComponentAndOfEquallyLongOnesOnTheLowest) {
    EXPECT_EQ(cube_place({3, 1, -2})->face, 0U);
    EXPECT_EQ(cube_place({-3, 3, 3})->face, 1U);
    EXPECT_EQ(cube_place({1, 3, 3})->face, 2U);
    EXPECT_EQ(cube_place({1, -3, 3})->face, 3U);
    EXPECT_EQ(cube_place({0, 0, 1e-300})->face, 4U);
    EXPECT_EQ(cube_place({1, 0, -2})->face, 5U);
    EXPECT_FALSE(cube_place({0, 0, 0}));
    EXPECT_FALSE(cube_place({0, std::nan(""), 1}));
}

TEST(CubePlace, LeadsBackToTheDirection) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 10'000; ++i) {
        const Vec3 direction = random_direction(random);
        const auto place = cube_place(direction);
        if (!place)
            continue;
        const std::size_t axis = place->face / 2;
        Vec3 back;
        back[axis] = place->face % 2 == 0 ? 1 : -1;
        back[(axis + 1) % 3] = 2 * place->x / screen_size - 1;
        back[(axis + 2) % 3] = 1 - 2 * place->y / screen_size;
        ASSERT_LE(max_component(abs(back)), 1);
        ASSERT_LE(length(cross(normalized(direction), normalized(back))), 1e-15);
        ASSERT_GT(dot(direction, back), 0);
    }
}

Facets facets_of(const Scene& scene) {
    return facets(scene, [](Vec3) { return 1e-3; });
}

Hit nearest(const RayIndex& index, Vec3 center, Vec3 direction) {
    QueryRay query;
    query.ray.origin = center;
    query.ray.direction = normalized(direction);
    std::array<Hit, 1> hits;
    QueryCounts counts;
    index.nearest_hits(std::array{query}, hits, counts);
    return hits[0];
}

/// Whether a ray a bit beside, by so many radians, meets that primitive first, or what lies at the
/// same place but for rounding.
bool sees_nearby(
    const RayIndex& index, Vec3 center, Vec3 direction, std::uint64_t primitive, double angle) {
    const Vec3 forward = normalized(direction);
    const Vec3 aside =
        normalized(cross(forward, std::abs(forward.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const Vec3 up = cross(forward, aside);
    for (int i = 0; i < 24; ++i)
        for (const double part : {0.25, 1.0}) {
            const double turn = i * 0.26179938779914944;
            const Vec3 beside =
                forward + part * angle * (std::cos(turn) * aside + std::sin(turn) * up);
            if (nearest(index, center, beside).face.primitive == primitive)
                return true;
        }
    return false;
}

struct Comparison {
    int directions = 0;
    int near_borders = 0; ///< answers that differ, explained by a border
};

/// Compares with rays; what differs lies within `angle` of a border, or the two surfaces within
/// that part of their distance of each other.
void compare(
    const Scene& scene, Vec3 center, std::uint64_t seed, int directions, Comparison& result) {
    constexpr double angle = 0x1p-18; // of eight steps of the grid
    const Facets all = facets_of(scene);
    const auto index = make_brute_force(scene);
    const CentralQueries queries(all, center);
    std::mt19937_64 random(seed);
    LocatorSteps steps;
    for (int i = 0; i < directions; ++i) {
        const Vec3 direction = random_direction(random);
        if (direction == Vec3{})
            continue;
        ++result.directions;
        const auto facet = queries.first_facet(direction, steps);
        const std::uint64_t found = facet ? all.triangles[*facet].primitive : no_primitive;
        const Hit expected = nearest(*index, center, direction);
        if (found == expected.face.primitive)
            continue;
        ++result.near_borders;
        ASSERT_TRUE(sees_nearby(*index, center, direction, found, angle))
            << "seed " << seed << " direction " << direction.x << " " << direction.y << " "
            << direction.z << " found " << found << " expected " << expected.face.primitive;
    }
}

TEST(CentralQueries, AnswerWhatRaysThroughEveryPrimitiveMeetFirst) {
    Comparison all;
    std::mt19937_64 random(2);
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        testing::RandomSceneSettings settings;
        settings.items = 4 + seed;
        settings.curved = false;
        const Scene scene = testing::random_scene(seed, settings);
        // Anywhere, or on planes on which faces lie and corners of these.
        const bool is_any = seed % 2 == 0;
        Vec3 center;
        for (std::size_t axis = 0; axis < 3; ++axis)
            center[axis] = is_any ? static_cast<double>(random() % 1024) / 128 - 4 + 1.0 / 300
                                  : static_cast<double>(random() % 32) / 4 - 4;
        compare(scene, center, seed, 400, all);
        if (HasFatalFailure())
            return;
    }
    EXPECT_GT(all.directions, 11'000);
    // From such points directions of few values meet edges.
    EXPECT_GT(all.near_borders, 0);
    EXPECT_LE(all.near_borders, all.directions / 100);
}

TEST(CentralQueries, SeeAClosedBoxFromWithinAndNothingAround) {
    SceneMaker maker;
    const auto face = [&](std::size_t axis, double at) {
        std::array<Vec3, 4> corners;
        for (std::size_t i = 0; i < 4; ++i) {
            corners[i][axis] = at;
            corners[i][(axis + 1) % 3] = i == 0 || i == 3 ? -1 : 1;
            corners[i][(axis + 2) % 3] = i < 2 ? -1 : 1;
        }
        maker.polygon({corners[0], corners[1], corners[2], corners[3]});
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double at : {1.0, -1.0})
            face(axis, at);
    const Scene& scene = maker.finish();
    const Facets all = facets_of(scene);
    std::mt19937_64 random(3);
    for (const Vec3 center : {Vec3{}, Vec3{0.3, -0.2, 0.9}}) {
        const CentralQueries queries(all, center);
        LocatorSteps steps;
        for (int i = 0; i < 2000; ++i) {
            const Vec3 direction = random_direction(random);
            const auto place = cube_place(direction);
            if (!place)
                continue;
            const auto facet = queries.first_facet(direction, steps);
            ASSERT_TRUE(facet);
            if (center == Vec3{}) {
                // The cube is the box. On an edge, either of two.
                const Vec3 size = abs(direction);
                const std::size_t met = all.triangles[*facet].primitive / 2;
                ASSERT_EQ(size[met], max_component(size));
            }
        }
        EXPECT_GT(steps.queries, 1900U);
    }
    const CentralQueries outside(all, {5, 0, 0});
    LocatorSteps steps;
    EXPECT_TRUE(outside.first_facet({-1, 0.01, 0}, steps));
    EXPECT_FALSE(outside.first_facet({1, 0.01, 0}, steps));
    EXPECT_FALSE(outside.first_facet({0, 1, 0.1}, steps));
    EXPECT_FALSE(outside.first_facet({0, 0, 0}, steps));
}

/// Triangles each in a cube of its own, none of which touches another.
Scene apart(std::mt19937_64& random) {
    SceneMaker maker;
    const auto part = [&] { return 0.9 * static_cast<double>(random() >> 11U) * 0x1p-53; };
    for (int i = 0; i < 125; ++i) {
        std::array<Vec3, 3> corners;
        for (Vec3& corner : corners) {
            corner = {i % 5 - 2.5, i / 5 % 5 - 2.5, i / 25 - 2.5};
            for (std::size_t axis = 0; axis < 3; ++axis)
                corner[axis] += part();
        }
        maker.polygon({corners[0], corners[1], corners[2]});
    }
    return maker.finish();
}

TEST(CentralQueries, HaveTheSameAnswerByEveryLocator) {
    std::mt19937_64 random(4);
    int found = 0;
    for (int round = 0; round < 6; ++round) {
        const Scene scene = apart(random);
        const Facets all = facets_of(scene);
        const Vec3 center = {-0.55, 0.47, round - 2.55};
        const CentralQueries slabs(all, center, LocatorKind::slabs);
        const CentralQueries hierarchy(all, center, LocatorKind::hierarchy);
        const CentralQueries grid(all, center, LocatorKind::grid);
        EXPECT_EQ(slabs.borders(), grid.borders());
        EXPECT_GT(slabs.memory(), 24 * slabs.borders());
        const auto index = make_brute_force(scene);
        LocatorSteps steps;
        for (int i = 0; i < 1000; ++i) {
            Vec3 direction;
            for (std::size_t axis = 0; axis < 3; ++axis)
                direction[axis] = static_cast<double>(random() >> 11U) * 0x1p-52 - 1;
            const auto expected = slabs.first_facet(direction, steps);
            ASSERT_EQ(hierarchy.first_facet(direction, steps), expected);
            ASSERT_EQ(grid.first_facet(direction, steps), expected);
            const std::uint64_t primitive = nearest(*index, center, direction).face.primitive;
            ASSERT_EQ(expected ? all.triangles[*expected].primitive : no_primitive, primitive);
            found += expected ? 1 : 0;
        }
    }
    EXPECT_GT(found, 800);
}

TEST(CentralQueries, AreOfNothingWhereThereIsNothing) {
    const CentralQueries queries({}, {1, 2, 3});
    LocatorSteps steps;
    EXPECT_FALSE(queries.first_facet({1, 0, 0}, steps));
    EXPECT_EQ(queries.borders(), 0U);
    EXPECT_EQ(queries.cut_distance(), 0);
}

TEST(CentralQueries, StopWhereTheyAreCancelled) {
    CancelFlag cancel;
    cancel.raise();
    std::mt19937_64 random(6);
    const Scene scene = apart(random);
    EXPECT_THROW(
        CentralQueries(facets_of(scene), {0.1, 0.2, 0.3}, LocatorKind::slabs, {}, &cancel),
        Cancelled);
}

TEST(CentralQueries, TellHowFarTheyAreAndNeverGoBack) {
    std::mt19937_64 random(5);
    const Scene scene = apart(random);
    double last = 0;
    int calls = 0;
    const CentralQueries queries(
        facets_of(scene), {0.1, 0.2, 0.3}, LocatorKind::hierarchy, [&](double done) {
            EXPECT_GE(done, last);
            EXPECT_LE(done, 1);
            last = done;
            ++calls;
        });
    EXPECT_GE(calls, 6);
    EXPECT_GT(last, 0.8);
}

} // namespace
} // namespace vera
