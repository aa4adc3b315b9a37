// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/covered_union.h"

#include <algorithm>
#include <optional>

namespace vera {

namespace {

/// Of a piece, by the free cells beside it, which it is the upper or the lower border of.
std::int32_t place_across(std::int32_t free_cell, bool is_upper) {
    return 2 * free_cell + (is_upper ? 1 : 0);
}

bool is_upper_border(const WindowSegment& piece) {
    return piece.across % 2 != 0;
}

/// Where it lies: at that coordinate across.
std::int32_t coordinate(const WindowSegment& piece) {
    return (piece.across + 1) / 2;
}

/// The pieces whose free cells are among these.
PlaceRange pieces_beside(PlaceRange cells) {
    return {2 * cells.begin, 2 * cells.end};
}

/// Along the piece, with its free side on the left.
GridEdge edge_along(std::size_t axis, const WindowSegment& piece) {
    const auto corner = [&](std::int32_t along) {
        const std::int32_t across = coordinate(piece);
        return axis == 0 ? GridCorner{along, across} : GridCorner{across, along};
    };
    const GridCorner begin = corner(piece.along.begin);
    const GridCorner end = corner(piece.along.end);
    return (axis == 0) != is_upper_border(piece) ? GridEdge{begin, end} : GridEdge{end, begin};
}

PlaceRange common_part(PlaceRange a, PlaceRange b) {
    return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

} // namespace

CoveredUnion::CoveredUnion(std::int32_t columns, std::int32_t rows, WindowCounts& counts)
    : along_{WindowTree(columns, counts), WindowTree(rows, counts)} {}

/// Where the row of cells inside the side is free. Borders across it that are met in the box part
/// what is free from what is covered; where there are none it is all the same.
BoxSide CoveredUnion::side_of(const BoxMeeting& meeting, std::size_t axis, bool is_upper) const {
    const PlaceRange rows = meeting.box.cells.at(1 - axis);
    const PlaceRange range = meeting.box.cells.at(axis);
    BoxSide side = {axis, is_upper ? rows.end - 1 : rows.begin, is_upper, {}};
    std::optional<std::int32_t> begin; // of what is free
    bool is_crossed = false;
    for (const WindowSegment& crossing : meeting.pieces.at(1 - axis)) {
        if (!crossing.along.contains(side.inside))
            continue;
        is_crossed = true;
        if (is_upper_border(crossing)) {
            side.free.push_back({begin.value_or(range.begin), coordinate(crossing)});
            begin.reset();
        } else {
            begin = coordinate(crossing);
        }
    }
    if (!is_crossed) {
        const std::optional<WindowSegment> before =
            along_.at(1 - axis).last_before(side.inside, pieces_beside(range).begin);
        if (!before || !is_upper_border(*before))
            begin = range.begin;
    }
    if (begin)
        side.free.push_back({*begin, range.end});
    return side;
}

/// Takes away what of the piece has its free cells in the box.
void CoveredUnion::uncover(const CellBox& box, std::size_t axis, const WindowSegment& piece) {
    WindowTree& tree = along_.at(axis);
    const PlaceRange range = box.cells.at(axis);
    tree.remove(piece);
    if (piece.along.begin < range.begin)
        tree.insert({piece.across, {piece.along.begin, range.begin}});
    if (range.end < piece.along.end)
        tree.insert({piece.across, {range.end, piece.along.end}});
}

/// Where cells inside the side and those beyond were free there is a new border, whose free side
/// lies beyond; where those beyond were covered, a piece was met.
void CoveredUnion::add_border(const BoxSide& side, const std::vector<WindowSegment>& met) {
    const std::int32_t coinciding = place_across(side.inside, side.is_upper);
    const std::int32_t beyond = side.is_upper ? side.inside + 1 : side.inside - 1;
    const std::int32_t across = place_across(beyond, !side.is_upper);
    const auto insert = [&](PlaceRange along) {
        if (along.begin < along.end)
            along_.at(side.axis).insert({across, along});
    };
    auto covered = std::lower_bound(
        met.begin(), met.end(), coinciding, [](const WindowSegment& piece, std::int32_t at) {
            return piece.across < at;
        });
    for (PlaceRange free : side.free) {
        for (; covered != met.end() && covered->across == coinciding
             && covered->along.begin < free.end;
             ++covered) {
            insert({free.begin, covered->along.begin});
            free.begin = std::max(free.begin, covered->along.end);
        }
        insert(free);
    }
}

BoxMeeting CoveredUnion::meeting(const CellBox& box) const {
    BoxMeeting meeting = {box, {}, {}};
    for (std::size_t axis = 0; axis < 2; ++axis)
        meeting.pieces.at(axis) =
            along_.at(axis).in_window(box.cells.at(axis), pieces_beside(box.cells.at(1 - axis)));
    for (std::size_t axis = 0; axis < 2; ++axis)
        for (const bool is_upper : {false, true})
            meeting.sides.push_back(side_of(meeting, axis, is_upper));
    return meeting;
}

/// Pieces in the box become the border of its free part, and so do its free sides.
std::size_t BoxMeeting::most_edges() const {
    std::size_t edges = pieces[0].size() + pieces[1].size();
    for (const BoxSide& side : sides)
        edges += side.free.size();
    return edges;
}

/// What of pieces goes on outside the box stays; where sides were free there is a new border, which
/// pieces that coincide with a side part once more each.
std::size_t CoveredUnion::most_new_entries(const BoxMeeting& meeting) const {
    std::size_t entries = 0;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const PlaceRange range = meeting.box.cells.at(axis);
        std::size_t segments = 0;
        for (const WindowSegment& piece : meeting.pieces.at(axis)) {
            segments +=
                (piece.along.begin < range.begin ? 1 : 0) + (range.end < piece.along.end ? 1 : 0);
            for (const BoxSide& side : meeting.sides)
                if (side.axis == axis && piece.across == place_across(side.inside, side.is_upper))
                    ++segments;
        }
        for (const BoxSide& side : meeting.sides)
            if (side.axis == axis)
                segments += side.free.size();
        entries += segments * along_.at(axis).most_entries_of_segment();
    }
    return entries;
}

std::vector<GridEdge> CoveredUnion::cover(const BoxMeeting& meeting) {
    const CellBox& box = meeting.box;
    std::vector<GridEdge> edges;
    const auto add_edge = [&](std::size_t axis, std::int32_t across, PlaceRange along) {
        edges.push_back(edge_along(axis, {across, along}));
    };
    for (std::size_t axis = 0; axis < 2; ++axis)
        for (const WindowSegment& piece : meeting.pieces.at(axis)) {
            const PlaceRange rows = box.cells.at(1 - axis);
            // Those on a side of the box are part of what is free inside it.
            if (rows.begin < coordinate(piece) && coordinate(piece) < rows.end)
                add_edge(axis, piece.across, common_part(piece.along, box.cells.at(axis)));
            uncover(box, axis, piece);
        }
    for (const BoxSide& side : meeting.sides) {
        for (const PlaceRange free : side.free)
            add_edge(side.axis, place_across(side.inside, side.is_upper), free);
        add_border(side, meeting.pieces.at(side.axis));
    }
    return edges;
}

} // namespace vera
