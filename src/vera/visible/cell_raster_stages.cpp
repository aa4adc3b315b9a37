// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cell_raster_stages.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/part_sweeps.h"
#include "vera/visible/piece_lists.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <span>

namespace vera {

namespace {

/// Whether the edge parts two parts of one shadow: beside it the same is seen. (Where several are
/// on a side, it is followed like any other.)
bool is_inner(const ScreenScene& scene, const EdgeNeighbours& beside) {
    if (!beside.are_two())
        return false;
    const ScreenTriangle& left = scene.triangles[beside.left];
    const ScreenTriangle& right = scene.triangles[beside.right];
    return left.is_shadow() && left.light == right.light && left.source == right.source;
}

std::vector<std::uint32_t> shadowed_sources(const ScreenScene& scene, const ScreenEdges& edges) {
    constexpr std::uint32_t none = several_sources - 1;
    std::vector<std::uint32_t> sources(edges.edges.size(), none);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i)
        for (const std::uint32_t edge : edges.of_triangle[i]) {
            const ScreenTriangle& triangle = scene.triangles[i];
            const std::uint32_t source = triangle.is_shadow() ? triangle.source : no_source;
            const bool is_same = sources[edge] == none || sources[edge] == source;
            sources[edge] = is_same ? source : several_sources;
        }
    return sources;
}

/// Of the edges, whether they part two surfaces of one source; empty: none does.
std::vector<std::uint8_t>
edges_within_sources(const ScreenScene& scene, const std::vector<EdgeNeighbours>& neighbours) {
    const auto is_within = [&](const EdgeNeighbours& beside) {
        if (!beside.are_two())
            return false;
        const ScreenTriangle& left = scene.triangles[beside.left];
        const ScreenTriangle& right = scene.triangles[beside.right];
        return left.source == right.source && !left.is_shadow() && !right.is_shadow();
    };
    if (std::none_of(neighbours.begin(), neighbours.end(), is_within))
        return {};
    std::vector<std::uint8_t> within(neighbours.size());
    for (std::size_t i = 0; i < neighbours.size(); ++i)
        within[i] = is_within(neighbours[i]) ? 1 : 0;
    return within;
}

/// Of the cells, whether all surfaces in their lists are parts of one source.
std::vector<std::uint8_t> cells_of_one_source(const ScreenScene& scene, const Cells& cells) {
    std::vector<std::uint8_t> result(cells.blocked.size());
    parallel_ranges(result.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t cell = first; cell < last; ++cell) {
            const std::span<const std::uint32_t> here = cells.triangles_of(cell);
            result[cell] = std::all_of(here.begin(), here.end(), [&](std::uint32_t i) {
                return scene.triangles[i].source == scene.triangles[here.front()].source;
            });
        }
    });
    return result;
}

/// Of the triangles that have none yet.
void add_corners(CellRaster& raster) {
    const ScreenScene& scene = raster.scene;
    std::size_t i = raster.corners.size();
    raster.corners.reserve(scene.triangles.size());
    for (; i < scene.triangles.size(); ++i) {
        const std::array<ScreenVertex, 3> corners = corners_of(scene, scene.triangles[i]);
        raster.corners.push_back({corners[0].point, corners[1].point, corners[2].point});
    }
}

/// Tells of the edges from that one on, which nothing has but triangles from that one on, where
/// they are hidden.
void hide_edges(
    CellRaster& raster,
    std::size_t first_triangle,
    std::size_t first_edge,
    const HiddenSquares& squares,
    const CancelFlag* cancel) {
    const std::vector<double> nearness = nearness_of_edges(raster, first_triangle, first_edge);
    raster.hidden_eighths.reserve(raster.edges.edges.size());
    raster.hidden_eighths.resize(raster.edges.edges.size());
    parallel_ranges(nearness.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t i = first; i < last; ++i)
            if (raster.is_followed(first_edge + i))
                raster.hidden_eighths[first_edge + i] = hidden_eighths(
                    raster, squares, raster.edges.edges[first_edge + i], nearness[i], [] {});
    });
}

} // namespace

