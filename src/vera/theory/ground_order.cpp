// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/ground_order.h"

#include "vera/base/check.h"
#include "vera/base/diagnostic.h"
#include "vera/base/long_loop.h"
#include "vera/visible/triangle_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace vera {

namespace {

/// A triangle's corners, round to the left.
using Corners = std::array<ScreenStep, 3>;

ScreenStep between(ScreenStep from, ScreenStep to) {
    return {to.x - from.x, to.y - from.y};
}

static_assert(screen_bits + depth_bits + 5 < 63, "products of doubled ground steps must fit");

/// Whether a side of one has the other on its right: then they have no area in common.
bool is_apart_by_a_side(const Corners& one, const Corners& other) {
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenStep side = between(one[i], one[(i + 1) % 3]);
        const bool is_apart = std::all_of(other.begin(), other.end(), [&](ScreenStep corner) {
            return cross(side, between(one[i], corner)) <= 0;
        });
        if (is_apart)
            return true;
    }
    return false;
}

/// Exact, as two convex areas are apart if and only if a side of one of them parts them.
bool are_apart(const Corners& one, const Corners& other) {
    return is_apart_by_a_side(one, other) || is_apart_by_a_side(other, one);
}

Corners in_picture(const ScreenScene& scene, std::uint32_t triangle) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenPoint point = scene.vertices[scene.triangles[triangle].vertices[i]].point;
        corners[i] = {point.x, point.y};
    }
    return corners;
}

/// Nothing where it has no area there. The corner farthest to the left is the first.
std::optional<Corners> on_ground(const ScreenScene& scene, std::uint32_t triangle) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenVertex& vertex = scene.vertices[scene.triangles[triangle].vertices[i]];
        corners[i] = {vertex.point.x, vertex.nearness};
    }
    const std::int64_t area =
        cross(between(corners[0], corners[1]), between(corners[0], corners[2]));
    if (area == 0)
        return std::nullopt;
    if (area < 0)
        std::swap(corners[1], corners[2]);
    const auto first = std::min_element(
        corners.begin(), corners.end(), [](ScreenStep a, ScreenStep b) { return a.x < b.x; });
    std::rotate(corners.begin(), first, corners.end());
    return corners;
}

std::string named(const ScreenScene& scene, std::uint32_t triangle) {
    return "triangle " + std::to_string(triangle) + " (face "
        + std::to_string(scene.triangles[triangle].source) + ")";
}

/// Which of two triangles that are apart on the ground is nearer, just right of where the later one
/// begins. That is then so wherever both are.
class NearerOnGround {
public:
    NearerOnGround(const std::vector<Corners>& ground, std::uint64_t& steps)
        : ground_(&ground)
        , steps_(&steps) {}

    bool operator()(std::uint32_t a, std::uint32_t b) const {
        if (a == b)
            return false;
        ++*steps_;
        const Corners& one = (*ground_)[a];
        const Corners& other = (*ground_)[b];
        const bool is_first_later = one[0].x >= other[0].x;
        const int above = is_first_later ? begins_above(one, other) : -begins_above(other, one);
        // Those that are not apart are found out when they have become neighbours.
        return above != 0 ? above > 0 : a < b;
    }

private:
    /// Where a triangle begins, as seen from another that is there: 1 at the nearer side of it, -1
    /// at the farther, 0 within.
    static int begins_above(const Corners& later, const Corners& there) {
        // In doubled coordinates, the middle of what is farthest to the left, and a way inwards.
        const auto& [first, second, third] = later;
        ScreenStep begin = {2 * first.x, 2 * first.y};
        ScreenStep inward = {second.x + third.x - begin.x, second.y + third.y - begin.y};
        for (const auto& [same, opposite] : {std::pair(second, third), std::pair(third, second)})
            if (same.x == first.x) {
                begin = {2 * first.x, first.y + same.y};
                inward = {2 * opposite.x - begin.x, 2 * opposite.y - begin.y};
            }
        for (std::size_t i = 0; i < 3; ++i) {
            const ScreenStep from = there[i];
            const ScreenStep to = there[(i + 1) % 3];
            if (std::min(from.x, to.x) > first.x || std::max(from.x, to.x) <= first.x)
                continue;
            const ScreenStep side = between(from, to);
            std::int64_t turn = cross(side, between({2 * from.x, 2 * from.y}, begin));
            if (turn == 0)
                turn = cross(side, inward);
            // Sides that go to the left have the triangle below them.
            if (turn < 0)
                return side.x < 0 ? 1 : -1;
        }
        return 0;
    }

    const std::vector<Corners>* ground_;
    std::uint64_t* steps_;
};

