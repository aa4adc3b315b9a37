// SPDX-License-Identifier: Apache-2.0
// What every index must do, whatever it is made of.
#include "vera/accel/grid_tree.h"
#include "vera/accel/simd_level.h"
#include "vera/accel/wide_bvh.h"
#include "vera/math/elementary.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "index_answers.h"
#include "random_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::Answers;
using testing::answers;
using testing::expect_like_brute_force;
using testing::expect_same;
using testing::mixed_rays;
using testing::random_scene;
using testing::RandomSceneSettings;

struct IndexKind {
    std::string name;
    std::function<std::unique_ptr<RayIndex>(const Scene&, const Progress&, const CancelFlag*)> make;

    friend void PrintTo(const IndexKind& kind, std::ostream* out) { *out << kind.name; }
};

class EveryIndex : public ::testing::TestWithParam<IndexKind> {
protected:
    static std::unique_ptr<RayIndex>
    make(const Scene& scene, const Progress& progress = {}, const CancelFlag* cancel = nullptr) {
        return GetParam().make(scene, progress, cancel);
    }
};

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    EveryIndex,
    ::testing::Values(
        IndexKind{
            "Grid",
            [](const Scene& scene, const Progress& progress, const CancelFlag* cancel) {
                return make_grid_tree(scene, {}, progress, cancel);
            }},
        IndexKind{
            "Bvh",
            [](const Scene& scene, const Progress& progress, const CancelFlag* cancel) {
                return make_wide_bvh(scene, progress, cancel);
            }}),
    [](const auto& kind) { return kind.param.name; });

TEST_P(EveryIndex, AgreesWithBruteForceOnEveryBit) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        RandomSceneSettings settings;
        settings.items = 1 + 2 * seed;
        settings.glass = seed % 2 == 0;
        const Scene scene = random_scene(seed, settings);
        expect_like_brute_force(
            scene, *make(scene), mixed_rays(seed, 1), "seed " + std::to_string(seed));
        if (HasFatalFailure() || HasNonfatalFailure())
            return;
    }
}

TEST_P(EveryIndex, AgreesWithBruteForceOnWhatIsSmallBesideWhatIsHuge) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        RandomSceneSettings settings;
        settings.items = 4 + 4 * seed;
        settings.scale = std::ldexp(1.0, -3 * static_cast<int>(seed));
        Scene scene = random_scene(seed, settings);
        const auto triangle = static_cast<std::uint32_t>(scene.geometry.triangles.size());
        const double below = -settings.scale;
        scene.geometry.triangles.push_back({{Vec3{-9, below, -9}, {9, below, -9}, {0, below, 9}}});
        scene.geometry.items.push_back({.kind = ItemKind::triangle, .index = triangle});
        number_primitives(scene);
        expect_like_brute_force(
            scene, *make(scene), mixed_rays(seed, settings.scale), "seed " + std::to_string(seed));
        if (HasFailure())
            return;
    }
}

TEST_P(EveryIndex, GivesTheSameBitsWithEveryInstructionSet) {
    RandomSceneSettings settings;
    settings.items = 60;
    settings.glass = true;
    const Scene scene = random_scene(7, settings);
    const auto rays = mixed_rays(7, 1);
    const auto index = make(scene);
    const Answers expected = answers(*index, rays);
    for (const std::string& level : simd_levels()) {
        ASSERT_TRUE(limit_simd(level));
        expect_same(answers(*index, rays), expected, rays, level);
    }
    EXPECT_TRUE(limit_simd(""));
}

