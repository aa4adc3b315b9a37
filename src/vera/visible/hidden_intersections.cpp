// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/hidden_intersections.h"

#include "vera/exact/front_order.h"
#include "vera/visible/cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

namespace vera {

namespace {

struct Range {
    std::int64_t least = 0;
    std::int64_t most = 0;

    bool overlaps(const Range& other) const { return least <= other.most && other.least <= most; }
};

/// What a triangle lies in: across, down and in depth.
struct ScreenBox {
    Range x;
    Range y;
    Range nearness;

    bool overlaps(const ScreenBox& other) const {
        return x.overlaps(other.x) && y.overlaps(other.y) && nearness.overlaps(other.nearness);
    }
};

ScreenBox box_of(const std::array<ScreenVertex, 3>& corners) {
    const auto range = [&](const auto& value) {
        const auto [least, most] =
            std::minmax({value(corners[0]), value(corners[1]), value(corners[2])});
        return Range{least, most};
    };
    return {
        range([](const ScreenVertex& v) { return std::int64_t{v.point.x}; }),
        range([](const ScreenVertex& v) { return std::int64_t{v.point.y}; }),
        range([](const ScreenVertex& v) { return v.nearness; })};
}

/// Every triangle in the cells that it touches, hidden there or not.
Cells cells_of_all(const ScreenScene& scene) {
    Cells cells;
    while (cells.shift > 0
           && static_cast<double>(cells.per_side) * cells.per_side
               < static_cast<double>(scene.triangles.size())) {
        --cells.shift;
        cells.per_side *= 2;
    }
    cells.starts.assign(
        static_cast<std::size_t>(cells.per_side) * static_cast<std::size_t>(cells.per_side) + 1, 0);
    const auto for_each = [&](const auto& visit) {
        for (std::uint32_t i = 0; i < scene.triangles.size(); ++i)
            if (!scene.triangles[i].is_shadow())
                for_each_cell_of(
                    cells, corners_of(scene, scene.triangles[i]), [&](std::size_t cell) {
                        visit(i, cell);
                    });
    };
    for_each([&](std::uint32_t, std::size_t cell) { ++cells.starts[cell + 1]; });
    for (std::size_t i = 1; i < cells.starts.size(); ++i)
        cells.starts[i] += cells.starts[i - 1];
    cells.triangles.resize(cells.starts.back());
    std::vector<std::uint32_t> next(cells.starts.begin(), cells.starts.end() - 1);
    for_each([&](std::uint32_t i, std::size_t cell) { cells.triangles[next[cell]++] = i; });
    return cells;
}

/// An interval of a segment, and on which of its sides something covers it.
struct Cover {
    SegmentPlace from;
    SegmentPlace to;
    bool left = false;
    bool right = false;
};

/// Of the segment from begin to end what lies in the triangle; nothing where it only touches it.
std::optional<Cover>
cover_by(const std::array<ScreenVertex, 3>& corners, ScreenPoint begin, ScreenPoint end) {
    Cover cover = {{0, 1}, {1, 1}, true, true};
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenPoint p = corners[i].point;
        const ScreenPoint q = corners[(i + 1) % 3].point;
        const std::int64_t at_begin = orientation(p, q, begin);
        const std::int64_t at_end = orientation(p, q, end);
        if (at_begin == 0 && at_end == 0) {
            // Along a side, which has the triangle on its left.
            const ScreenStep side = step(p, q);
            const ScreenStep way = step(begin, end);
            const bool is_alike = side.x * way.x + side.y * way.y > 0;
            (is_alike ? cover.right : cover.left) = false;
            continue;
        }
        if (at_begin <= 0 && at_end <= 0)
            return std::nullopt;
        if (at_begin >= 0 && at_end >= 0)
            continue;
        const SegmentPlace at = crossing_place(begin, end, p, q);
        if (at_begin < 0 && order(cover.from, at) < 0)
            cover.from = at;
        if (at_end < 0 && order(at, cover.to) < 0)
            cover.to = at;
    }
    return order(cover.from, cover.to) < 0 ? std::optional(cover) : std::nullopt;
}

/// Where the intervals that cover that side are, as few as can be and in order.
std::vector<Cover> united(std::vector<Cover> covers, bool Cover::*side) {
    std::erase_if(covers, [&](const Cover& cover) { return !(cover.*side); });
    std::sort(covers.begin(), covers.end(), [](const Cover& a, const Cover& b) {
        return order(a.from, b.from) < 0;
    });
    std::vector<Cover> result;
    for (const Cover& next : covers)
        if (result.empty() || order(result.back().to, next.from) < 0)
            result.push_back(next);
        else if (order(result.back().to, next.to) < 0)
            result.back().to = next.to;
    return result;
}

ScreenPoint on_grid(NearnessPlace place) {
    return {
        static_cast<std::int32_t>(std::floor(place.x + 0.5)),
        static_cast<std::int32_t>(std::floor(place.y + 0.5))};
}

class IntersectionFinder {
public:
    IntersectionFinder(
        const ScreenScene& scene, const std::function<bool(std::uint32_t, std::uint32_t)>& is_asked)
        : scene_(scene)
        , is_asked_(is_asked)
        , cells_(cells_of_all(scene)) {
        for (const ScreenTriangle& triangle : scene.triangles) {
            slopes_.push_back(nearness_slope(plane_of(scene, triangle)));
            boxes_.push_back(box_of(corners_of(scene, triangle)));
        }
    }

