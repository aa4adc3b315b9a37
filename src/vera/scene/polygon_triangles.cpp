// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/polygon_triangles.h"

#include "vera/scene/corner_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace vera {

Vec3 doubled_area_vector(std::span<const Vec3> corners) {
    Vec3 sum;
    for (std::size_t i = 2; i < corners.size(); ++i)
        sum = sum + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return sum;
}

namespace {

using detail::FlatPoint;
using detail::turn;

/// The corners relative to the first one, scaled by a power of two to a size of about 1, so that no
/// product of them underflows or overflows.
std::vector<Vec3> scaled_to_one(std::span<const Vec3> corners) {
    double largest = 0;
    for (const Vec3& corner : corners)
        largest = std::max(largest, max_component(abs(corner - corners[0])));
    int exponent = 0;
    if (largest > 0 && std::isfinite(largest))
        std::frexp(largest, &exponent);
    std::vector<Vec3> scaled;
    scaled.reserve(corners.size());
    for (const Vec3& corner : corners) {
        const Vec3 offset = corner - corners[0];
        scaled.push_back(
            {std::ldexp(offset.x, -exponent),
             std::ldexp(offset.y, -exponent),
             std::ldexp(offset.z, -exponent)});
    }
    return scaled;
}

/// The polygon as seen along the axis that its normal is closest to, from the normal's side, so
/// that it runs to the left round its interior.
std::vector<FlatPoint> flattened(const std::vector<Vec3>& corners, Vec3 normal) {
    const std::size_t axis = longest_axis(normal);
    std::size_t first = (axis + 1) % 3;
    std::size_t second = (axis + 2) % 3;
    if (normal[axis] < 0)
        std::swap(first, second);
    std::vector<FlatPoint> points;
    points.reserve(corners.size());
    for (const Vec3& corner : corners)
        points.push_back({corner[first], corner[second]});
    return points;
}

struct Convexity {
    bool convex = true;
    bool strictly = true; ///< no corner on a straight side
};

Convexity convexity(const std::vector<FlatPoint>& points) {
    Convexity result;
    const std::size_t n = points.size();
    // A closed line that only turns to the left goes round once if its direction changes between
    // rightwards and leftwards just twice.
    int changes = 0;
    int last_way = 0;
    int first_way = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const FlatPoint a = points[i];
        const FlatPoint b = points[(i + 1) % n];
        const double turned = turn(a, b, points[(i + 2) % n]);
        result.convex = result.convex && turned >= 0;
        result.strictly = result.strictly && turned > 0;
        const int way = b.x > a.x ? 1 : b.x < a.x ? -1 : 0;
        if (way == 0)
            continue;
        if (first_way == 0)
            first_way = way;
        changes += last_way != 0 && way != last_way ? 1 : 0;
        last_way = way;
    }
    changes += last_way != first_way ? 1 : 0;
    result.convex = result.convex && changes == 2;
    result.strictly = result.strictly && result.convex;
    return result;
}

/// Cuts corner after corner off a polygon that runs to the left round its interior, where the
/// triangle of the corner and its neighbours holds no other corner. Cutting one ear changes nothing
/// but its neighbours, so that each corner is looked at three times at most.
class EarClipper {
public:
    EarClipper(const std::vector<FlatPoint>& points, std::vector<CornerTriple>& triangles)
        : points_(points)
        , triangles_(triangles)
        , reflex_(points)
        , left_(points.size())
        , steps_left_(steps_per_corner * points.size()) {
        const auto n = static_cast<std::uint32_t>(points.size());
        previous_.resize(n);
        next_.resize(n);
        state_.assign(n, State::reflex);
        changed_.resize(n);
        std::iota(changed_.begin(), changed_.end(), 0U);
        for (std::uint32_t i = 0; i < n; ++i) {
            previous_[i] = i == 0 ? n - 1 : i - 1;
            next_[i] = i + 1 == n ? 0 : i + 1;
        }
        for (std::uint32_t i = 0; i < n; ++i)
            update(i);
        find_reflex();
    }

    /// Whether all of the polygon could be cut off in ears.
    bool clip() {
        // First come, first served: always going on where an ear was cut makes long thin triangles.
        std::vector<std::uint32_t> waiting(points_.size());
        std::iota(waiting.begin(), waiting.end(), 0U);
        std::uint32_t any = 0;
        for (std::size_t first = 0; left_ > 3; ++first) {
            if (first == waiting.size() && !drop_straight_corners(any, waiting))
                break;
            const std::uint32_t i = waiting[first];
            if (state_[i] != State::convex || !is_ear(i))
                continue;
            add(previous_[i], i, next_[i]);
            any = cut(i);
            waiting.push_back(any);
            waiting.push_back(next_[any]);
        }
        const bool clean = left_ == 3 && steps_left_ > 0
            && turn(points_[previous_[any]], points_[any], points_[next_[any]]) >= 0;
        for (std::uint32_t i = next_[any]; next_[i] != any; i = next_[i])
            add(any, i, next_[i]);
        return clean;
    }

private:
    static constexpr std::size_t steps_per_corner = 4096;

    enum class State : std::uint8_t {
        convex,
        reflex, ///< or straight
        lost, ///< was convex and is no longer: never, where no sides cross and nothing is straight
        gone
    };

    void update(std::uint32_t i) {
        const bool convex = turn(points_[previous_[i]], points_[i], points_[next_[i]]) > 0;
        reflex_count_ -= convex && state_[i] == State::reflex ? 1 : 0;
        state_[i] = convex ? State::convex : state_[i] == State::convex ? State::lost : state_[i];
    }

