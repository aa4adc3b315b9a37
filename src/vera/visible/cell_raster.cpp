// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cell_raster.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/edge_sweep.h"
#include "vera/visible/hidden_squares.h"
#include "vera/visible/part_sweeps.h"
#include "vera/visible/piece_lists.h"
#include "vera/visible/sheets.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <mutex>
#include <span>

namespace vera {

namespace {

/// Of an edge that is so near, which eighths lie behind what covers their cells; all of a point.
/// Calls visit() for each cell, and each square of cells, that is looked at.
template <typename Visit>
std::uint8_t hidden_eighths(
    const CellRaster& raster,
    const HiddenSquares& squares,
    const ScreenEdges::Edge& edge,
    double near,
    const Visit& visit) {
    const ScreenPoint a = raster.scene.vertices[edge.begin].point;
    const ScreenPoint b = raster.scene.vertices[edge.end].point;
    std::uint8_t hidden = all_eighths;
    if (a == b || squares.hide(near, std::array{a, b}, visit))
        return hidden;
    const SegmentSlices slices(raster.cells, a, b);
    const std::int32_t count = slices.count();
    slices.for_each([&](const CellSlice& slice) {
        const std::uint8_t eighth = eighth_of(slice.number, count);
        if ((hidden & eighth) != 0 && !for_each_cell_of(slice, [&](std::size_t cell) {
                visit();
                return near < raster.cells.blocked[cell];
            }))
            hidden = static_cast<std::uint8_t>(hidden & ~eighth);
        return true;
    });
    return hidden;
}

/// Of each edge how near it is in the planes of all triangles that have it.
std::vector<double> nearness_of_edges(const CellRaster& raster) {
    std::vector<double> nearness(
        raster.edges.edges.size(), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < raster.slopes.size(); ++i)
        for (const std::uint32_t edge : raster.edges.of_triangle[i]) {
            const auto& [begin, end] = raster.edges.edges[edge];
            nearness[edge] = std::max(
                nearness[edge],
                nearest_for_hiding(
                    raster.slopes[i],
                    std::array{
                        raster.scene.vertices[begin].point, raster.scene.vertices[end].point}));
        }
    return nearness;
}

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

/// Which edges lie in a cell that what was changed touches, or did.
std::vector<std::uint8_t>
edges_near(const SceneChange& change, const CellRaster& raster, const Cells& cells) {
    std::vector<std::uint8_t> is_changed(cells.blocked.size());
    const auto mark = [&](const std::array<ScreenVertex, 3>& corners) {
        for_each_cell_of(cells, corners, [&](std::size_t cell) { is_changed[cell] = 1; });
    };
    for (const std::uint32_t triangle : change.triangles)
        mark(corners_of(raster.scene, raster.scene.triangles[triangle]));
    for (const std::array<ScreenVertex, 3>& corners : change.places)
        mark(corners);
    std::vector<std::uint8_t> near(raster.edges.edges.size());
    parallel_ranges(near.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto point = [&](std::uint32_t vertex) {
                return raster.scene.vertices[vertex].point;
            };
            const auto& [begin, end] = raster.edges.edges[i];
            const bool is_far =
                for_each_cell_along(cells, point(begin), point(end), [&](std::size_t cell) {
                    return is_changed[cell] == 0;
                });
            near[i] = is_far ? 0 : 1;
        }
    });
    return near;
}

/// The cells along the edges.
std::vector<std::uint8_t> cells_along(
    const std::vector<std::uint8_t>& is_edge_asked, const CellRaster& raster, const Cells& cells) {
    std::vector<std::uint8_t> is_asked(cells.blocked.size());
    for (std::size_t i = 0; i < is_edge_asked.size(); ++i) {
        if (is_edge_asked[i] == 0)
            continue;
        const auto& [begin, end] = raster.edges.edges[i];
        for_each_cell_along(
            cells,
            raster.scene.vertices[begin].point,
            raster.scene.vertices[end].point,
            [&](std::size_t cell) {
                is_asked[cell] = 1;
                return true;
            });
    }
    return is_asked;
}