    /// Those with triangles of larger numbers.
    void find_of(std::uint32_t triangle, std::vector<HiddenIntersection>& found) const {
        std::vector<std::uint32_t> others;
        for_each_cell_of(cells_, corners(triangle), [&](std::size_t cell) {
            for (const std::uint32_t other : cells_.triangles_of(cell))
                if (other > triangle && boxes_[triangle].overlaps(boxes_[other])
                    && scene_.triangles[triangle].source != scene_.triangles[other].source)
                    others.push_back(other);
        });
        std::sort(others.begin(), others.end());
        others.erase(std::unique(others.begin(), others.end()), others.end());
        for (const std::uint32_t other : others)
            if (is_asked_(triangle, other)
                && order_in_overlap(face(triangle), face(other)) == FrontOrder::penetrating)
                add_hidden_parts(triangle, other, found);
    }

private:
    std::array<ScreenVertex, 3> corners(std::uint32_t triangle) const {
        return corners_of(scene_, scene_.triangles[triangle]);
    }

    FrontFace face(std::uint32_t triangle) const { return {corners(triangle), slopes_[triangle]}; }

    /// Where two sides of the triangle pass through the other's plane; nothing where none do. The
    /// same places for all triangles at such a side.
    std::optional<std::array<NearnessPlace, 2>>
    crossings(std::uint32_t triangle, std::uint32_t other) const {
        const auto& vertices = scene_.triangles[triangle].vertices;
        std::array<NearnessPlace, 2> places;
        std::size_t count = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax({vertices[i], vertices[(i + 1) % 3]});
            const auto ahead = [&](const ScreenVertex& vertex) {
                const NearnessPlace place = {
                    static_cast<double>(vertex.point.x), static_cast<double>(vertex.point.y)};
                return static_cast<double>(vertex.nearness) - slopes_[other].at(place);
            };
            const ScreenVertex& a = scene_.vertices[low];
            const ScreenVertex& b = scene_.vertices[high];
            const double ahead_a = ahead(a);
            const double ahead_b = ahead(b);
            if ((ahead_a >= 0) == (ahead_b >= 0))
                continue;
            const double part = ahead_a / (ahead_a - ahead_b);
            places[count++] = {
                a.point.x + part * (b.point.x - a.point.x),
                a.point.y + part * (b.point.y - a.point.y)};
        }
        return count == 2 ? std::optional(places) : std::nullopt;
    }

    /// The segment that both triangles have in common.
    std::optional<std::pair<ScreenPoint, ScreenPoint>>
    common_segment(std::uint32_t one, std::uint32_t other) const {
        auto a = crossings(one, other);
        auto b = crossings(other, one);
        if (!a || !b)
            return std::nullopt;
        // Along the line through the two of them that are farther apart.
        const auto way = [](const std::array<NearnessPlace, 2>& places) {
            return NearnessPlace{places[1].x - places[0].x, places[1].y - places[0].y};
        };
        const auto size = [](NearnessPlace step) { return std::abs(step.x) + std::abs(step.y); };
        const NearnessPlace along = size(way(*a)) >= size(way(*b)) ? way(*a) : way(*b);
        const auto at = [&](const NearnessPlace& place) {
            return along.x * place.x + along.y * place.y;
        };
        for (auto* places : {&*a, &*b})
            if (at((*places)[1]) < at((*places)[0]))
                std::swap((*places)[0], (*places)[1]);
        const NearnessPlace from = at((*a)[0]) >= at((*b)[0]) ? (*a)[0] : (*b)[0];
        const NearnessPlace to = at((*a)[1]) <= at((*b)[1]) ? (*a)[1] : (*b)[1];
        const std::pair<ScreenPoint, ScreenPoint> ends = {on_grid(from), on_grid(to)};
        if (at(from) >= at(to) || ends.first == ends.second)
            return std::nullopt;
        return ends;
    }

