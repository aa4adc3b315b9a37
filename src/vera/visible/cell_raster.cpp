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

/// Whether the segment and the triangle have a point in common: exactly where no line parts them,
/// of those along it and along the sides (the theorem of separating axes).
bool do_meet(ScreenPoint a, ScreenPoint b, const std::array<ScreenPoint, 3>& corners) {
    bool is_left = true;
    bool is_right = true;
    for (const ScreenPoint corner : corners) {
        const std::int64_t side = orientation(a, b, corner);
        is_left = is_left && side > 0;
        is_right = is_right && side < 0;
    }
    if (is_left || is_right)
        return false;
    for (std::size_t i = 0; i < 3; ++i) { // corners go round to the left
        const ScreenPoint from = corners[i];
        const ScreenPoint to = corners[(i + 1) % 3];
        if (orientation(from, to, a) < 0 && orientation(from, to, b) < 0)
            return false;
    }
    return true;
}

/// Tells what is near a change: what meets a triangle that is new or was there before, or comes to
/// a cell of the points near which all is asked again.
class NearChange {
public:
    NearChange(const SceneChange& change, const ScreenScene& scene, const Cells& cells)
        : cells_(cells)
        , is_changed_(cells.blocked.size())
        , first_of_cell_(cells.blocked.size(), none) {
        for (const std::uint32_t triangle : change.triangles)
            add(corners_of(scene, scene.triangles[triangle]));
        for (const std::array<ScreenVertex, 3>& corners : change.places)
            add(corners);
        for_each_cell_of_points(
            change.asked, cells, [&](std::size_t cell) { is_changed_[cell] = all_of_it; });
    }

    /// Which edges are.
    std::vector<std::uint8_t> edges_near(const CellRaster& raster) const;

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    enum Changed : std::uint8_t { nowhere, somewhere, all_of_it };

    /// Of the list of a cell.
    struct Entry {
        std::uint32_t triangle = 0;
        std::uint32_t next = none;
    };

    void add(const std::array<ScreenVertex, 3>& corners);
    bool meets_in_cell(ScreenPoint a, ScreenPoint b, std::size_t cell) const;

    const Cells& cells_;
    std::vector<std::array<ScreenPoint, 3>> triangles_;
    std::vector<std::uint8_t> is_changed_;
    std::vector<std::uint32_t> first_of_cell_; ///< entry
    std::vector<Entry> entries_;
};

void NearChange::add(const std::array<ScreenVertex, 3>& corners) {
    const auto triangle = static_cast<std::uint32_t>(triangles_.size());
    triangles_.push_back({corners[0].point, corners[1].point, corners[2].point});
    for_each_cell_of(cells_, corners, [&](std::size_t cell) {
        is_changed_[cell] = somewhere;
        entries_.push_back({triangle, first_of_cell_[cell]});
        first_of_cell_[cell] = static_cast<std::uint32_t>(entries_.size() - 1);
    });
}

bool NearChange::meets_in_cell(ScreenPoint a, ScreenPoint b, std::size_t cell) const {
    if (is_changed_[cell] == all_of_it)
        return true;
    for (std::uint32_t i = first_of_cell_[cell]; i != none; i = entries_[i].next)
        if (do_meet(a, b, triangles_[entries_[i].triangle]))
            return true;
    return false;
}

std::vector<std::uint8_t> NearChange::edges_near(const CellRaster& raster) const {
    std::vector<std::uint8_t> near(raster.edges.edges.size());
    const CellsInRows changed_in_rows(cells_, is_changed_);
    // By its box, which most are far by.
    const auto may_be_near = [&](ScreenPoint a, ScreenPoint b) {
        const auto [left, right] = std::minmax(a.x, b.x);
        const auto [low, high] = std::minmax(a.y, b.y);
        // for_each_cell_along() looks a step beside the edge.
        const auto cell_of = [&](std::int32_t at) { return cells_.cell_of(std::max(at, 0)); };
        const std::int32_t last = cell_of(high + 1);
        for (std::int32_t row = cell_of(low - 1); row <= last; ++row)
            if (changed_in_rows.are_any({cell_of(left - 1), cell_of(right + 1)}, row))
                return true;
        return false;
    };
    parallel_ranges(near.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const ScreenPoint a = raster.scene.vertices[raster.edges.edges[i].begin].point;
            const ScreenPoint b = raster.scene.vertices[raster.edges.edges[i].end].point;
            const bool is_far =
                !may_be_near(a, b) || for_each_cell_along(cells_, a, b, [&](std::size_t cell) {
                    return !meets_in_cell(a, b, cell);
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
            of.is_near_change = NearChange(change, of.scene, cells).edges_near(of);
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