TEST_P(EveryIndex, TakesAStartThatNamesNoPieceForNoStart) {
    Scene scene;
    scene.geometry.triangles.push_back({{Vec3{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}});
    scene.geometry.items.push_back({.kind = ItemKind::triangle});
    number_primitives(scene);
    QueryRay query;
    query.ray.origin = {0.25, 0.25, 0};
    query.ray.direction = {0, 0, 1};
    std::vector<QueryRay> rays(2, query);
    rays[0].start = {0, no_piece};
    rays[1].start = {0, 0};
    const auto index = make(scene);
    expect_like_brute_force(scene, *index, rays, "start");
    EXPECT_TRUE(answers(*index, rays).hits[0].found());
    EXPECT_FALSE(answers(*index, rays).hits[1].found());
}

TEST_P(EveryIndex, AgreesInAnyUnitOfLengthAndScalesItsAnswers) {
    RandomSceneSettings settings;
    for (const std::uint64_t seed : {3U, 14U, 15U}) {
        settings.scale = 1;
        const Scene scene = random_scene(seed, settings);
        const auto rays = mixed_rays(seed, 1);
        const Answers expected = answers(*make(scene), rays);
        for (const double scale : {0x1p-20, 0x1p20, 0x1p-200, 0x1p200}) {
            settings.scale = scale;
            const Scene copy = random_scene(seed, settings);
            auto copied_rays = rays;
            for (QueryRay& query : copied_rays) {
                query.ray.origin = scale * query.ray.origin;
                query.ray.t_min *= scale;
                query.ray.t_max *= scale;
                query.ray.origin_error *= scale;
            }
            expect_like_brute_force(
                copy, *make(copy), copied_rays, "scale " + std::to_string(scale));
            if (scale < 0x1p-100 || scale > 0x1p100)
                continue; // squares of squares lose digits there
            const Answers found = answers(*make(copy), copied_rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(found.hits[i].t, scale * expected.hits[i].t) << scale;
                ASSERT_EQ(found.hits[i].face, expected.hits[i].face) << scale;
            }
            EXPECT_EQ(found.hit_counts.tests, expected.hit_counts.tests) << scale;
        }
    }
}

TEST_P(EveryIndex, FindsTheFirstInTheTextOfManyCoincidentFaces) {
    Scene scene;
    // Each a little farther than the next, all within rounding of the first.
    for (std::uint32_t i = 0; i < 20; ++i) {
        const double z = 1 - 0x1p-50 * i;
        scene.geometry.triangles.push_back({{Vec3{0, 0, z}, {1, 0, z}, {0, 1, z}}});
        scene.geometry.items.push_back({.kind = ItemKind::triangle, .index = i});
    }
    number_primitives(scene);
    QueryRay query;
    query.ray.origin = {0.25, 0.25, 0};
    query.ray.direction = {0, 0, 1};
    const std::vector<QueryRay> rays(20, query);
    expect_like_brute_force(scene, *make(scene), rays, "coincident");
    const Answers found = answers(*make(scene), rays);
    EXPECT_EQ(found.hits.back().face, (FaceId{0, 0}));
    EXPECT_EQ(found.hits.back().t, 1);
}

/// Places at which rays from the origin pass the outline of a shape.
using OutlinePlaces = std::vector<Vec3>;

/// Points off the middle, across the ray from the origin and the axis, where a ray just touches
/// what is round about the axis (or about the middle, when it is across the ray itself).
OutlinePlaces tangent_places(Vec3 origin, Vec3 middle, Vec3 axis, double radius) {
    const Vec3 to_middle = middle - origin;
    const Vec3 across = normalized(cross(to_middle, axis));
    const Vec3 off_axis = to_middle - dot(to_middle, axis) * axis;
    const double distance = length(off_axis);
    const double off = radius * distance / std::sqrt(distance * distance - radius * radius);
    return {middle + off * across, middle - off * across};
}

OutlinePlaces places_along(const std::vector<Vec3>& corners) {
    OutlinePlaces places;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 next = corners[(i + 1) % corners.size()];
        for (const double part : {0.0, 0.25, 0.5})
            places.push_back(corners[i] + part * (next - corners[i]));
    }
    return places;
}

/// Rays from the origin to within some units of single precision of the places, that end before,
/// at or behind them, or never.
void add_rays_past(
    std::vector<QueryRay>& rays,
    std::mt19937_64& random,
    Vec3 origin,
    const OutlinePlaces& places) {
    constexpr std::array<double, 7> steps = {
        0, 0x1p-23, 0x1p-20, 0x1p-18, 0x1p-16, 0x1p-14, 0x1p-11};
    constexpr double forever = std::numeric_limits<double>::infinity();
    const auto step = [&] { return (random() % 2 == 0 ? 4 : -4) * steps[random() % steps.size()]; };
    for (const Vec3& place : places)
        for (int i = 0; i < 24; ++i) {
            QueryRay query;
            query.ray.origin = origin;
            query.ray.direction = place + Vec3{step(), step(), step()} - origin;
            query.ray.t_max = i % 2 == 0 ? forever : 1 + step();
            rays.push_back(query);
        }
}

