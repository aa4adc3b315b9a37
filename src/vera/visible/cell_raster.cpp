// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cell_raster.h"

#include "vera/base/free_room.h"
#include "vera/base/progress_part.h"
#include "vera/visible/cell_raster_stages.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/piece_lists.h"

#include <algorithm>
#include <array>

namespace vera {

namespace {

/// Calls visit(cell) for the cells of the points, several where one lies on a border.
template <typename Visit>
void for_each_cell_of_points(
    std::span<const PackedPoint> points, const Cells& cells, const Visit& visit) {
    for (const PackedPoint& packed : points) {
        const ScreenPoint whole = RationalPoint(packed).whole;
        for (const std::int32_t x : {whole.x - 1, whole.x + 1})
            for (const std::int32_t y : {whole.y - 1, whole.y + 1})
                visit(cells.number(cells.cell_of(std::max(x, 0)), cells.cell_of(std::max(y, 0))));
    }
}

/// Which cells are touched by what was changed, or were.
std::vector<std::uint8_t>
cells_of_change(const SceneChange& change, const CellRaster& raster, const Cells& cells) {
    std::vector<std::uint8_t> is_changed(cells.blocked.size());
    const auto mark = [&](std::size_t cell) { mark_from_any_thread(is_changed[cell]); };
    constexpr std::size_t block = 1024; // triangles that a thread takes at a time
    parallel_ranges(change.triangles.size(), block, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const ScreenTriangle& triangle = raster.scene.triangles[change.triangles[i]];
            for_each_cell_of(cells, corners_of(raster.scene, triangle), mark);
        }
    });
    parallel_ranges(change.places.size(), block, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            for_each_cell_of(cells, change.places[i], mark);
    });
    for_each_cell_of_points(change.asked, cells, mark);
    return is_changed;
}

/// Which edges lie in one of the cells.
std::vector<std::uint8_t> edges_in(
    const std::vector<std::uint8_t>& is_changed, const CellRaster& raster, const Cells& cells) {
    std::vector<std::uint8_t> near(raster.edges.edges.size());
    const CellsInRows changed_in_rows(cells, is_changed);
    // By its box, which most are far by.
    const auto may_be_near = [&](ScreenPoint a, ScreenPoint b) {
        const auto [left, right] = std::minmax(a.x, b.x);
        const auto [low, high] = std::minmax(a.y, b.y);
        // for_each_cell_along() looks a step beside the edge.
        const auto cell_of = [&](std::int32_t at) { return cells.cell_of(std::max(at, 0)); };
        const std::int32_t last = cell_of(high + 1);
        for (std::int32_t row = cell_of(low - 1); row <= last; ++row)
            if (changed_in_rows.are_any({cell_of(left - 1), cell_of(right + 1)}, row))
                return true;
        return false;
    };
    parallel_ranges(near.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto point = [&](std::uint32_t vertex) {
                return raster.scene.vertices[vertex].point;
            };
            const auto& [begin, end] = raster.edges.edges[i];
            const bool is_far = !may_be_near(point(begin), point(end))
                || for_each_cell_along(cells, point(begin), point(end), [&](std::size_t cell) {
                       return is_changed[cell] == 0;
                   });
            near[i] = is_far ? 0 : 1;
        }
    });
    return near;
}

/// Of so few edges there are never so many pieces that memory could run out.
constexpr std::size_t few_edges = 1024;

void check_memory(
    const CellRaster& raster,
    std::size_t kept,
    const ExpectPieces& expect,
    const CancelFlag* cancel) {
    if (raster.edges.edges.size() < few_edges)
        return;
    auto [pieces, pairs] = expected_pieces(raster, 0, raster.edges.edges.size(), cancel);
    pieces += static_cast<double>(kept);
    require_piece_memory(pieces, pairs, raster.storage);
    if (expect)
        expect(pieces);
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
    const std::vector<double> nearness = nearness_of_edges(raster, 0, 0);
    const HiddenSquares squares(raster.cells);
    for (std::size_t i = 0; i < raster.edges.edges.size(); ++i)
        hidden_eighths(
            raster, squares, raster.edges.edges[i], nearness[i], [&] { ++counts.edge_cells; });
}

