// SPDX-License-Identifier: Apache-2.0
#include "theory/index_visits.h"

#include "vera/accel/grid_tree.h"
#include "vera/accel/wide_bvh.h"

#include <span>
#include <utility>

namespace vera::testing {

namespace {

Scene scene_of(const std::vector<PlacedRectangle>& rectangles) {
    Scene scene;
    scene.materials.emplace_back();
    const auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
        const auto index = static_cast<std::uint32_t>(scene.geometry.triangles.size());
        scene.geometry.triangles.push_back({{a, b, c}});
        scene.geometry.items.push_back({.kind = ItemKind::triangle, .index = index});
    };
    for (const auto& [z, lower_x, upper_x, lower_y, upper_y] : rectangles) {
        const Vec3 low = {lower_x, lower_y, z};
        const Vec3 high = {upper_x, upper_y, z};
        add(low, {upper_x, lower_y, z}, high);
        add(low, high, {lower_x, upper_y, z});
    }
    number_primitives(scene);
    return scene;
}

std::uint64_t visits_of(const RayIndex& index, const QueryRay& ray) {
    Hit hit;
    QueryCounts counts;
    index.nearest_hits({&ray, 1}, {&hit, 1}, counts);
    return counts.cells + counts.tests;
}

} // namespace

struct RectangleIndexes::Made {
    explicit Made(Scene of)
        : scene(std::move(of)) {}

    Scene scene;
    std::unique_ptr<GridTree> uniform_grid = make_grid_tree(scene, {.levels = 1});
    std::unique_ptr<GridTree> tree_of_grids = make_grid_tree(scene);
    std::unique_ptr<WideBvh> hierarchy_of_boxes = make_wide_bvh(scene);
};

RectangleIndexes::RectangleIndexes(const std::vector<PlacedRectangle>& rectangles)
    : made_(std::make_unique<Made>(scene_of(rectangles))) {}

RectangleIndexes::~RectangleIndexes() = default;

IndexVisits RectangleIndexes::visits(
    const std::array<double, 3>& origin, const std::array<double, 3>& direction) const {
    QueryRay ray;
    ray.ray.origin = {origin[0], origin[1], origin[2]};
    ray.ray.direction = {direction[0], direction[1], direction[2]};
    return {
        visits_of(*made_->uniform_grid, ray),
        visits_of(*made_->tree_of_grids, ray),
        visits_of(*made_->hierarchy_of_boxes, ray)};
}

} // namespace vera::testing