TEST_P(EveryIndex, DecidesLikeBruteForceOnRaysThatPassOutlinesClosely) {
    const Vec3 middle = {0.3, 0.1, -0.2};
    const Vec3 axis = normalized(Vec3{1, 2, 0.5});
    const Vec3 aside = normalized(cross(axis, {0, 0, 1}));
    const std::vector<Vec3> three = {middle, middle + axis, middle + aside};
    const std::vector<Vec3> four = {
        middle, middle + axis, middle + 0.75 * axis + 1.25 * aside, middle + aside};
    Scene scene;
    Geometry& geometry = scene.geometry;
    geometry.spheres.push_back({middle, 0.5});
    geometry.triangles.push_back({{three[0], three[1], three[2]}});
    geometry.corners = four;
    geometry.polygons.push_back({.corner_count = 4, .normal = normalized(cross(axis, aside))});
    RotationalShape mantle;
    mantle.base = middle;
    mantle.axis = axis;
    mantle.start = {0.4, -0.5};
    mantle.contour.push_back({.end = {0.4, 0.75}});
    geometry.rotational_shapes.push_back(mantle);
    mantle.contour.back().end.r = 0.1;
    geometry.rotational_shapes.push_back(mantle);

    const std::vector<Item> items = {
        {.kind = ItemKind::sphere},
        {.kind = ItemKind::triangle},
        {.kind = ItemKind::polygon},
        {.kind = ItemKind::rotational_shape},
        {.kind = ItemKind::rotational_shape, .index = 1}};
    geometry.spheres.push_back({{4, 4, 4}, 0.1}); // which makes the bounds larger than the shape
    std::mt19937_64 random(17);
    for (const Item& item : items) {
        geometry.items = {item, {.kind = ItemKind::sphere, .index = 1}};
        number_primitives(scene);
        std::vector<QueryRay> rays;
        for (const Vec3& origin : {Vec3{0, 0, 3}, {2, -3, 0}, {-3, 1, 1}, {1, -2, -4}, {9, 9, 8}}) {
            OutlinePlaces places = places_along(item.kind == ItemKind::polygon ? four : three);
            if (item.kind == ItemKind::sphere) {
                places =
                    tangent_places(origin, middle, normalized(cross(middle - origin, aside)), 0.5);
            } else if (item.kind == ItemKind::rotational_shape) {
                places = tangent_places(origin, middle, axis, 0.4);
                const Vec3 other = cross(axis, aside);
                for (int i = 0; i < 12; ++i)
                    for (const double height : {-0.5, 0.75})
                        places.push_back(
                            middle + height * axis + 0.4 * cos_degrees(30 * i) * aside
                            + 0.4 * sin_degrees(30 * i) * other);
            }
            add_rays_past(rays, random, origin, places);
        }
        expect_like_brute_force(
            scene, *make(scene), rays, "item " + std::to_string(static_cast<int>(item.kind)));
    }
}

/// Shapes of one kind, one behind the other at less than the steps of single precision, in any
/// order.
Scene layers(ItemKind kind, std::mt19937_64& random) {
    constexpr std::uint32_t count = 40;
    Scene scene;
    Geometry& geometry = scene.geometry;
    const Vec3 middle = {0.3, 0.1, -0.2};
    const Vec3 axis = normalized(Vec3{1, 2, 0.5});
    const Vec3 aside = normalized(cross(axis, {0, 0, 1}));
    const Vec3 normal = cross(axis, aside);
    for (std::uint32_t i = 0; i < count; ++i) {
        const double off = 0x1p-22 * static_cast<double>(random() % count);
        const Vec3 corner = middle + off * normal;
        // Some are slivers.
        const double width = i % 3 == 0 ? 0x1p-9 : 1;
        const std::vector<Vec3> corners = {
            corner,
            corner + axis,
            corner + 0.75 * axis + 1.25 * width * aside,
            corner + width * aside};
        if (kind == ItemKind::sphere) {
            geometry.spheres.push_back({corner, 0.5 + 0.5 * off});
        } else if (kind == ItemKind::rotational_shape) {
            RotationalShape mantle;
            mantle.base = middle;
            mantle.axis = axis;
            mantle.start = {0.5 * width + off, -0.5};
            mantle.contour.push_back({.end = {(i % 2 == 0 ? 0.5 : 0.75) * width + off, 1}});
            geometry.rotational_shapes.push_back(mantle);
        } else if (kind == ItemKind::triangle)
            geometry.triangles.push_back({{corners[0], corners[1], corners[3]}});
        else {
            geometry.polygons.push_back(
                {.first_corner = 4 * i, .corner_count = 4, .normal = normal});
            geometry.corners.insert(geometry.corners.end(), corners.begin(), corners.end());
        }
        geometry.items.push_back({.kind = kind, .index = i});
    }
    number_primitives(scene);
    return scene;
}