/// How much of the time goes into what all edges are compared with.
constexpr double part_of_preparation = 0.2;

/// Of the whole scene or, where only that was changed, for the edges near it.
CellRaster raster_of(
    const ScreenScene& scene,
    const SceneChange* change,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress_between(progress, 0, part_of_preparation), 6);
    const auto next_stage = [&] {
        stop_if_raised(cancel);
        stages.next(1);
    };
    next_stage();
    require_raster_memory(scene);
    CellRaster raster = {scene, slopes_of(scene), {}, {}, {}, {}, {}, {}, {}, {}};
    raster.corners.resize(scene.triangles.size());
    for (std::size_t i = 0; i < raster.corners.size(); ++i) {
        const std::array<ScreenVertex, 3> corners = corners_of(scene, scene.triangles[i]);
        raster.corners[i] = {corners[0].point, corners[1].point, corners[2].point};
    }
    next_stage();
    raster.edges = screen_edges(scene);
    next_stage();
    const std::vector<EdgeNeighbours> neighbours = edge_neighbours(scene, raster.edges);
    if (std::ranges::any_of(scene.triangles, &ScreenTriangle::is_shadow)) {
        raster.shadowed = shadowed_sources(scene, raster.edges);
        raster.inner.resize(neighbours.size());
        for (std::size_t i = 0; i < neighbours.size(); ++i)
            raster.inner[i] = is_inner(scene, neighbours[i]) ? 1 : 0;
    }
    next_stage();
    AskedCells asked;
    if (change != nullptr)
        asked = [&](const Cells& cells) {
            raster.is_near_change = edges_near(*change, raster, cells);
            return cells_along(raster.is_near_change, raster, cells);
        };
    const SheetScene sheets = {scene, raster.edges, neighbours, raster.slopes};
    raster.cells = cells_of(scene, raster.slopes, cancel, asked, &sheets);
    next_stage();
    block_by_sheets(raster.cells, sheets, cancel);
    raster.shadow_cells = shadow_cells_of(raster.cells, scene, raster.slopes, cancel);
    next_stage();
    const std::vector<double> nearness = nearness_of_edges(raster);
    const HiddenSquares squares(raster.cells);
    raster.hidden_eighths.resize(raster.edges.edges.size());
    parallel_ranges(raster.hidden_eighths.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t i = first; i < last; ++i)
            raster.hidden_eighths[i] =
                hidden_eighths(raster, squares, raster.edges.edges[i], nearness[i], [] {});
    });
    return raster;
}

/// Of the pieces before, those of edges from this one on.
auto first_piece_of(const std::vector<VisiblePiece>& before, ScreenEdges::Edge edge) {
    return std::lower_bound(
        before.begin(),
        before.end(),
        edge,
        [](const VisiblePiece& piece, const ScreenEdges::Edge& value) {
            return piece.edge < value;
        });
}

/// How many of the pieces before are those of the edge.
std::size_t count_pieces_of(const std::vector<VisiblePiece>& before, ScreenEdges::Edge edge) {
    std::size_t count = 0;
    for (auto i = first_piece_of(before, edge); i != before.end() && i->edge == edge; ++i)
        ++count;
    return count;
}

/// An edge, and how many marks at equal distances lie on it where all edges are laid end to end.
struct MarkedEdge {
    std::uint32_t edge = 0;
    double marks = 0;
    double weight = 0; ///< about as many cells as it touches
};

/// One edge of 256 or so, but enough of them in any case: long ones more often, since more can
/// cross them.
std::vector<MarkedEdge> marked_edges(const CellRaster& raster, double& distance) {
    constexpr double least_marks = 512;
    constexpr double edges_per_mark = 256;
    const double cell = std::ldexp(1.0, raster.cells.shift);
    const auto weight_of = [&](const ScreenEdges::Edge& edge) {
        const ScreenStep along =
            step(raster.scene.vertices[edge.begin].point, raster.scene.vertices[edge.end].point);
        return 1 + static_cast<double>(std::abs(along.x) + std::abs(along.y)) / cell;
    };
    const std::vector<ScreenEdges::Edge>& edges = raster.edges.edges;
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
        marked.push_back({i, marks, weight});
    }
    return marked;
}

