// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/accel/grid_tree.h"
#include "vera/accel/ray_walk.h"
#include "vera/accel/wide_bvh.h"
#include "vera/scene/crossings.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "index_answers.h"
#include "random_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using Outcome = WalkedObject::Outcome;

const WalkedIndex& walked(const RayIndex& index) {
    return dynamic_cast<const WalkedIndex&>(index);
}

/// Calls action(object) for all objects of the walk's lists.
template <typename Action>
void for_each_object(const RayWalk& walk, const Action& action) {
    for (const WalkStep& step : walk.steps)
        for (const WalkedObject& object : step.objects)
            action(object);
}

QueryCounts counted(const RayWalk& walk) {
    QueryCounts counts;
    counts.rays = 1;
    for (const WalkStep& step : walk.steps)
        counts.cells += step.kind == WalkStep::Kind::leaf ? 0 : 1;
    for_each_object(walk, [&](const WalkedObject& object) {
        const bool tested = object.outcome == Outcome::missed || object.outcome == Outcome::met;
        counts.tests += object.is_call ? object.tests : tested ? 1 : 0;
    });
    return counts;
}

void expect_counts(const QueryCounts& found, const QueryCounts& expected, const std::string& what) {
    ASSERT_EQ(found.rays, expected.rays) << what;
    ASSERT_EQ(found.cells, expected.cells) << what;
    ASSERT_EQ(found.tests, expected.tests) << what;
}

/// The hit is among what was met, and nothing that was met comes before it.
void expect_to_explain_the_hit(const RayWalk& walk, const Ray& ray, const std::string& what) {
    bool listed = !walk.hit.found();
    bool searched = false;
    for_each_object(walk, [&](const WalkedObject& object) {
        searched = searched || object.outcome == Outcome::searched;
        if (object.outcome != Outcome::met)
            return;
        ASSERT_TRUE(walk.hit.found()) << what;
        listed = listed || (object.primitive == walk.hit.face.primitive && object.t <= walk.hit.t);
        ASSERT_GE(object.t, walk.hit.t - 2 * coincidence_tolerance(ray, walk.hit.t)) << what;
    });
    ASSERT_TRUE(listed || searched) << what;
}

/// The walk does what the search does for the ray alone, to the bit, and its steps are what that
/// counts.
void expect_walk_like_search(
    const RayIndex& index, const QueryRay& query, const std::string& what) {
    Hit hit;
    QueryCounts counts;
    index.nearest_hits({&query, 1}, {&hit, 1}, counts);
    const RayWalk nearest = walked(index).nearest_walk(query);
    ASSERT_EQ(nearest.hit, hit) << what;
    ASSERT_NO_FATAL_FAILURE(expect_counts(nearest.counts, counts, what));
    ASSERT_NO_FATAL_FAILURE(expect_counts(counted(nearest), counts, what));
    ASSERT_NO_FATAL_FAILURE(expect_to_explain_the_hit(nearest, query.ray, what));

    Color transmitted;
    counts = {};
    index.transmittances({&query, 1}, {&transmitted, 1}, counts);
    const RayWalk shadow = walked(index).transmittance_walk(query);
    ASSERT_EQ(shadow.transmitted, transmitted) << what;
    ASSERT_NO_FATAL_FAILURE(expect_counts(shadow.counts, counts, what + ", shadow"));
    ASSERT_NO_FATAL_FAILURE(expect_counts(counted(shadow), counts, what + ", shadow"));
}

void expect_walks_like_searches(
    const Scene& scene, const std::vector<QueryRay>& rays, const std::string& what) {
    const auto grid = make_grid_tree(scene);
    const auto boxes = make_wide_bvh(scene);
    std::vector<Hit> hits(rays.size());
    QueryCounts counts;
    boxes->nearest_hits(rays, hits, counts);
    auto all = testing::rays_from_hits(5, rays, hits);
    all.insert(all.end(), rays.begin(), rays.end());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string which = what + ", ray " + std::to_string(i);
        ASSERT_NO_FATAL_FAILURE(expect_walk_like_search(*grid, all[i], "grids, " + which));
        ASSERT_NO_FATAL_FAILURE(expect_walk_like_search(*boxes, all[i], "boxes, " + which));
    }
}