    /// Takes the corner out of the ring, and returns the one before it.
    std::uint32_t cut(std::uint32_t i) {
        const std::uint32_t before = previous_[i];
        const std::uint32_t after = next_[i];
        next_[before] = after;
        previous_[after] = before;
        reflex_count_ -= state_[i] == State::reflex ? 1 : 0;
        state_[i] = State::gone;
        --left_;
        changed_.push_back(before);
        changed_.push_back(after);
        update(before);
        update(after);
        // No corner becomes reflex; those that no longer are, are not to be looked at again.
        if (2 * reflex_count_ < reflex_.size())
            find_reflex();
        return before;
    }

    void find_reflex() {
        std::vector<std::uint32_t> reflex;
        for (std::uint32_t i = 0; i < state_.size(); ++i)
            if (state_[i] == State::reflex)
                reflex.push_back(i);
        reflex_count_ = reflex.size();
        reflex_.build(std::move(reflex));
    }

    bool is_ear(std::uint32_t i) {
        const std::array<FlatPoint, 3> ear = {points_[previous_[i]], points_[i], points_[next_[i]]};
        const auto is_in_the_way = [&](std::uint32_t other) {
            // Where a bridge joins a hole to the outline, two corners are the same point.
            const FlatPoint point = points_[other];
            return state_[other] == State::reflex && point != ear[0] && point != ear[1]
                && point != ear[2];
        };
        return !reflex_.is_any_in(ear, is_in_the_way, steps_left_);
    }

    /// When no ear is left: corners on straight lines and the tips of spikes hold no area. Goes
    /// round once from `any` on, past those alone that others were cut beside since it last did:
    /// else a way back and forth, each corner of which is a tip when the one behind it is gone,
    /// would take the square of its corners.
    bool drop_straight_corners(std::uint32_t& any, std::vector<std::uint32_t>& waiting) {
        if (steps_left_ == 0)
            return false;
        std::vector<std::uint32_t> asked = std::exchange(changed_, {});
        asked.push_back(previous_[any]); // has another neighbour at the end if `any` is cut
        std::erase_if(asked, [&](std::uint32_t i) { return state_[i] == State::gone; });
        const auto distance = [n = points_.size(), first = any](std::uint32_t i) {
            return i >= first ? i - first : i + n - first;
        };
        std::ranges::sort(asked, {}, distance);
        bool dropped = false;
        std::size_t past = 0; // nobody nearer is asked again
        for (std::size_t next = 0; next < asked.size(); ++next)
            for (std::uint32_t i = asked[next];
                 left_ > 3 && state_[i] != State::gone && distance(i) >= past;) {
                const std::uint32_t after = next_[i];
                past = distance(i) + 1;
                if (turn(points_[previous_[i]], points_[i], points_[after]) != 0)
                    break;
                any = cut(i);
                waiting.push_back(any);
                waiting.push_back(after);
                dropped = true;
                i = after;
            }
        return dropped;
    }

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (turn(points_[a], points_[b], points_[c]) != 0)
            triangles_.push_back({a, b, c});
    }

    const std::vector<FlatPoint>& points_;
    std::vector<CornerTriple>& triangles_;
    std::vector<std::uint32_t> previous_;
    std::vector<std::uint32_t> next_;
    detail::CornerTree reflex_; ///< the reflex corners, and some that were
    std::size_t reflex_count_ = 0;
    std::vector<State> state_;
    std::vector<std::uint32_t> changed_; ///< corners with another neighbour than when last asked
    std::size_t left_;
    std::size_t steps_left_;
};

/// Most faces of more than three corners have four: those need no memory.
bool split_quadrangle(std::span<const Vec3> p, std::vector<CornerTriple>& triangles) {
    const Vec3 first = p[2] - p[0];
    const Vec3 second = p[3] - p[1];
    const Vec3 normal = cross(first, second);
    // The triangles that each diagonal makes with the sides to its right and to its left.
    const auto faces_up = [&](Vec3 a, Vec3 b) { return dot(cross(a, b), normal) > 0; };
    if (!faces_up(p[1] - p[0], first) || !faces_up(first, p[3] - p[2])
        || !faces_up(p[2] - p[1], second) || !faces_up(second, p[0] - p[3]))
        return false;
    triangles.push_back({0, 1, 2});
    triangles.push_back({0, 2, 3});
    return true;
}

} // namespace

OutlineKind split_polygon(std::span<const Vec3> corners, std::vector<CornerTriple>& triangles) {
    triangles.clear();
    if (corners.size() == 4 && split_quadrangle(corners, triangles))
        return OutlineKind::convex;

    const std::vector<Vec3> scaled = scaled_to_one(corners);
    const Vec3 normal = doubled_area_vector(scaled);
    const std::vector<FlatPoint> points = flattened(scaled, normal);
    const Convexity convex = convexity(points);
    if (convex.strictly || !(max_component(abs(normal)) > 0)) {
        for (std::uint32_t i = 2; i < corners.size(); ++i)
            triangles.push_back({0, i - 1, i});
        return convex.strictly ? OutlineKind::convex : OutlineKind::tangled;
    }
    if (!EarClipper(points, triangles).clip())
        return OutlineKind::tangled;
    return convex.convex ? OutlineKind::convex : OutlineKind::simple;
}

} // namespace vera