    /// Leaves of a cover that is in front of the triangle at one of its ends alone what is.
    bool leave_what_is_in_front(
        std::uint32_t cover_triangle,
        std::uint32_t triangle,
        ScreenPoint begin,
        ScreenPoint end,
        Cover& cover) const {
        const NearnessSlope& in_front = slopes_[cover_triangle];
        const NearnessSlope& behind = slopes_[triangle];
        const double sure = sure_margin(in_front) + sure_margin(behind);
        const auto ahead = [&](SegmentPlace place) {
            const NearnessPlace at = {
                begin.x + place.value() * (end.x - begin.x),
                begin.y + place.value() * (end.y - begin.y)};
            return in_front.at(at) - behind.at(at);
        };
        const double ahead_from = ahead(cover.from);
        const double ahead_to = ahead(cover.to);
        if (ahead_from <= sure && ahead_to <= sure)
            return false;
        if ((ahead_from < 0) == (ahead_to < 0))
            return true;
        // Where it passes through the segment, about.
        constexpr std::int64_t parts = std::int64_t{1} << screen_bits;
        const double from = cover.from.value();
        const double part = ahead_from / (ahead_from - ahead_to);
        const SegmentPlace at = {
            static_cast<std::int64_t>(
                std::floor((from + part * (cover.to.value() - from)) * parts + 0.5)),
            parts};
        SegmentPlace& hidden_end = ahead_from < 0 ? cover.from : cover.to;
        if (order(cover.from, at) < 0 && order(at, cover.to) < 0)
            hidden_end = at;
        return true;
    }

    std::vector<Cover>
    covers(std::uint32_t one, std::uint32_t other, ScreenPoint begin, ScreenPoint end) const {
        std::vector<std::uint32_t> near;
        for_each_cell_along(cells_, begin, end, [&](std::size_t cell) {
            const auto here = cells_.triangles_of(cell);
            near.insert(near.end(), here.begin(), here.end());
            return true;
        });
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        std::vector<Cover> found;
        for (const std::uint32_t triangle : near) {
            if (triangle == one || triangle == other)
                continue;
            std::optional<Cover> cover = cover_by(corners(triangle), begin, end);
            if (cover && leave_what_is_in_front(triangle, one, begin, end, *cover)
                && leave_what_is_in_front(triangle, other, begin, end, *cover))
                found.push_back(*cover);
        }
        return found;
    }

    void add_hidden_parts(
        std::uint32_t one, std::uint32_t other, std::vector<HiddenIntersection>& found) const {
        const auto segment = common_segment(one, other);
        if (!segment)
            return;
        const auto [begin, end] = *segment;
        const std::vector<Cover> all = covers(one, other, begin, end);
        const std::vector<Cover> left = united(all, &Cover::left);
        const std::vector<Cover> right = united(all, &Cover::right);
        for (const Cover& a : left)
            for (const Cover& b : right) {
                const SegmentPlace from = order(a.from, b.from) < 0 ? b.from : a.from;
                const SegmentPlace to = order(a.to, b.to) < 0 ? a.to : b.to;
                if (order(from, to) < 0)
                    found.push_back(
                        {point_at(begin, end, from),
                         point_at(begin, end, to),
                         begin,
                         end,
                         {one, other}});
            }
    }

    const ScreenScene& scene_;
    const std::function<bool(std::uint32_t, std::uint32_t)>& is_asked_;
    Cells cells_;
    std::vector<NearnessSlope> slopes_;
    std::vector<ScreenBox> boxes_;
};

} // namespace

std::vector<HiddenIntersection> hidden_intersections(
    const ScreenScene& scene,
    const std::function<bool(std::uint32_t, std::uint32_t)>& is_asked,
    const CancelFlag* cancel) {
    const IntersectionFinder finder(scene, is_asked);
    constexpr std::size_t grain = 256;
    const std::size_t count = scene.triangles.size();
    std::vector<std::vector<HiddenIntersection>> found((count + grain - 1) / grain);
    parallel_ranges(found.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t range = first; range < last; ++range) {
            if (cancel != nullptr)
                cancel->throw_if_raised();
            for (std::size_t i = range * grain; i < std::min(count, (range + 1) * grain); ++i)
                if (!scene.triangles[i].is_shadow())
                    finder.find_of(static_cast<std::uint32_t>(i), found[range]);
        }
    });
    std::vector<HiddenIntersection> all;
    for (const std::vector<HiddenIntersection>& part : found)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace vera