TEST_P(EveryIndex, FindsTheFirstOfLayersCloserThanSinglePrecision) {
    std::mt19937_64 random(23);
    const auto number = [&](double size) {
        return size * (static_cast<double>(random() % 2001) / 1000 - 1);
    };
    for (const ItemKind kind :
         {ItemKind::sphere, ItemKind::triangle, ItemKind::polygon, ItemKind::rotational_shape}) {
        const Scene scene = layers(kind, random);
        std::vector<QueryRay> rays;
        for (int i = 0; i < 2000; ++i) {
            // From near and far, also along the layers and from within the spheres.
            const double distance = std::array{0.01, 0.4, 3.0, 60.0}[random() % 4];
            const Vec3 target = {0.5 + number(0.5), 0.5 + number(0.5), number(0.2)};
            QueryRay query;
            query.ray.origin = target
                + distance * Vec3{number(1), number(1), i % 2 == 0 ? number(1) : number(0.01)};
            query.ray.direction = target - query.ray.origin;
            rays.push_back(query);
        }
        expect_like_brute_force(
            scene, *make(scene), rays, "layers of kind " + std::to_string(static_cast<int>(kind)));
    }
}

TEST_P(EveryIndex, DecidesLikeBruteForceOnThinThingsInLargeScenes) {
    // Of which single precision, in the unit of the scene, tells little.
    std::mt19937_64 random(29);
    const auto number = [&](double size) {
        return size * (static_cast<double>(random() % 2001) / 1000 - 1);
    };
    for (const double thickness : {1e-1, 1e-2, 1e-4, 1e-6})
        for (const double slope : {0.0, 0.5, -0.9, -1.0}) {
            Scene scene;
            Geometry& geometry = scene.geometry;
            RotationalShape mantle;
            mantle.base = {0.3, 0.1, -0.2};
            mantle.axis = normalized(Vec3{1, 2, 0.5});
            mantle.start = {thickness, 0};
            const double length = slope < 0 ? thickness : 5 * thickness;
            mantle.contour.push_back({.end = {thickness + slope * length, length}});
            geometry.rotational_shapes.push_back(mantle);
            geometry.spheres.push_back({mantle.base, thickness});
            geometry.spheres.push_back({{40, 40, 40}, 50});
            geometry.items = {
                {.kind = ItemKind::rotational_shape},
                {.kind = ItemKind::sphere},
                {.kind = ItemKind::sphere, .index = 1}};
            number_primitives(scene);
            std::vector<QueryRay> rays;
            const Vec3 aside = normalized(cross(mantle.axis, {0, 0, 1}));
            const Vec3 other = cross(mantle.axis, aside);
            for (int i = 0; i < 3000; ++i) {
                const double distance = std::array{2 * thickness, 1e-1, 3.0, 60.0}[random() % 4];
                const double h = length * static_cast<double>(random() % 5) / 4;
                const double r = thickness + slope * h;
                const double step =
                    thickness * std::array{0.0, 0x1p-20, 0x1p-12, 0x1p-6}[random() % 4];
                const Vec3 place = mantle.base + h * mantle.axis
                    + (r + step) * cos_degrees(30.0 * (i % 12)) * aside
                    + r * sin_degrees(30.0 * (i % 12)) * other;
                QueryRay query;
                query.ray.origin = place + distance * Vec3{number(1), number(1), number(1)};
                query.ray.direction = place - query.ray.origin;
                if (i % 3 == 0)
                    query.ray.t_max = 1 + step;
                rays.push_back(query);
            }
            expect_like_brute_force(
                scene,
                *make(scene),
                rays,
                "thickness " + std::to_string(thickness) + " slope " + std::to_string(slope));
        }
}

