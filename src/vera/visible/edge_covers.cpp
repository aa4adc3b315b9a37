// SPDX-License-Identifier: Apache-2.0
// How triangles lie to an edge: which parts of it they cover, and which of these are hidden. The
// other half of EdgeSweep.
#include "vera/visible/edge_sweep.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>

namespace vera {

namespace {

constexpr SegmentPlace beginning = {0, 1};
constexpr SegmentPlace ending = {1, 1};

SegmentPlace clamped(SegmentPlace place) {
    if (place.numerator < 0)
        return beginning;
    return place.numerator > place.denominator ? ending : place;
}

/// The parts of the line that lie in the triangle begin and end where it crosses the sides that
/// begin at these corners.
struct SidesAcross {
    std::uint8_t enters = 0;
    std::uint8_t leaves = 0;
};

/// By which of the corners lie on the left, as bits. Corners go round to the left: the line enters
/// where they go from its left to its right.
constexpr std::array<SidesAcross, 8> sides_across = {
    {{}, {0, 2}, {1, 0}, {1, 2}, {2, 1}, {0, 1}, {2, 0}, {}}};

} // namespace

/// Tells how those of the triangles list(cell) of the cells along the edge that matter lie to it,
/// but for slices of cells that are hidden.
template <typename List, typename DoesMatter>
void EdgeSweep::classify_along(
    const List& list, const DoesMatter& does_matter, std::uint8_t hidden_eighths) {
    const SegmentSlices slices(raster_.cells, begin_, end_);
    const std::int32_t count = slices.count();
    slices.for_each([&](const CellSlice& slice) {
        if ((hidden_eighths & eighth_of(slice.number, count)) != 0) {
            hide_between(slice.enters - slices.along(begin_), slice.leaves - slices.along(begin_));
            return true;
        }
        return for_each_cell_of(slice, [&](std::size_t cell) {
            const std::span<const std::uint32_t> here = list(cell);
            ++counts_.followed_cells;
            counts_.looked_at += here.size();
            for (const std::uint32_t triangle : here)
                if (std::uint32_t& stamp = stamps_[triangle];
                    stamp != stamp_ && does_matter(triangle)) {
                    stamp = stamp_;
                    ++counts_.candidates;
                    classify(triangle);
                }
            return true;
        });
    });
}

/// Hides the part of the edge between two coordinates along which it is longer, from its begin on.
void EdgeSweep::hide_between(std::int64_t first, std::int64_t last) {
    if (first == last)
        return; // the edge ends at the border of a cell
    const std::int64_t length = std::abs(way_.x) >= std::abs(way_.y) ? way_.x : way_.y;
    if (length < 0) {
        std::swap(first, last);
        first = -first;
        last = -last;
    }
    hidden_slices_.push_back(
        {no_triangle,
         left_side | right_side,
         no_edge,
         {first, std::abs(length)},
         {last, std::abs(length)}});
}

/// Of a triangle with a side in the line of the edge, from corner `side` on.
void EdgeSweep::add_beside(
    std::uint32_t triangle, const std::array<ScreenPoint, 3>& corners, std::size_t side) {
    SegmentPlace first = place_on(begin_, end_, corners[side]);
    SegmentPlace last = place_on(begin_, end_, corners[(side + 1) % 3]);
    const bool is_left = order(first, last) < 0; // since corners go round to the left
    if (!is_left)
        std::swap(first, last);
    first = clamped(first);
    last = clamped(last);
    if (order(first, last) >= 0)
        return;
    const std::uint32_t edge = raster_.edges.of_triangle[triangle][side];
    covers_.push_back(
        {triangle,
         is_left ? left_side : right_side,
         raster_.is_inner(edge) ? no_edge : edge,
         first,
         last});
}

/// Where the edge's line crosses the triangle's side from a corner on, the orientations of whose
/// ends with the line are side and next_side, of different signs.
SegmentPlace EdgeSweep::crossing_of_side(
    ScreenPoint corner, ScreenPoint next, std::int64_t side, std::int64_t next_side) const {
    // As crossing_place(), whose denominator is the cross product of both ways.
    const std::int64_t numerator = cross(step(begin_, corner), step(corner, next));
    return next_side > side ? SegmentPlace{numerator, next_side - side}
                            : SegmentPlace{-numerator, side - next_side};
}

/// Where the line passes into and out of a triangle with a corner on it.
std::array<SegmentPlace, 2> EdgeSweep::places_of_touching(const Across& across) {
    const std::array<ScreenPoint, 3>& corners = raster_.corners[across.triangle];
    const std::array<std::int64_t, 3>& sides = across.sides;
    std::array<SegmentPlace, 2> places;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3 && count < 2; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (sides[i] == 0) {
            places[count++] = place_on(begin_, end_, corners[i]);
            add_touch(corners[i]);
        } else if ((sides[i] < 0 && sides[next] > 0) || (sides[i] > 0 && sides[next] < 0)) {
            places[count++] = crossing_of_side(corners[i], corners[next], sides[i], sides[next]);
        }
    }
    if (order(places[1], places[0]) < 0)
        std::swap(places[0], places[1]);
    return places;
}

