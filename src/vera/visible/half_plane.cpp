// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/half_plane.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace vera {

namespace {

double beyond(const HalfPlane& half, DrawingPoint point) {
    return half.normal.x * point.x + half.normal.y * point.y - half.reach;
}

/// Where the way from one point to another, on different sides of the border, crosses it: the same
/// point in either direction.
DrawingPoint
crossing(DrawingPoint inside, double inside_by, DrawingPoint outside, double outside_by) {
    const double part = inside_by / (inside_by - outside_by);
    return {inside.x + part * (outside.x - inside.x), inside.y + part * (outside.y - inside.y)};
}

/// A part of a ring within a half plane, from where it comes in to where it leaves.
struct Passage {
    BorderRing points;
    bool is_joined = false;
};

/// Of points that are the same, the last one's side is what leads on.
void add_point(BorderRing& ring, const BorderPoint& point) {
    if (!ring.empty() && ring.back() == point)
        ring.pop_back();
    ring.push_back(point);
}

/// Adds what of the ring lies in the half plane: the passages, or the whole of it.
void add_parts(
    const BorderRing& ring,
    const HalfPlane& half,
    std::vector<BorderRing>& whole,
    std::vector<Passage>& passages) {
    const auto next = [&](std::size_t i) { return i + 1 == ring.size() ? 0 : i + 1; };
    const auto comes_in = [&](std::size_t i) {
        return beyond(half, ring[i]) > 0 && beyond(half, ring[next(i)]) <= 0;
    };
    std::size_t entry = 0;
    while (entry < ring.size() && !comes_in(entry))
        ++entry;
    if (entry == ring.size()) {
        if (!ring.empty() && beyond(half, ring.front()) <= 0)
            whole.push_back(ring);
        return;
    }
    for (std::size_t count = 0, i = entry; count < ring.size(); ++count, i = next(i)) {
        const BorderPoint& from = ring[i];
        const BorderPoint& to = ring[next(i)];
        const double from_by = beyond(half, from);
        const double to_by = beyond(half, to);
        if (from_by > 0 && to_by <= 0) {
            passages.emplace_back();
            add_point(passages.back().points, {crossing(to, to_by, from, from_by), from.curve});
        }
        if (to_by <= 0)
            add_point(passages.back().points, to);
        else if (from_by <= 0)
            add_point(passages.back().points, crossing(from, from_by, to, to_by));
    }
}

/// The numbers of the passages in the order of a point of each along the border.
template <typename PointOf>
std::vector<std::size_t>
sorted_along(const HalfPlane& half, const std::vector<Passage>& passages, const PointOf& point_of) {
    std::vector<std::size_t> order(passages.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto way = [&](std::size_t i) {
        const DrawingPoint point = point_of(passages[i].points);
        return half.normal.x * point.y - half.normal.y * point.x;
    };
    std::ranges::stable_sort(order, {}, way);
    return order;
}

void cut_line(const PointChain& line, const HalfPlane& half, std::vector<PointChain>& left) {
    PointChain part;
    const auto end_part = [&] {
        if (part.size() > 1)
            left.push_back(std::move(part));
        part.clear();
    };
    for (std::size_t i = 0; i < line.size(); ++i) {
        const double by = beyond(half, line[i]);
        if (by <= 0)
            part.push_back(line[i]);
        if (i + 1 == line.size())
            break;
        const double next_by = beyond(half, line[i + 1]);
        if (by < 0 && next_by > 0)
            part.push_back(crossing(line[i], by, line[i + 1], next_by));
        if (next_by > 0)
            end_part();
        if (by > 0 && next_by < 0)
            part.push_back(crossing(line[i + 1], next_by, line[i], by));
    }
    end_part();
}

} // namespace

std::vector<BorderRing> cut_rings(const std::vector<BorderRing>& rings, const HalfPlane& half) {
    std::vector<BorderRing> left;
    std::vector<Passage> passages;
    for (const BorderRing& ring : rings)
        add_parts(ring, half, left, passages);

    // The border passes through the areas in intervals, each from where a ring comes in to where
    // one leaves, or the other way, all alike: the first of the one kind belong to the first of the
    // other.
    const auto entries = sorted_along(half, passages, [](auto& points) { return points.front(); });
    const auto exits = sorted_along(half, passages, [](auto& points) { return points.back(); });
    std::vector<std::size_t> following(passages.size());
    for (std::size_t i = 0; i < passages.size(); ++i)
        following[exits[i]] = entries[i];
    for (std::size_t first = 0; first < passages.size(); ++first) {
        BorderRing ring;
        for (std::size_t i = first; !passages[i].is_joined; i = following[i]) {
            passages[i].is_joined = true;
            for (const BorderPoint& point : passages[i].points)
                add_point(ring, point);
        }
        while (ring.size() > 1 && ring.back() == ring.front())
            ring.pop_back();
        if (ring.size() >= 3)
            left.push_back(std::move(ring));
    }
    return left;
}

std::vector<PointChain> cut_lines(const std::vector<PointChain>& lines, const HalfPlane& half) {
    std::vector<PointChain> left;
    for (const PointChain& line : lines)
        cut_line(line, half, left);
    return left;
}

} // namespace vera
