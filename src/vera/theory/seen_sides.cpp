// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/seen_sides.h"

#include "vera/base/check.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <tuple>
#include <utility>

namespace vera {

namespace {

bool is_before(const RationalPoint& a, const RationalPoint& b) {
    return order(a, b) < 0;
}

bool is_same_place(const SweepPoint& a, const SweepPoint& b) {
    return a.x == b.x && a.first == b.first && a.second == b.second;
}

} // namespace

SeenSides::SeenSides(
    const ScreenScene& scene,
    const ScreenEdges& edges,
    const SweepSegments& segments,
    Upward upward)
    : scene_(scene)
    , edges_(edges)
    , segments_(segments)
    , is_left_above_(upward == Upward::with_y) {
    for (std::uint32_t i = 0; i < segments.segments.size(); ++i)
        if (segments.segments[i].begin.x == segments.segments[i].end.x)
            vertical_.push_back(i);
    std::sort(vertical_.begin(), vertical_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return segments.segments[a].begin < segments.segments[b].begin;
    });
}

/// Of the segment, at an x at which it has an end, or at which it and the other one cross.
RationalPoint
SeenSides::point(std::uint32_t segment, const SweepPoint& at, std::uint32_t crossed) const {
    const auto& [begin, end] = segments_.segments[segment];
    if (!at.is_crossing()) {
        const auto x = static_cast<std::int64_t>(at.x);
        return point_at(begin, end, {x - begin.x, std::int64_t{end.x} - begin.x});
    }
    const auto& other = segments_.segments[crossed];
    return point_at(begin, end, crossing_place(begin, end, other.begin, other.end));
}

bool SeenSides::does_go_on(const Slab& before, const Slab& after) const {
    const SweepPoint& at = after.from;
    if (!is_same_place(before.to, at) || at.is_crossing())
        return is_same_place(before.to, at);
    // Where a corner of what lies before it touches the roof, pieces end.
    const RationalPoint roof = point(after.roof, at, no_segment);
    return roof != point(before.floor, at, no_segment)
        && roof != point(after.floor, at, no_segment);
}

void SeenSides::add(
    std::uint32_t triangle, const Profile& roof, const Profile& floor, ProfileMerge& merge) {
    std::vector<Slab> slabs;
    merge.compare(
        roof, floor, [&](const ProfilePart& part, std::uint32_t above, std::uint32_t below, int) {
            if (below == ProfileMerge::absent)
                return;
            slabs.push_back({part.from, part.to, above, below, false});
            const std::size_t count = slabs.size();
            slabs.back().goes_on = count > 1 && does_go_on(slabs[count - 2], slabs.back());
        });
    add_roofs(triangle, slabs);
    add_floors(triangle, slabs);
    add_verticals(triangle, slabs);
}

void SeenSides::add_roofs(std::uint32_t triangle, std::span<const Slab> slabs) {
    for (std::size_t first = 0, next = 0; first < slabs.size(); first = next) {
        const std::uint32_t roof = slabs[first].roof;
        for (next = first + 1;
             next < slabs.size() && slabs[next].roof == roof && slabs[next].goes_on;)
            ++next;
        // Its upper sides turn at corners alone; elsewhere the floor crosses them.
        sides_.push_back(
            {roof,
             !is_left_above_,
             point(roof, slabs[first].from, slabs[first].floor),
             point(roof, slabs[next - 1].to, slabs[next - 1].floor),
             triangle});
    }
}

void SeenSides::add_floors(std::uint32_t triangle, std::span<const Slab> slabs) {
    const auto goes_on = [&](std::size_t i) { return i < slabs.size() && slabs[i].goes_on; };
    for (std::size_t first = 0, next = 0; first < slabs.size(); first = next) {
        const std::uint32_t floor = slabs[first].floor;
        for (next = first + 1; goes_on(next) && slabs[next].floor == floor;)
            ++next;
        // One floor crosses the one beside it, or else the roof.
        const std::uint32_t before = goes_on(first) ? slabs[first - 1].floor : slabs[first].roof;
        const std::uint32_t after = goes_on(next) ? slabs[next].floor : slabs[next - 1].roof;
        sides_.push_back(
            {floor,
             is_left_above_,
             point(floor, slabs[first].from, before),
             point(floor, slabs[next - 1].to, after),
             triangle});
    }
}

/// Where what is seen begins or ends along a column: at corners only, since elsewhere nothing
/// jumps.
void SeenSides::add_verticals(std::uint32_t triangle, std::span<const Slab> slabs) {
    const auto floor_at = [&](const Slab& slab, const SweepPoint& at) {
        return point(slab.floor, at, no_segment);
    };
    const auto add_whole = [&](const Slab& slab, const SweepPoint& at, bool is_left) {
        if (!at.is_crossing())
            add_vertical(triangle, floor_at(slab, at), point(slab.roof, at, no_segment), is_left);
    };
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        const Slab& slab = slabs[i];
        if (!slab.goes_on) {
            add_whole(slab, slab.from, false);
            if (i > 0)
                add_whole(slabs[i - 1], slabs[i - 1].to, true);
        } else if (!slab.from.is_crossing() && slabs[i - 1].floor != slab.floor) {
            const RationalPoint left = floor_at(slabs[i - 1], slab.from);
            const RationalPoint right = floor_at(slab, slab.from);
            // It is seen on that side on which the floor is lower.
            add_vertical(triangle, left, right, is_before(left, right) == is_left_above_);
        }
    }
    if (!slabs.empty())
        add_whole(slabs.back(), slabs.back().to, true);
}