void EdgeSweep::add_across(const Across& across) {
    const std::array<std::int64_t, 3>& sides = across.sides;
    SegmentPlace first;
    SegmentPlace last;
    if (sides[0] == 0 || sides[1] == 0 || sides[2] == 0) {
        const std::array<SegmentPlace, 2> places = places_of_touching(across);
        first = places[0];
        last = places[1];
    } else {
        const std::array<ScreenPoint, 3>& corners = raster_.corners[across.triangle];
        const auto place = [&](std::size_t side) {
            const std::size_t next = (side + 1) % 3;
            return crossing_of_side(corners[side], corners[next], sides[side], sides[next]);
        };
        const auto [enters, leaves] = sides_across
            [(sides[0] > 0 ? 1U : 0U) | (sides[1] > 0 ? 2U : 0U) | (sides[2] > 0 ? 4U : 0U)];
        first = place(enters);
        last = place(leaves);
    }
    if (last.numerator <= 0 || first.numerator >= first.denominator)
        return; // of the line alone
    first = clamped(first);
    last = clamped(last);
    if (order(first, last) < 0 && !is_hidden(first, last))
        covers_.push_back({across.triangle, left_side | right_side, no_edge, first, last});
}

/// Tells how the triangle lies to the edge.
void EdgeSweep::classify(std::uint32_t triangle) {
    const std::array<ScreenPoint, 3>& corners = raster_.corners[triangle];
    const auto [x0, x1, x2] = std::array{corners[0].x, corners[1].x, corners[2].x};
    const auto [y0, y1, y2] = std::array{corners[0].y, corners[1].y, corners[2].y};
    Across across = {triangle, {}};
    for (std::size_t i = 0; i < 3; ++i)
        across.sides[i] = cross(way_, step(begin_, corners[i])); // orientation()
    const auto [a, b, c] = across.sides;
    // By bits, without a jump that nothing foretells, but for one.
    const auto bit = [](bool is_so) { return is_so ? 1U : 0U; };
    const unsigned is_beyond = bit(std::max({x0, x1, x2}) < least_.x)
        | bit(std::min({x0, x1, x2}) > most_.x) | bit(std::max({y0, y1, y2}) < least_.y)
        | bit(std::min({y0, y1, y2}) > most_.y);
    const unsigned left = bit(a > 0) | bit(b > 0) | bit(c > 0);
    const unsigned right = bit(a < 0) | bit(b < 0) | bit(c < 0);
    const unsigned on_line = bit(a == 0) + bit(b == 0) + bit(c == 0);
    if ((is_beyond | bit(((left & right) | on_line) == 0)) != 0)
        return;
    if ((left & right) != 0)
        return across_.push_back(across);
    if (on_line == 2)
        return add_beside(
            triangle,
            corners,
            across.sides[0] != 0       ? 1
                : across.sides[1] != 0 ? 2
                                       : 0);
    for (std::size_t i = 0; i < 3 && on_line == 1; ++i)
        if (across.sides[i] == 0)
            add_touch(corners[i]);
}

/// Of a triangle that has a corner on the line of the edge.
void EdgeSweep::add_touch(ScreenPoint corner) {
    const SegmentPlace place = place_on(begin_, end_, corner);
    if (place.numerator > 0 && place.numerator < place.denominator)
        touches_.push_back(place);
}

/// Finds the parts of the edge along which triangles surely lie before all that covers but one side
/// of it: the same is then seen on both. They become covers by no triangle; the triangles before
/// them are taken out of across_, since they matter nowhere else.
void EdgeSweep::find_hidden_parts() {
    first_hidden_ = last_hidden_ = covers_.size();
    // How near, with their margins, what covers but one side is at both ends of the edge.
    std::array<double, 2> to_hide = {-1, -1};
    const std::array<NearnessPlace, 2> ends = {place_at(0), place_at(1)};
    for (const Cover& cover : covers_) {
        if (cover.is_on_both_sides())
            continue;
        const NearnessSlope& slope = raster_.slopes[cover.triangle];
        for (std::size_t i = 0; i < 2; ++i)
            to_hide[i] = std::max(to_hide[i], slope.at(ends[i]) + sure_margin(slope));
    }
    std::erase_if(across_, [&](const Across& across) {
        const NearnessSlope& slope = raster_.slopes[across.triangle];
        const double margin = sure_margin(slope);
        const bool hides = open_parts_.empty() && slope.at(ends[0]) - margin > to_hide[0]
            && slope.at(ends[1]) - margin > to_hide[1] && !is_shadow(across.triangle);
        if (hides)
            add_across(across);
        return hides;
    });
    covers_.insert(covers_.end(), hidden_slices_.begin(), hidden_slices_.end());
    const auto first = covers_.begin() + static_cast<std::ptrdiff_t>(first_hidden_);
    std::sort(first, covers_.end(), [](const Cover& a, const Cover& b) {
        return order(a.first, b.first) < 0;
    });
    auto last = first; // behind the parts
    for (auto cover = first; cover != covers_.end(); ++cover) {
        if (last != first && order(cover->first, (last - 1)->last) <= 0) {
            if (order(cover->last, (last - 1)->last) > 0)
                (last - 1)->last = cover->last;
        } else {
            *last++ = {no_triangle, left_side | right_side, no_edge, cover->first, cover->last};
        }
    }
    covers_.erase(last, covers_.end());
    last_hidden_ = covers_.size();
}