TEST_P(EveryIndex, HoldsSubscenesNestedTenThousandDeep) {
    Scene scene;
    constexpr std::uint32_t levels = 10'000;
    scene.subscenes.resize(levels);
    const auto call = [](std::uint32_t subscene) {
        SubsceneCall result;
        result.subscene = SubsceneId{subscene};
        result.to_parent = translation({0, 0, 0.5});
        result.from_parent = *inverse(result.to_parent);
        return result;
    };
    for (std::uint32_t i = 1; i < levels; ++i) {
        scene.subscenes[i].calls.push_back(call(i - 1));
        scene.subscenes[i].items.push_back({.kind = ItemKind::subscene_call});
    }
    scene.subscenes[0].spheres.push_back({{0, 0, 0}, 1});
    scene.subscenes[0].items.push_back({.kind = ItemKind::sphere});
    scene.geometry.calls.push_back(call(levels - 1));
    scene.geometry.items.push_back({.kind = ItemKind::subscene_call});
    number_primitives(scene);
    QueryRay query;
    query.ray.direction = {0, 0, 1};
    const std::vector<QueryRay> rays(2, query);
    expect_like_brute_force(scene, *make(scene), rays, "nested");
    EXPECT_EQ(answers(*make(scene), rays).hits[0].t, 4999);
}

TEST_P(EveryIndex, TakesScenesOfNothingOrAlmostNothing) {
    Scene scene;
    const auto rays = mixed_rays(2, 1);
    number_primitives(scene);
    expect_like_brute_force(scene, *make(scene), rays, "empty");

    scene.subscenes.resize(1);
    scene.geometry.calls.push_back({});
    scene.geometry.items.push_back({.kind = ItemKind::subscene_call});
    number_primitives(scene);
    expect_like_brute_force(scene, *make(scene), rays, "empty subscene");

    for (std::uint32_t i = 0; i < 40; ++i) {
        const double x = i % 8;
        scene.geometry.triangles.push_back({{Vec3{x, 0, 1}, {x + 1, 0, 1}, {x, 1, 1}}});
        scene.geometry.items.push_back({.kind = ItemKind::triangle, .index = i});
    }
    number_primitives(scene);
    expect_like_brute_force(scene, *make(scene), rays, "flat");
}

TEST_P(EveryIndex, AnswersRaysThatGoNowhere) {
    const Scene scene = random_scene(4, {});
    std::vector<QueryRay> rays(3);
    rays[1].ray.direction = {1e-200, 0, 0};
    rays[2].ray.direction = {0, 1e200, 1e190};
    expect_like_brute_force(scene, *make(scene), rays, "strange directions");
}

TEST_P(EveryIndex, AnswersRaysThatAreNoneBesideRaysThatAre) {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    constexpr double forever = std::numeric_limits<double>::infinity();
    const Scene scene = random_scene(4, {});
    const auto index = make(scene);
    const std::vector<QueryRay> good = testing::coherent_rays(6, 64, 1);
    const Answers expected = answers(*index, good);
    for (const double strange : {nothing, forever, -forever, 1e200, 1e60})
        for (int number = 0; number < 9; ++number) {
            std::vector<QueryRay> rays = good;
            for (std::size_t i = 0; i < rays.size(); i += 5) {
                Ray& ray = rays[i].ray;
                const std::array<double*, 9> numbers = {
                    &ray.origin.x,
                    &ray.origin.y,
                    &ray.origin.z,
                    &ray.direction.x,
                    &ray.direction.y,
                    &ray.direction.z,
                    &ray.t_min,
                    &ray.t_max,
                    &ray.origin_error};
                *numbers[static_cast<std::size_t>(number)] = strange;
            }
            const Answers found = answers(*index, rays);
            for (std::size_t i = 0; i < rays.size(); ++i)
                if (i % 5 != 0) {
                    EXPECT_EQ(found.hits[i], expected.hits[i])
                        << strange << " as number " << number;
                    EXPECT_EQ(found.transmitted[i], expected.transmitted[i]);
                }
        }
}

TEST_P(EveryIndex, AnswersRaysFromVeryFarAndInVeryFarScenes) {
    for (const double far : {0.0, 1e9, 1e32, 1e60}) {
        Scene scene;
        for (std::uint32_t i = 0; i < 5; ++i) {
            scene.geometry.spheres.push_back({{far + 3.0 * i, 0, 0}, 1});
            scene.geometry.items.push_back({.kind = ItemKind::sphere, .index = i});
        }
        number_primitives(scene);
        std::vector<QueryRay> rays;
        for (const double from : {2.0, 1e9, 1e32, 1e60})
            for (const Vec3& direction : {Vec3{0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0.1, 0.2, 1}}) {
                QueryRay query;
                query.ray.origin = Vec3{far, 0, 0} - from * direction;
                query.ray.direction = direction;
                rays.push_back(query);
            }
        expect_like_brute_force(scene, *make(scene), rays, "far " + std::to_string(far));
    }
}