/// The triangle is to its left or right.
void SeenSides::add_vertical(
    std::uint32_t triangle, const RationalPoint& one, const RationalPoint& other, bool is_left) {
    const int way = order(one, other);
    if (way != 0)
        verticals_.push_back({triangle, is_left, way < 0 ? one : other, way < 0 ? other : one});
}

/// On all segments along it, cut where others end: what touches a column from its other side is not
/// known to what is seen here.
void SeenSides::add_sides_of(const Vertical& vertical, std::span<const RationalPoint> ends) {
    const auto& [triangle, is_left, from, to] = vertical;
    // The first that does not end below. Those of a column follow each other without overlap.
    auto next =
        std::partition_point(vertical_.begin(), vertical_.end(), [&](std::uint32_t segment) {
            return order(RationalPoint{segments_.segments[segment].end}, vertical.from) <= 0;
        });
    RationalPoint reached = from;
    for (; is_before(reached, to); ++next) {
        // What is covered ends in a column along sides of triangles.
        VERA_CHECK(next != vertical_.end());
        const auto& [begin, end] = segments_.segments[*next];
        VERA_CHECK(order(RationalPoint{begin}, reached) <= 0);
        const RationalPoint last = is_before(RationalPoint{end}, to) ? RationalPoint{end} : to;
        for (auto stop = std::upper_bound(ends.begin(), ends.end(), reached, is_before);
             stop != ends.end() && is_before(*stop, last);
             ++stop) {
            sides_.push_back({*next, is_left, reached, *stop, triangle});
            reached = *stop;
        }
        sides_.push_back({*next, is_left, reached, last, triangle});
        reached = last;
    }
}

/// Of two sides of one segment between neighbouring points; null where nothing is seen.
void SeenSides::add_part(
    const Side* left, const Side* right, const RationalPoint& from, const RationalPoint& to) {
    const auto triangle_of = [](const Side* side) {
        return side == nullptr ? no_triangle : side->triangle;
    };
    const auto source_of = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? no_source : scene_.triangles[triangle].source;
    };
    const std::uint32_t on_left = triangle_of(left);
    const std::uint32_t on_right = triangle_of(right);
    if (source_of(on_left) == source_of(on_right))
        return;
    // Of several edges in one place that what is seen beside it has, the first speaks for all.
    std::uint32_t edge = no_triangle;
    for (const auto& border : segments_.borders_of((left != nullptr ? left : right)->segment))
        if (border.triangle == on_left || border.triangle == on_right)
            edge = std::min(edge, border.edge);
    VERA_CHECK(edge != no_triangle);
    const auto& [begin, end] = edges_.edges[edge];
    if (scene_.vertices[begin].point < scene_.vertices[end].point)
        parts_.push_back({edge, from, to, on_left, on_right});
    else
        parts_.push_back({edge, to, from, on_right, on_left});
}

/// Of one segment, by where they begin.
void SeenSides::add_parts(std::span<const Side> sides) {
    std::vector<RationalPoint> ends;
    for (const Side& side : sides) {
        ends.push_back(side.from);
        ends.push_back(side.to);
    }
    std::sort(ends.begin(), ends.end(), is_before);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::array<const Side*, 2> here = {nullptr, nullptr};
    auto next = sides.begin();
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        for (const Side*& side : here)
            if (side != nullptr && side->to == ends[i])
                side = nullptr;
        for (; next != sides.end() && next->from == ends[i]; ++next)
            here[next->is_left ? 0 : 1] = &*next;
        if (here[0] != nullptr || here[1] != nullptr)
            add_part(here[0], here[1], ends[i], ends[i + 1]);
    }
}

VisiblePieces SeenSides::pieces() {
    std::vector<RationalPoint> ends;
    for (const Side& side : sides_)
        for (const RationalPoint* end : {&side.from, &side.to})
            if (end->x_numerator == 0)
                ends.push_back(*end);
    std::sort(ends.begin(), ends.end(), is_before);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (const Vertical& vertical : verticals_)
        add_sides_of(vertical, ends);
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
        return a.segment != b.segment ? a.segment < b.segment : is_before(a.from, b.from);
    });
    for (auto first = sides_.begin(); first != sides_.end();) {
        const auto last = std::find_if(
            first, sides_.end(), [&](const Side& side) { return side.segment != first->segment; });
        add_parts({first, last});
        first = last;
    }
    std::sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
        if (a.edge != b.edge)
            return a.edge < b.edge;
        return is_before(a.from, a.to) ? is_before(a.from, b.from) : is_before(b.from, a.from);
    });
    VisiblePieces result;
    for (const Part& part : parts_) {
        result.points.push_back(part.from);
        result.points.push_back(part.to);
    }
    std::sort(result.points.begin(), result.points.end(), is_before);
    result.points.erase(
        std::unique(result.points.begin(), result.points.end()), result.points.end());
    const auto number = [&](const RationalPoint& point) {
        return static_cast<std::uint32_t>(
            std::lower_bound(result.points.begin(), result.points.end(), point, is_before)
            - result.points.begin());
    };
    std::vector<std::uint32_t> meeting(result.points.size());
    for (const Part& part : parts_)
        for (const RationalPoint* end : {&part.from, &part.to})
            ++meeting[number(*end)];
    const Part* before = nullptr;
    for (const Part& part : parts_) {
        const std::uint32_t from = number(part.from);
        // Where nothing else ends, an edge goes on.
        const bool goes_on = before != nullptr && before->edge == part.edge
            && before->to == part.from && before->left == part.left && before->right == part.right
            && meeting[from] == 2;
        if (goes_on)
            result.pieces.back().to = number(part.to);
        else
            result.pieces.push_back(
                {from, number(part.to), edges_.edges[part.edge], part.left, part.right});
        before = &part;
    }
    return result;
}

} // namespace vera