/// In cells that hide nothing.
void EdgeSweep::find_open_parts() {
    open_parts_.clear();
    if (raster_.cells.hides_nothing.empty())
        return;
    const SegmentSlices slices(raster_.cells, begin_, end_);
    const double begin = slices.along(begin_);
    const double length = slices.along(end_) - begin;
    slices.for_each([&](const CellSlice& slice) {
        const bool hides = for_each_cell_of(
            slice, [&](std::size_t cell) { return !raster_.cells.hides_nothing_in(cell); });
        if (!hides) {
            const auto place = [&](std::int64_t at) {
                return (static_cast<double>(at) - begin) / length;
            };
            const auto [first, last] = std::minmax({place(slice.enters), place(slice.leaves)});
            open_parts_.push_back({first, last});
        }
        return true;
    });
}

/// Of what find_hidden_parts() found.
bool EdgeSweep::is_hidden(SegmentPlace first, SegmentPlace last) const {
    const auto parts = std::span(covers_).subspan(first_hidden_, last_hidden_ - first_hidden_);
    // They lie apart from each other, in their order.
    const auto behind = std::partition_point(parts.begin(), parts.end(), [&](const Cover& part) {
        return order(part.first, first) <= 0;
    });
    return behind != parts.begin() && order(last, (behind - 1)->last) <= 0;
}

void EdgeSweep::add_all_across() {
    for (const Across& across : across_)
        add_across(across);
    across_.clear();
}

/// Whether the edge parts nothing that is seen: it lies within a source, and where it goes there is
/// no other. Not told part by part: what covers an edge does so to where its own sides end, also in
/// cells in whose lists it is not.
bool EdgeSweep::lies_within_one_source(std::uint32_t edge) const {
    return raster_.is_within_source(edge)
        && for_each_cell_along(raster_.cells, begin_, end_, [&](std::size_t cell) {
               return raster_.shows_one_source(cell);
           });
}

/// Gathers the covers that matter for what is seen beside the edge; false where it parts nothing.
bool EdgeSweep::gather(std::uint32_t edge) {
    const auto& [begin, end] = raster_.edges.edges[edge];
    begin_ = raster_.scene.vertices[begin].point;
    end_ = raster_.scene.vertices[end].point;
    if (lies_within_one_source(edge))
        return false;
    way_ = step(begin_, end_);
    least_ = {std::min(begin_.x, end_.x), std::min(begin_.y, end_.y)};
    most_ = {std::max(begin_.x, end_.x), std::max(begin_.y, end_.y)};
    seen_.follow(begin_, end_);
    ++stamp_;
    ++counts_.followed;
    across_.clear();
    covers_.clear();
    hidden_slices_.clear();
    touches_.clear();
    first_hidden_ = last_hidden_ = 0;
    const auto all = [](std::uint32_t) { return true; };
    const auto surfaces = [&](std::size_t cell) { return raster_.cells.triangles_of(cell); };
    const auto add_shadows_on = [&](std::uint32_t source) {
        classify_along(
            [&](std::size_t cell) {
                return raster_.shadow_cells.shadows_on(cell, source, raster_.scene);
            },
            all);
        add_all_across();
    };
    const std::uint32_t shadowed = raster_.shadowed_source(edge);
    const bool is_of_surfaces = shadowed == no_source;
    const bool is_of_shadows = !is_of_surfaces && shadowed != several_sources;
    if (is_of_shadows) {
        add_shadows_on(shadowed);
        classify_along(surfaces, [&](std::uint32_t i) { return source_of(i) == shadowed; });
        add_all_across();
        if (!ends_a_shadow_somewhere())
            return false;
    }
    // Shadows may be seen on surfaces that they are no matter of, and so need all of these.
    const bool are_there_shadows = !raster_.shadow_cells.triangles.empty();
    // What is left out where the edge is hidden must be found to be hidden, as it is below.
    const bool leaves_out = !are_there_shadows && shadowed != several_sources;
    classify_along(surfaces, all, leaves_out ? raster_.hidden_eighths[edge] : 0);
    find_open_parts();
    if (shadowed != several_sources) {
        find_hidden_parts();
        if (is_hidden(beginning, ending))
            return false;
    }
    add_all_across();
    if (is_of_shadows || !are_there_shadows)
        return true;
    find_seen_sources(is_of_surfaces);
    for (const std::uint32_t source : seen_sources_)
        add_shadows_on(source);
    return !seen_sources_.empty();
}

} // namespace vera