TEST(RayWalk, DoesWhatTheSearchDoesForARayAlone) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        testing::RandomSceneSettings settings;
        settings.items = std::array<std::size_t, 3>{4, 40, 150}[seed % 3];
        settings.subscenes = seed % 2 * 3;
        settings.glass = seed % 4 >= 2;
        settings.curved = seed % 5 != 0;
        settings.scale = seed % 7 == 0 ? 1000 : 1;
        auto rays = testing::random_rays(seed, 80, settings.scale);
        const auto coherent = testing::coherent_rays(seed, 32, settings.scale);
        rays.insert(rays.end(), coherent.begin(), coherent.end());
        expect_walks_like_searches(
            testing::random_scene(seed, settings), rays, "scene " + std::to_string(seed));
        if (HasFatalFailure())
            return;
    }
}

TEST(RayWalk, GoesThroughGridsInGridsAndManyNodes) {
    auto rays = testing::mixed_rays(11, 1);
    rays.resize(100);
    for (std::size_t i = 0; i < rays.size(); i += 2)
        rays[i].ray.direction = Vec3{0.05, 0.05, 0} - rays[i].ray.origin;
    expect_walks_like_searches(testing::detail_in_a_room(), rays, "detail");
}

/// Whether the ray, without its ends, passes through the box.
bool passes(const Ray& ray, const Box3& box) {
    double near = -std::numeric_limits<double>::infinity();
    double far = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0) {
            if (ray.origin[axis] < box.lower[axis] || ray.origin[axis] > box.upper[axis])
                return false;
            continue;
        }
        const double a = (box.lower[axis] - ray.origin[axis]) / ray.direction[axis];
        const double b = (box.upper[axis] - ray.origin[axis]) / ray.direction[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

TEST(RayWalk, TellsWhereItsCellsAndNodesStand) {
    std::size_t in_subscenes = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const Scene scene = testing::random_scene(seed, {});
        const auto grid = make_grid_tree(scene);
        const auto boxes = make_wide_bvh(scene);
        for (const QueryRay& query : testing::coherent_rays(seed, 32, 1))
            for (const RayIndex* index :
                 {static_cast<const RayIndex*>(grid.get()),
                  static_cast<const RayIndex*>(boxes.get())})
                for (const RayWalk walk = walked(*index).nearest_walk(query);
                     const WalkStep& step : walk.steps) {
                    if (step.kind == WalkStep::Kind::node && step.number == 0)
                        continue; // a root may be visited without being met
                    const WalkedPlace& place = walk.places[step.place];
                    in_subscenes += place.depth > 0 ? 1 : 0;
                    // Of a slice's cells that the ray may be in, it is in a neighbour at least.
                    Vec3 more = {0.001, 0.001, 0.001};
                    if (step.kind == WalkStep::Kind::cell)
                        more = more + (step.box.upper - step.box.lower);
                    const Box3 around = {step.box.lower - more, step.box.upper + more};
                    ASSERT_TRUE(
                        passes(transformed_ray(*inverse(place.to_scene), query.ray), around))
                        << "scene " << seed;
                }
    }
    EXPECT_GT(in_subscenes, 100U);
}

TEST(RayWalk, TellsOfWhatItDoesNotTestAgain) {
    // A long triangle stands in many cells, of which little ones make many.
    Scene scene;
    const auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
        scene.geometry.items.push_back(
            {.kind = ItemKind::triangle,
             .index = static_cast<std::uint32_t>(scene.geometry.triangles.size())});
        scene.geometry.triangles.push_back({{a, b, c}});
    };
    add({0, 0, 0}, {20, 0, 0}, {0, 0.5, 0});
    for (int i = 0; i < 20; ++i)
        add({1.0 * i, 0.8, 0}, {i + 0.5, 0.8, 0}, {1.0 * i, 1, 0.02});
    number_primitives(scene);
    QueryRay query;
    query.ray.origin = {-1, 0.1, 0.01};
    query.ray.direction = {1, 0, 0};
    const RayWalk walk = walked(*make_grid_tree(scene)).nearest_walk(query);
    std::size_t tested = 0;
    std::size_t again = 0;
    for_each_object(walk, [&](const WalkedObject& object) {
        if (object.primitive != 0)
            return;
        tested += object.outcome == Outcome::missed ? 1 : 0;
        again += object.outcome == Outcome::again ? 1 : 0;
    });
    EXPECT_EQ(tested, 1U);
    EXPECT_GT(again, 3U);
}