class GroundSweep {
public:
    GroundSweep(const ScreenScene& scene, std::uint64_t& steps)
        : scene_(scene)
        , slopes_(slopes_of(scene))
        , steps_(steps)
        , there_(NearerOnGround(ground_, steps))
        , before_(scene.triangles.size()) {
        ground_.reserve(scene.triangles.size());
        for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
            const auto corners = on_ground(scene, i);
            if (!corners)
                refuse(
                    named(scene, i) + " stands upright, so that it has no place on the ground",
                    "leave walls out, or let them lean a bit");
            ground_.push_back(*corners);
        }
    }

    void sweep(const CancelFlag* cancel) {
        std::vector<std::uint32_t> starts(ground_.size());
        std::iota(starts.begin(), starts.end(), 0U);
        std::vector<std::uint32_t> ends = starts;
        std::sort(starts.begin(), starts.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(ground_[a][0].x, a) < std::pair(ground_[b][0].x, b);
        });
        std::sort(ends.begin(), ends.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(end_of(a), a) < std::pair(end_of(b), b);
        });
        std::vector<Status::iterator> places(ground_.size());
        auto end = ends.begin();
        const LongLoop loop(starts.size(), {}, cancel);
        for (std::size_t i = 0; i < starts.size(); ++i) {
            loop.turn(i);
            const std::uint32_t triangle = starts[i];
            for (; end_of(*end) <= ground_[triangle][0].x; ++end)
                remove(places[*end]);
            places[triangle] = insert(triangle);
        }
        for (; end != ends.end(); ++end)
            remove(places[*end]);
    }

    /// By what was met: whoever has nobody left before it comes next.
    std::vector<std::uint32_t> order() const {
        std::vector<std::uint32_t> left(before_.size());
        for (const auto& farther : before_)
            for (const std::uint32_t i : farther)
                ++left[i];
        std::vector<std::uint32_t> result;
        result.reserve(left.size());
        for (std::uint32_t i = 0; i < left.size(); ++i)
            if (left[i] == 0)
                result.push_back(i);
        for (std::size_t next = 0; next < result.size(); ++next)
            for (const std::uint32_t farther : before_[result[next]])
                if (--left[farther] == 0)
                    result.push_back(farther);
        VERA_CHECK(result.size() == before_.size());
        return result;
    }

private:
    using Status = std::set<std::uint32_t, NearerOnGround>;

    [[noreturn]] static void refuse(std::string problem, std::string remedy) {
        Diagnostic diagnostic;
        diagnostic.problem = std::move(problem);
        diagnostic.remedy = std::move(remedy);
        throw InputError({diagnostic});
    }

    std::int64_t end_of(std::uint32_t triangle) const {
        const Corners& corners = ground_[triangle];
        return std::max({corners[0].x, corners[1].x, corners[2].x});
    }

    Status::iterator insert(std::uint32_t triangle) {
        const auto place = there_.insert(triangle).first;
        if (place != there_.begin())
            meet(*std::prev(place), triangle);
        if (std::next(place) != there_.end())
            meet(triangle, *std::next(place));
        return place;
    }

    void remove(Status::iterator place) {
        const auto next = there_.erase(place);
        if (next != there_.begin() && next != there_.end())
            meet(*std::prev(next), *next);
    }

    /// Of neighbours, the nearer first.
    void meet(std::uint32_t nearer, std::uint32_t farther) {
        ++steps_;
        if (!are_apart(ground_[nearer], ground_[farther]))
            refuse(
                named(scene_, nearer) + " and " + named(scene_, farther)
                    + " lie one above the other, so that neither comes first",
                "take a scene with one height over each place, in an upright picture");
        // What is drawn in front must be nearer, too.
        if (!are_apart(in_picture(scene_, nearer), in_picture(scene_, farther))
            && triangle_order(scene_, slopes_, nearer, farther) != FrontOrder::first)
            refuse(
                named(scene_, nearer) + " and " + named(scene_, farther)
                    + " are so close that the grid of the picture does not tell which is nearer",
                "make the triangles larger, or number those first that are nearer");
        before_[nearer].push_back(farther);
    }

    const ScreenScene& scene_;
    std::vector<NearnessSlope> slopes_;
    std::uint64_t& steps_;
    std::vector<Corners> ground_;
    Status there_;                                   ///< those at the present x, the nearest first
    std::vector<std::vector<std::uint32_t>> before_; ///< of each, some that are farther
};

} // namespace

std::vector<std::uint32_t>
ground_order(const ScreenScene& scene, std::uint64_t* steps, const CancelFlag* cancel) {
    std::uint64_t uncounted = 0;
    GroundSweep sweep(scene, steps != nullptr ? *steps : uncounted);
    sweep.sweep(cancel);
    return sweep.order();
}

} // namespace vera
