// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/light_views.h"

#include "vera/base/free_room.h"
#include "vera/base/progress_part.h"
#include "vera/shade/lighting.h"
#include "vera/visible/cell_raster_stages.h"
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
    CellRaster raster = raster_of(view, {}, progress, cancel);
    free_room(raster.cells.blocked); // which edges were compared with already
    const ScreenEdges& edges = raster.edges;
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
    const auto add_states = [&](SeenPart& part) {
        const VisiblePieces list = part.take();
        for (const VisiblePiece& piece : list.pieces)
            for (const std::uint32_t triangle : {piece.left, piece.right})
                if (triangle != no_triangle)
                    add_state(view.triangles[triangle].source, goes_on(triangle, piece));
        for (const auto& [a, b] : part.penetrating)
            for (const std::uint32_t triangle : {a, b})
                add_state(view.triangles[triangle].source, true);
    };
    // Nothing asks how the pieces go on in each other: a part of the edges at a time is enough.
    constexpr std::size_t at_a_time = 65536;
    const std::size_t count = edges.edges.size();
    const auto progress_at = [&](std::size_t edge) {
        return part_of_preparation
            + (1 - part_of_preparation) * static_cast<double>(edge) / static_cast<double>(count);
    };
    std::vector<SeenPart> parts;
    for (std::size_t first = 0, last = 0; first < count; first = last) {
        last = std::min(count, first + at_a_time);
        parts.clear();
        follow_edges(
            raster,
            first,
            last,
            progress_between(progress, progress_at(first), progress_at(last)),
            cancel,
            parts);
        std::ranges::for_each(parts, add_states);
    }
    for (const ScreenTriangle& triangle : view.triangles) {
        const int state = here[triangle.source];
        states_[triangle.source] = static_cast<std::uint8_t>(
            states_[triangle.source] | shown | (state == 0 ? int{hidden} : state));
    }
}

LightViews light_views(
    const Scene& scene,
    const Facets& facets,
    std::span<const std::uint32_t> looked_at,
    Vec3 position,
    std::span<const LightFrame> frames,
    const Progress& progress,
    const CancelFlag* cancel) {
    LightViews result = {LitFacets(scene, facets), {}, 0, 0};
    // About the light, so that what is narrow or far away keeps its digits.
    Facets moved;
    moved.corners.reserve(facets.corners.size());
    for (std::size_t i = 0; i < facets.corners.size(); ++i)
        moved.corners.push_back(facets.corners[i] - position);
    moved.triangles.reserve(looked_at.size());
    for (const std::uint32_t facet : looked_at)
        moved.triangles.push_back(facets.triangles[facet]);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        result.coarse_step = std::max(result.coarse_step, frames[i].coarse_step);
        // What is behind all that is seen throws no shadow on it, and would take from the depths.
        LightView view;
        view.screen = screen_scene(
            moved, CameraMap(frames[i].camera), looked_at, 1.001 * frames[i].farthest, cancel);
        if (i + 1 == frames.size()) {
            moved.corners = {};
            free_room(moved.triangles);
        }
        if (view.screen.triangles.empty())
            continue;
        result.cut_nearness = std::max(result.cut_nearness, view.screen.cut_nearness);
        std::vector<ScreenTriangle>& triangles = view.screen.triangles;
        const auto transparent =
            std::stable_partition(triangles.begin(), triangles.end(), [&](const auto& triangle) {
                return result.lit.is_opaque(triangle.source);
            });
        view.transparent.triangles.assign(transparent, triangles.end());
        triangles.erase(transparent, triangles.end());
        if (!view.transparent.triangles.empty())
            view.transparent.vertices = view.screen.vertices;
        sort_by_place(view.screen, cancel);
        result.lit.add(view.screen, progress_part(progress, i, frames.size()), cancel);
        view.cells = cells_of(view.screen, cancel);
        result.views.push_back(std::move(view));
    }
    return result;
}

} // namespace vera