TEST_P(EveryIndex, FindsWhatLiesBehindTheBeginningOfARay) {
    Scene scene;
    for (std::uint32_t i = 0; i < 8; ++i) {
        const double z = -0.8 + 0.2 * i;
        scene.geometry.triangles.push_back({{Vec3{-0.9, -0.9, z}, {0.9, -0.9, z}, {0, 0.9, z}}});
        scene.geometry.items.push_back({.kind = ItemKind::triangle, .index = i});
        scene.geometry.spheres.push_back({{0, 0, z}, 0.01});
        scene.geometry.items.push_back({.kind = ItemKind::sphere, .index = i});
    }
    number_primitives(scene);
    std::vector<QueryRay> rays;
    for (int i = 0; i < 40; ++i) {
        QueryRay query;
        query.ray.origin = {0.001 * (i % 4), 0, -1};
        query.ray.direction = {0, 0, 1};
        query.ray.t_min = 0.05 * i;
        query.ray.t_max =
            query.ray.t_min + std::array{0.05, 0.1, 0.5, 3.0}[static_cast<std::size_t>(i) % 4];
        rays.push_back(query);
    }
    expect_like_brute_force(scene, *make(scene), rays, "begun later");
}

TEST_P(EveryIndex, FindsTheFirstOfCoincidentFacesInAStretchedSubsceneFarAway) {
    Scene scene;
    scene.subscenes.resize(1);
    Geometry& subscene = scene.subscenes[0];
    for (std::uint32_t i = 0; i < 2; ++i) {
        const double z = i == 0 ? 4e-4 : 0;
        subscene.triangles.push_back({{Vec3{-0.9, -0.9, z}, {0.9, -0.9, z}, {0, 0.9, z}}});
        subscene.items.push_back({.kind = ItemKind::triangle, .index = i});
    }
    subscene.spheres.push_back({{0.8, 0.8, 0.8}, 0.1});
    subscene.items.push_back({.kind = ItemKind::sphere});
    SubsceneCall call;
    call.to_parent = {{{Vec3{4, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}}, {1e9, 0, 0}};
    call.from_parent = *inverse(call.to_parent);
    scene.geometry.calls.push_back(call);
    scene.geometry.items.push_back({.kind = ItemKind::subscene_call});
    number_primitives(scene);
    QueryRay query;
    query.ray.origin = {1e9, 0, -1};
    query.ray.direction = {0, 0, 1};
    const std::vector<QueryRay> rays(3, query);
    expect_like_brute_force(scene, *make(scene), rays, "stretched");
    EXPECT_EQ(answers(*make(scene), rays).hits[0].face.primitive, 0U);
}

TEST_P(EveryIndex, MeetsTrianglesWhoseAreaSinglePrecisionHardlyHolds) {
    Scene scene;
    for (const double size : {1e-12, 1e-18, 1e-20, 1e-22, 1e-30}) {
        scene.geometry.items.push_back(
            {.kind = ItemKind::triangle,
             .index = static_cast<std::uint32_t>(scene.geometry.triangles.size())});
        const double z = 0.1 * static_cast<double>(scene.geometry.triangles.size());
        scene.geometry.triangles.push_back(
            {{Vec3{-size, -size, z}, {size, -size, z}, {0, size, z}}});
    }
    scene.geometry.spheres.push_back({{0.9, 0.9, 0.9}, 0.1});
    scene.geometry.items.push_back({.kind = ItemKind::sphere});
    number_primitives(scene);
    std::vector<QueryRay> rays;
    for (const double z : {-0.5, 0.05, 0.15, 0.25, 0.35})
        for (const double direction : {1.0, -1.0}) {
            QueryRay query;
            query.ray.origin = {0, 0, z};
            query.ray.direction = {0, 0, direction};
            rays.push_back(query);
        }
    expect_like_brute_force(scene, *make(scene), rays, "tiny");
}

TEST_P(EveryIndex, CanBeInterruptedAndTellsHowFarItIs) {
    const Scene scene = random_scene(1, {});
    double last = 0;
    make(scene, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(make(scene, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