std::vector<double>
nearness_of_edges(const CellRaster& raster, std::size_t first_triangle, std::size_t first_edge) {
    std::vector<double> nearness(
        raster.edges.edges.size() - first_edge, -std::numeric_limits<double>::infinity());
    for (std::size_t i = first_triangle; i < raster.slopes.size(); ++i)
        for (const std::uint32_t edge : raster.edges.of_triangle[i]) {
            const auto& [begin, end] = raster.edges.edges[edge];
            double& near = nearness[edge - first_edge];
            near = std::max(
                near,
                nearest_for_hiding(
                    raster.slopes[i],
                    std::array{
                        raster.scene.vertices[begin].point, raster.scene.vertices[end].point}));
        }
    return nearness;
}

/// The cells along the edges.
std::vector<std::uint8_t> cells_along(
    const std::vector<std::uint8_t>& is_edge_asked, const CellRaster& raster, const Cells& cells) {
    std::vector<std::uint8_t> is_asked(cells.blocked.size());
    parallel_ranges(is_edge_asked.size(), 2048, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (is_edge_asked[i] == 0)
                continue;
            const auto& [begin, end] = raster.edges.edges[i];
            for_each_cell_along(
                cells,
                raster.scene.vertices[begin].point,
                raster.scene.vertices[end].point,
                [&](std::size_t cell) {
                    mark_from_any_thread(is_asked[cell]);
                    return true;
                });
        }
    });
    return is_asked;
}

CellRaster raster_of(
    const ScreenScene& scene,
    const AskedOfRaster& asked,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress_between(progress, 0, part_of_preparation), 6);
    const auto next_stage = [&] {
        stop_if_raised(cancel);
        stages.next(1);
    };
    next_stage();
    require_raster_memory(scene);
    CellRaster raster = {scene, slopes_of(scene), {}, {}, {}, {}, {}, 0, {}, {}, {}, {}, {}, {}};
    next_stage();
    raster.edges = screen_edges(scene);
    raster.storage = storage_of(raster.edges.edges.size());
    next_stage();
    std::vector<EdgeNeighbours> neighbours = edge_neighbours(scene, raster.edges);
    if (std::ranges::any_of(scene.triangles, &ScreenTriangle::is_shadow)) {
        raster.shadowed = shadowed_sources(scene, raster.edges);
        raster.inner.resize(neighbours.size());
        for (std::size_t i = 0; i < neighbours.size(); ++i)
            raster.inner[i] = is_inner(scene, neighbours[i]) ? 1 : 0;
    }
    next_stage();
    AskedCells asked_cells;
    if (asked)
        asked_cells = [&](const Cells& cells) { return asked(raster, cells); };
    const SheetScene sheets = {scene, raster.edges, neighbours, raster.slopes};
    raster.cells = cells_of(scene, raster.slopes, cancel, asked_cells, &sheets);
    next_stage();
    block_by_sheets(raster.cells, sheets, cancel);
    raster.within_source = edges_within_sources(scene, neighbours);
    if (!raster.within_source.empty())
        raster.has_one_source = cells_of_one_source(scene, raster.cells);
    raster.shadow_cells = shadow_cells_of(raster.cells, scene, raster.slopes, cancel);
    free_room(neighbours);
    next_stage();
    hide_edges(raster, 0, 0, HiddenSquares(raster.cells), cancel);
    add_corners(raster); // which only those ask who follow edges
    return raster;
}