TEST(RayWalk, LooksAgainWhereManyFacesCoincide) {
    // The first in the text is the farthest: none rules out another.
    Scene scene;
    for (std::uint32_t i = 0; i < 8; ++i) {
        const double z = 1 + (8 - i) * 0x1p-50;
        scene.geometry.triangles.push_back({{Vec3{-9, -9, z}, {9, -9, z}, {0, 9, z}}});
        scene.geometry.items.push_back({.kind = ItemKind::triangle, .index = i});
    }
    number_primitives(scene);
    QueryRay query;
    query.ray.direction = {0, 0, 1};
    const auto boxes = make_wide_bvh(scene);
    expect_walk_like_search(*boxes, query, "boxes");
    expect_walk_like_search(*make_grid_tree(scene), query, "grids");
    const RayWalk walk = walked(*boxes).nearest_walk(query);
    EXPECT_EQ(walk.hit.face.primitive, 0U);
    EXPECT_EQ(
        std::count_if(
            walk.steps.begin(),
            walk.steps.end(),
            [](const WalkStep& step) {
                return step.kind == WalkStep::Kind::node && step.number == 0;
            }),
        2);
}

TEST(RayWalk, TestsAllThatIsNestedTooDeeply) {
    constexpr std::uint32_t depth = 60;
    Scene scene;
    const auto call = [](Geometry& in, std::uint32_t subscene) {
        SubsceneCall nested;
        nested.subscene = SubsceneId{subscene};
        nested.to_parent = translation({0.1, 0, 0});
        nested.from_parent = translation({-0.1, 0, 0});
        in.calls.push_back(nested);
        in.items.push_back({.kind = ItemKind::subscene_call});
    };
    scene.subscenes.resize(depth);
    scene.subscenes[0].spheres.push_back({{0, 0, 0}, 1});
    scene.subscenes[0].items.push_back({.kind = ItemKind::sphere});
    for (std::uint32_t i = 1; i < depth; ++i)
        call(scene.subscenes[i], i - 1);
    call(scene.geometry, depth - 1);
    number_primitives(scene);
    QueryRay query;
    query.ray.origin = {6, 0, -9};
    query.ray.direction = {0, 0, 1};
    for (const std::unique_ptr<RayIndex>& index :
         {std::unique_ptr<RayIndex>(make_grid_tree(scene)),
          std::unique_ptr<RayIndex>(make_wide_bvh(scene))}) {
        expect_walk_like_search(*index, query, "nested");
        const RayWalk walk = walked(*index).nearest_walk(query);
        EXPECT_NEAR(walk.hit.t, 8, 1e-9);
        ASSERT_FALSE(walk.steps.empty());
        ASSERT_EQ(walk.steps.back().objects.size(), 1U);
        EXPECT_EQ(walk.steps.back().objects[0].outcome, Outcome::searched);
        EXPECT_EQ(walk.steps.back().objects[0].tests, 1U);
    }
}

TEST(RayWalk, IsEmptyInAnEmptyScene) {
    const Scene scene;
    expect_walk_like_search(*make_grid_tree(scene), {}, "grids");
    expect_walk_like_search(*make_wide_bvh(scene), {}, "boxes");
}

TEST(RayWalk, IsNothingThatBruteForceHas) {
    const Scene scene;
    const auto brute = make_brute_force(scene);
    EXPECT_EQ(dynamic_cast<const WalkedIndex*>(brute.get()), nullptr);
}

} // namespace
} // namespace vera
