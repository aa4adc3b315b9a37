// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/light_views.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/math/box3.h"
#include "vera/shade/lighting.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/edges.h"
#include "vera/visible/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace vera {

namespace {

/// A square view from the origin, with that half side at distance 1.
Camera square_view(Vec3 forward, double half_side) {
    const Vec3 away = std::abs(forward.z) < 0.75 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    const Vec3 across = half_side * normalized(cross(forward, away));
    const Vec3 up = half_side * normalized(cross(across, forward));
    Camera camera;
    camera.lower_left = forward - across - up;
    camera.lower_right = forward + across - up;
    camera.upper_left = forward - across + up;
    return camera;
}

/// From the origin, of the box.
std::vector<Camera> cameras_of(const Box3& box) {
    const Vec3 to_middle = center(box);
    const double distance = length(to_middle);
    if (distance > 0) {
        const Vec3 forward = to_middle / distance;
        // Of the widest angle to the middle, which a cube's side is not to exceed by much.
        double tangent = 0;
        for (unsigned i = 0; i < 8; ++i) {
            const Vec3 to = corner(box, i);
            const double along = dot(to, forward);
            tangent = along > 0 ? std::max(tangent, length(cross(to, forward)) / along) : 2;
        }
        // Not so narrow that the corners of the view are one for rounding.
        if (tangent < 1.2)
            return {square_view(forward, std::max(1.001 * tangent, 1e-9))};
    }
    std::vector<Camera> cameras;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 forward;
            forward[axis] = side;
            cameras.push_back(square_view(forward, 1));
        }
    return cameras;
}

bool is_within_source(const ScreenScene& view, const EdgeNeighbours& beside) {
    return beside.are_two()
        && view.triangles[beside.left].source == view.triangles[beside.right].source;
}

} // namespace

LitFacets::LitFacets(const Scene& scene, const Facets& facets)
    : states_(facets.triangles.size()) {
    for (std::size_t i = 0; i < states_.size(); ++i)
        if (is_black(material_of(scene, facets.triangles[i].material).tab))
            states_[i] = opaque;
}

void LitFacets::add(const ScreenScene& view, const Progress& progress, const CancelFlag* cancel) {
    const VisiblePieces pieces = cell_raster(view, progress, cancel);
    stop_if_raised(cancel);
    const ScreenEdges edges = screen_edges(view);
    const std::vector<EdgeNeighbours> neighbours = edge_neighbours(view, edges);
    // A surface that is seen beside an edge and goes on behind what is seen on the other side.
    const auto goes_on = [&](std::uint32_t triangle, const VisiblePiece& piece) {
        const auto corners = corners_of(view, view.triangles[triangle]);
        const ScreenPoint begin = view.vertices[piece.edge.begin].point;
        const ScreenPoint end = view.vertices[piece.edge.end].point;
        for (std::size_t i = 0; i < 3; ++i) {
            const ScreenPoint from = corners[i].point;
            const ScreenPoint to = corners[(i + 1) % 3].point;
            if (orientation(from, to, begin) == 0 && orientation(from, to, end) == 0)
                return is_within_source(view, neighbours[edges.of_triangle[triangle][i]]);
        }
        return true;
    };
    std::vector<std::uint8_t> here(states_.size()); // of this view
    const auto add_state = [&](std::uint32_t facet, bool is_partly_hidden) {
        const int state = here[facet] | seen | (is_partly_hidden ? hidden : 0);
        here[facet] = static_cast<std::uint8_t>(state);
    };
    const LongLoop loop(pieces.pieces.size(), {}, cancel);
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        loop.turn(i);
        const VisiblePiece& piece = pieces.pieces[i];
        for (const std::uint32_t triangle : {piece.left, piece.right})
            if (triangle != no_triangle)
                add_state(view.triangles[triangle].source, goes_on(triangle, piece));
    }
    for (const auto& [a, b] : pieces.penetrating)
        for (const std::uint32_t triangle : {a, b})
            add_state(view.triangles[triangle].source, true);
    for (const ScreenTriangle& triangle : view.triangles) {
        const int state = here[triangle.source];
        states_[triangle.source] = static_cast<std::uint8_t>(
            states_[triangle.source] | shown | (state == 0 ? int{hidden} : state));
    }
}

LightViews light_views(
    const Scene& scene,
    const Facets& facets,
    Vec3 position,
    const Box3& box,
    const Progress& progress,
    const CancelFlag* cancel) {
    LightViews result = {LitFacets(scene, facets), {}, 0, 0};
    // About the light, so that what is narrow or far away keeps its digits.
    Facets moved = facets;
    for (Vec3& corner : moved.corners)
        corner = corner - position;
    std::vector<std::uint32_t> numbers(facets.triangles.size());
    std::iota(numbers.begin(), numbers.end(), 0U);
    const Box3 moved_box = {box.lower - position, box.upper - position};
    const std::vector<Camera> cameras = cameras_of(moved_box);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        LightView view;
        // What is behind all that is seen throws no shadow on it, and would take from the depths.
        const CameraMap map(cameras[i]);
        double farthest = 0;
        for (unsigned j = 0; j < 8; ++j)
            farthest = std::max(farthest, map.image_point(corner(moved_box, j)).w);
        if (!(farthest > 0))
            continue;
        result.step = std::max(
            result.step,
            farthest * length(cameras[i].lower_right - cameras[i].lower_left) / screen_size);
        view.screen = screen_scene(moved, map, numbers, 1.001 * farthest, cancel);
        if (view.screen.triangles.empty())
            continue;
        result.cut_nearness = std::max(result.cut_nearness, view.screen.cut_nearness);
        view.transparent.vertices = view.screen.vertices;
        std::vector<ScreenTriangle>& triangles = view.screen.triangles;
        const auto transparent =
            std::stable_partition(triangles.begin(), triangles.end(), [&](const auto& triangle) {
                return result.lit.is_opaque(triangle.source);
            });
        view.transparent.triangles.assign(transparent, triangles.end());
        triangles.erase(transparent, triangles.end());
        if (view.transparent.triangles.empty())
            view.transparent.vertices = {};
        sort_by_place(view.screen, cancel);
        result.lit.add(view.screen, progress_part(progress, i, cameras.size()), cancel);
        view.cells = cells_of(view.screen, cancel);
        result.views.push_back(std::move(view));
    }
    return result;
}

} // namespace vera