/// About how much will be found.
struct Expected {
    double pieces = 0;
    double pairs = 0; ///< that pass through each other, as often as edges tell them
};

/// From a few edges (systematic sampling, in proportion to their lengths).
Expected expected(
    const CellRaster& raster, const std::vector<VisiblePiece>& before, const CancelFlag* cancel) {
    PartSweeps sweeps(raster); // of its own: what they count is not counted
    double distance = 0;
    const std::vector<MarkedEdge> marked = marked_edges(raster, distance);
    std::vector<Expected> found(marked.size());
    parallel_ranges(marked.size(), 16, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        std::unique_ptr<PartSweep> sweep = sweeps.take();
        for (std::size_t i = first; i < last; ++i) {
            const std::uint32_t edge = marked[i].edge;
            if (!raster.is_near_change.empty() && raster.is_near_change[edge] == 0) {
                found[i].pieces =
                    static_cast<double>(count_pieces_of(before, raster.edges.edges[edge]));
                continue;
            }
            const VisiblePieces& pieces = sweep->followed(edge);
            found[i] = {
                static_cast<double>(pieces.pieces.size()),
                static_cast<double>(pieces.penetrating.size())};
        }
        sweeps.give_back(std::move(sweep));
    });
    Expected all;
    for (std::size_t i = 0; i < marked.size(); ++i) {
        const double edges = distance * marked[i].marks / marked[i].weight; // that it stands for
        all.pieces += edges * found[i].pieces;
        all.pairs += edges * found[i].pairs;
    }
    return all;
}

/// Of so few edges there are never so many pieces that memory could run out.
constexpr std::size_t few_edges = 1024;

void check_memory(
    const CellRaster& raster,
    const std::vector<VisiblePiece>& before,
    const ExpectPieces& expect,
    const CancelFlag* cancel) {
    if (raster.edges.edges.size() < few_edges)
        return;
    const auto [pieces, pairs] = expected(raster, before, cancel);
    require_piece_memory(pieces, pairs);
    if (expect)
        expect(pieces);
}

/// Follows the edges that are near what was changed, or all. What is found lies in parts, one
/// behind the other.
std::vector<VisiblePieces> follow_edges(
    const CellRaster& raster,
    const std::vector<VisiblePiece>& before,
    const ExpectPieces& expect,
    const Progress& progress,
    const CancelFlag* cancel,
    CellCounts& counts) {
    constexpr std::size_t part = 4096; // edges
    const std::size_t edges = raster.edges.edges.size();
    std::vector<VisiblePieces> parts((edges + part - 1) / part);
    PartSweeps sweeps(raster);
    check_memory(raster, before, expect, cancel);
    std::mutex mutex;
    std::size_t done = 0;
    parallel_ranges(parts.size(), 1, [&](std::size_t first, std::size_t last) {
        std::unique_ptr<PartSweep> sweep = sweeps.take();
        for (std::size_t i = first; i < last; ++i)
            parts[i] = sweep->followed(i * part, std::min(edges, (i + 1) * part), cancel);
        sweeps.give_back(std::move(sweep));
        const std::lock_guard lock(mutex);
        done += last - first;
        if (progress)
            progress(static_cast<double>(done) / static_cast<double>(parts.size()));
    });
    counts.add_followed(sweeps.counts());
    return parts;
}