void add_shadows_to(
    CellRaster& raster,
    std::size_t first_triangle,
    std::size_t first_vertex,
    const HiddenSquares& squares,
    const CancelFlag* cancel) {
    const ScreenScene& scene = raster.scene;
    const std::size_t first_edge = raster.edges.edges.size();
    raster.slopes.reserve(scene.triangles.size());
    for (std::size_t i = first_triangle; i < scene.triangles.size(); ++i) {
        const bool is_as_before =
            i > first_triangle && scene.triangles[i].plane == scene.triangles[i - 1].plane;
        raster.slopes.push_back(
            is_as_before ? raster.slopes.back()
                         : nearness_slope(plane_of(scene, scene.triangles[i])));
    }
    add_corners(raster);
    add_edges(scene, first_triangle, first_vertex, raster.edges);
    raster.first_shadow_edge = first_edge;
    raster.shadowed.assign(raster.edges.edges.size() - first_edge, no_source);
    for (std::size_t i = first_triangle; i < scene.triangles.size(); ++i)
        for (const std::uint32_t edge : raster.edges.of_triangle[i])
            raster.shadowed[edge - first_edge] = scene.triangles[i].source;
    raster.inner.clear();
    for (const EdgeNeighbours& beside :
         edge_neighbours(scene, raster.edges, first_triangle, first_edge))
        raster.inner.push_back(is_inner(scene, beside) ? 1 : 0);
    raster.shadow_cells =
        shadow_cells_of(raster.cells, scene, raster.slopes, cancel, first_triangle);
    hide_edges(raster, first_triangle, first_edge, squares, cancel);
}

void take_shadows_out(CellRaster& raster, std::size_t triangles, std::size_t edges) {
    raster.slopes.resize(triangles);
    raster.corners.resize(triangles);
    raster.edges.of_triangle.resize(triangles);
    raster.edges.edges.resize(edges);
    raster.hidden_eighths.resize(edges);
}

namespace {

/// An edge, and how many marks at equal distances lie on it where all edges are laid end to end.
struct MarkedEdge {
    std::uint32_t edge = 0;
    double marks = 0;
    double weight = 0; ///< about as many cells as it touches
};

/// One edge of 256 or so, but enough of them in any case: long ones more often, since more can
/// cross them.
std::vector<MarkedEdge>
marked_edges(const CellRaster& raster, std::size_t first, std::size_t last, double& distance) {
    constexpr double least_marks = 512;
    constexpr double edges_per_mark = 256;
    const double cell = std::ldexp(1.0, raster.cells.shift);
    const auto weight_of = [&](const ScreenEdges::Edge& edge) {
        const ScreenStep along =
            step(raster.scene.vertices[edge.begin].point, raster.scene.vertices[edge.end].point);
        return 1 + static_cast<double>(std::abs(along.x) + std::abs(along.y)) / cell;
    };
    const std::span edges = std::span(raster.edges.edges).subspan(first, last - first);
    double whole = 0;
    for (const ScreenEdges::Edge& edge : edges)
        whole += weight_of(edge);
    distance = whole / std::max(least_marks, static_cast<double>(edges.size()) / edges_per_mark);
    std::vector<MarkedEdge> marked;
    double next = distance / 2;
    double end = 0;
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
        const double weight = weight_of(edges[i]);
        end += weight;
        if (next >= end)
            continue;
        const double marks = std::floor((end - next) / distance) + 1;
        next += marks * distance;
        marked.push_back({static_cast<std::uint32_t>(first) + i, marks, weight});
    }
    return marked;
}

} // namespace

ExpectedPieces expected_pieces(
    const CellRaster& raster,
    std::size_t first_edge,
    std::size_t last_edge,
    const CancelFlag* cancel) {
    PartSweeps sweeps(raster); // of its own: what they count is not counted
    double distance = 0;
    const std::vector<MarkedEdge> marked = marked_edges(raster, first_edge, last_edge, distance);
    std::vector<ExpectedPieces> found(marked.size());
    parallel_ranges(marked.size(), 16, [&](std::size_t first, std::size_t last) {
        std::unique_ptr<PartSweep> sweep = sweeps.take();
        for (std::size_t i = first; i < last; ++i) {
            stop_if_raised(cancel);
            const std::uint32_t edge = marked[i].edge;
            if (!raster.is_followed(edge))
                continue;
            const VisiblePieces& pieces = sweep->followed(edge);
            found[i] = {
                static_cast<double>(pieces.pieces.size()),
                static_cast<double>(pieces.penetrating.size())};
        }
        sweeps.give_back(std::move(sweep));
    });
    ExpectedPieces all;
    for (std::size_t i = 0; i < marked.size(); ++i) {
        const double edges = distance * marked[i].marks / marked[i].weight; // that it stands for
        all.pieces += edges * found[i].pieces;
        all.pairs += edges * found[i].pairs;
    }
    return all;
}