/// Takes out of the parts what penetrates.
std::vector<std::pair<std::uint32_t, std::uint32_t>>
take_penetrating(std::vector<SeenPart>& parts) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
    for (SeenPart& part : parts) {
        all.insert(all.end(), part.penetrating.begin(), part.penetrating.end());
        free_room(part.penetrating);
    }
    return all;
}

} // namespace

SeenPieces parted(VisiblePieces list) {
    return {parts_of(list), std::move(list.penetrating)};
}

VisiblePieces joined(SeenPieces seen) {
    VisiblePieces list = joined(std::move(seen.parts));
    list.penetrating = std::move(seen.penetrating);
    return list;
}

SeenPieces cell_raster_parts(
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect,
    CellCounts* counts) {
    SeenPieces seen;
    CellRaster raster = raster_of(scene, {}, progress, cancel);
    CellCounts counted;
    if (counts != nullptr)
        count_cells(raster, counted);
    free_room(raster.cells.blocked); // which edges were compared with already
    check_memory(raster, 0, expect, cancel);
    follow_edges(
        raster,
        0,
        raster.edges.edges.size(),
        progress_between(progress, part_of_preparation, 1),
        cancel,
        seen.parts,
        &counted);
    if (counts != nullptr)
        *counts = counted;
    seen.penetrating = take_penetrating(seen.parts);
    sort_pairs(seen.penetrating);
    return seen;
}

SeenPieces cell_raster_parts_after(
    const SceneChange& change,
    std::span<const PackedPoint> open,
    SeenPieces before,
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect) {
    SeenPieces seen;
    {
        std::vector<EdgePart> kept;
        const AskedOfRaster asked = [&](CellRaster& of, const Cells& cells) {
            of.is_near_change = edges_in(cells_of_change(change, of, cells), of, cells);
            // As soon as that is known: what comes takes the room of what is not kept.
            kept = kept_pieces(of, std::move(before.parts));
            std::vector<std::uint8_t> asked_cells = cells_along(of.is_near_change, of, cells);
            for_each_cell_of_points(open, cells, [&](std::size_t cell) {
                if (asked_cells[cell] != not_asked)
                    asked_cells[cell] = asked_with_hidden;
            });
            return asked_cells;
        };
        CellRaster raster = raster_of(scene, asked, progress, cancel);
        free_room(raster.cells.blocked);
        std::size_t kept_count = 0;
        for (const EdgePart& part : kept)
            kept_count += part.kept.size();
        check_memory(raster, kept_count, expect, cancel);
        follow_edges(
            raster,
            std::move(kept),
            progress_between(progress, part_of_preparation, 1),
            cancel,
            seen.parts);
    }
    seen.penetrating = take_penetrating(seen.parts);
    std::vector<std::uint8_t> is_changed(scene.triangles.size());
    for (const std::uint32_t triangle : change.triangles)
        is_changed[triangle] = 1;
    for (const auto& [a, b] : before.penetrating)
        if (is_changed[a] == 0 && is_changed[b] == 0)
            seen.penetrating.emplace_back(a, b);
    sort_pairs(seen.penetrating);
    return seen;
}

VisiblePieces cell_raster(
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect,
    CellCounts* counts) {
    return joined(cell_raster_parts(scene, progress, cancel, expect, counts));
}

VisiblePieces cell_raster_after(
    const SceneChange& change,
    std::span<const PackedPoint> open,
    VisiblePieces before,
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect) {
    return joined(cell_raster_parts_after(
        change, open, parted(std::move(before)), scene, progress, cancel, expect));
}

} // namespace vera