/// Which of the pieces before are those of edges that are there still, and far from the change.
std::vector<std::uint8_t>
kept_pieces(const CellRaster& raster, const std::vector<VisiblePiece>& before) {
    const std::vector<ScreenEdges::Edge>& edges = raster.edges.edges;
    std::vector<std::uint8_t> is_kept(before.size());
    std::size_t edge = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        while (edge < edges.size() && edges[edge] < before[i].edge)
            ++edge;
        const bool is_there = edge < edges.size() && edges[edge] == before[i].edge;
        is_kept[i] = is_there && raster.is_near_change[edge] == 0 ? 1 : 0;
    }
    return is_kept;
}

/// Counts what was done before edges were followed, by doing it once more.
void count_cells(const CellRaster& raster, CellCounts& counts) {
    counts.cells = raster.cells.blocked.size();
    counts.entries = raster.cells.triangles.size();
    counts.edges = raster.edges.edges.size();
    const auto touch = [&](auto...) { ++counts.touched; };
    const std::vector<EdgeNeighbours> neighbours = edge_neighbours(raster.scene, raster.edges);
    const SheetScene sheets = {raster.scene, raster.edges, neighbours, raster.slopes};
    const HiddenSquares before_sheets(cells_of(raster.scene, raster.slopes, nullptr, {}, &sheets));
    for (std::size_t i = 0; i < raster.corners.size(); ++i) {
        const double near = nearest_for_hiding(raster.slopes[i], raster.corners[i]);
        const ScreenTriangle& triangle = raster.scene.triangles[i];
        if (triangle.is_shadow() || !before_sheets.hide(near, raster.corners[i], touch))
            for_each_cell_of(raster.cells, corners_of(raster.scene, triangle), touch);
    }
    const std::vector<double> nearness = nearness_of_edges(raster);
    const HiddenSquares squares(raster.cells);
    for (std::size_t i = 0; i < raster.edges.edges.size(); ++i)
        hidden_eighths(
            raster, squares, raster.edges.edges[i], nearness[i], [&] { ++counts.edge_cells; });
}

void sort_pairs(std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

} // namespace

VisiblePieces cell_raster(
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect,
    CellCounts* counts) {
    std::vector<VisiblePieces> parts;
    {
        CellRaster raster = raster_of(scene, nullptr, progress, cancel);
        CellCounts counted;
        if (counts != nullptr)
            count_cells(raster, counted);
        free_room(raster.cells.blocked); // which edges were compared with already
        parts = follow_edges(
            raster,
            {},
            expect,
            progress_between(progress, part_of_preparation, 1),
            cancel,
            counted);
        if (counts != nullptr)
            *counts = counted;
    }
    VisiblePieces result = joined(std::move(parts));
    sort_pairs(result.penetrating);
    return result;
}

VisiblePieces cell_raster_after(
    const SceneChange& change,
    VisiblePieces before,
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect) {
    std::vector<std::uint8_t> is_changed(scene.triangles.size());
    for (const std::uint32_t triangle : change.triangles)
        is_changed[triangle] = 1;
    // Where no shadow is near, there is none.
    const auto unlit = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? 0 : scene.unlit_of(scene.triangles[triangle].source);
    };
    before.unlit.clear();
    std::vector<VisiblePieces> parts;
    std::vector<std::uint8_t> is_kept;
    {
        CellRaster raster = raster_of(scene, &change, progress, cancel);
        free_room(raster.cells.blocked);
        if (raster.may_be_unlit())
            for (const VisiblePiece& piece : before.pieces)
                before.unlit.push_back({unlit(piece.left), unlit(piece.right)});
        is_kept = kept_pieces(raster, before.pieces);
        CellCounts uncounted;
        parts = follow_edges(
            raster,
            before.pieces,
            expect,
            progress_between(progress, part_of_preparation, 1),
            cancel,
            uncounted);
    }
    const auto penetrating = std::move(before.penetrating);
    VisiblePieces result = merged(std::move(before), is_kept, joined(std::move(parts)));
    for (const auto& [a, b] : penetrating)
        if (is_changed[a] == 0 && is_changed[b] == 0)
            result.penetrating.emplace_back(a, b);
    sort_pairs(result.penetrating);
    return result;
}

} // namespace vera