void set_unlit(const CellRaster& raster, VisiblePieces& list) {
    const ScreenScene& scene = raster.scene;
    const auto unlit = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? 0 : scene.unlit_of(scene.triangles[triangle].source);
    };
    list.unlit.clear();
    if (raster.may_be_unlit())
        for (const VisiblePiece& piece : list.pieces)
            list.unlit.push_back({unlit(piece.left), unlit(piece.right)});
}

namespace {

/// The edges in parts.
std::vector<EdgePart> edge_parts(std::size_t first, std::size_t last) {
    constexpr std::size_t most = 4096; // edges that are followed at a time
    std::vector<EdgePart> parts;
    for (std::size_t next = first; next < last; next += most)
        parts.push_back({next, std::min(next + most, last), {}});
    return parts;
}

/// In parts of all edges: edges between those of two parts are the second one's.
std::vector<EdgePart> joined_up(std::vector<EdgePart> parts, std::size_t edges) {
    std::size_t next = 0;
    for (EdgePart& part : parts) {
        part.first = next;
        next = part.last = std::max(next, part.last);
    }
    for (EdgePart& part : edge_parts(next, edges))
        parts.push_back(std::move(part));
    return parts;
}

} // namespace

std::vector<EdgePart> kept_pieces(const CellRaster& raster, std::vector<SeenPart> before) {
    const std::vector<ScreenEdges::Edge>& edges = raster.edges.edges;
    std::vector<EdgePart> kept(before.size());
    parallel_ranges(before.size(), 1, [&](std::size_t number, std::size_t) {
        VisiblePieces list = before[number].take();
        if (list.pieces.empty())
            return;
        set_unlit(raster, list);
        std::size_t edge = static_cast<std::size_t>(
            std::lower_bound(edges.begin(), edges.end(), list.pieces.front().edge) - edges.begin());
        std::size_t count = 0;
        for (std::size_t i = 0; i < list.pieces.size(); ++i) {
            while (edge < edges.size() && edges[edge] < list.pieces[i].edge)
                ++edge;
            if (edge == edges.size() || edges[edge] != list.pieces[i].edge
                || raster.is_near_change[edge] != 0)
                continue;
            list.pieces[count] = list.pieces[i];
            if (!list.unlit.empty())
                list.unlit[count] = list.unlit[i];
            ++count;
        }
        if (count < list.pieces.size()) {
            list.pieces.resize(count);
            list.unlit.resize(list.unlit.empty() ? 0 : count);
            if (raster.storage == PieceStorage::packed) // else they are left out when it is copied
                forget_unused_points(list);
        }
        kept[number] = {0, edge, SeenPart(std::move(list), raster.storage)};
    });
    return joined_up(std::move(kept), edges.size());
}

void follow_edges(
    const CellRaster& raster,
    std::size_t first,
    std::size_t last,
    const Progress& progress,
    const CancelFlag* cancel,
    std::vector<SeenPart>& parts,
    CellCounts* counts) {
    follow_edges(raster, edge_parts(first, last), progress, cancel, parts, counts);
}

void follow_edges(
    const CellRaster& raster,
    std::vector<EdgePart> edges,
    const Progress& progress,
    const CancelFlag* cancel,
    std::vector<SeenPart>& parts,
    CellCounts* counts) {
    const std::size_t before = parts.size();
    parts.resize(before + edges.size());
    PartSweeps sweeps(raster);
    std::mutex mutex;
    std::size_t done = before;
    parallel_ranges(parts.size() - before, 1, [&](std::size_t from, std::size_t to) {
        std::unique_ptr<PartSweep> sweep = sweeps.take();
        for (std::size_t i = from; i < to; ++i)
            parts[before + i] = sweep->followed(edges[i], cancel);
        sweeps.give_back(std::move(sweep));
        const std::lock_guard lock(mutex);
        done += to - from;
        if (progress)
            progress(
                static_cast<double>(done - before) / static_cast<double>(parts.size() - before));
    });
    if (counts != nullptr)
        counts->add_followed(sweeps.counts());
}

void sort_pairs(std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

} // namespace vera
