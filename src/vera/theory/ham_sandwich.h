// SPDX-License-Identifier: Apache-2.0
// One line that halves two sets of points at once (VERA 3.3.1, figure 3b; Edelsbrunner and Welzl
// 1986 call the halves' halves conjugate). The sets lie on different sides of a line, as the halves
// of one set do. Turn a direction from along that line to against it, and look at the median of
// each set across the direction: the lower set's only rises against the upper set's, from below it
// to above. Where they meet, one line goes through both.
//
// The medians can only meet where the direction leads from a point of the lower set to one of the
// upper set. So the search keeps an open interval of directions, takes such a pair within it, and
// looks on which side of it the medians have met: a binary search among up to n^2/4 pairs, of which
// a random one leaves half on the average. That takes O(n log^2 n), in whole numbers, where the
// prune and search of Megiddo 1985 takes O(n); the bounds of the paper say nothing of logarithms.
#pragma once

#include "vera/theory/plane_strip.h"

#include <cstdint>
#include <span>

namespace vera {

/// The order of points across a direction, and against it where they are level: that across the
/// direction turned to the left by less than anything. Only equal points are equal in it.
struct TurnedOrder {
    PlaneDirection direction;

    bool operator()(PlanePoint a, PlanePoint b) const {
        const std::int64_t at_a = offset(direction, a);
        const std::int64_t at_b = offset(direction, b);
        return at_a != at_b ? at_a < at_b : dot(direction, a) > dot(direction, b);
    }
};

/// The rank, from 0, of the point that halves so many: no more than half of them come before it,
/// and no more than half after it.
constexpr std::size_t median_rank(std::size_t count) {
    return (count - 1) / 2;
}

/// The direction of a line that halves both sets: of neither lies more than half strictly on one
/// side of it. Neither set is empty, and none of the upper one comes before one of the lower one in
/// TurnedOrder{line}.
///
/// It lies strictly to the left of the given line, or is that line's own: where the medians meet
/// there already, or not until they have come round to it, as where all points are on one line.
/// Then the upper half of the lower set and the lower half of the upper set, in TurnedOrder{line},
/// lie on the line, one behind the other. So in each case a query's line that goes through no point
/// parts at most three of the four halves.
///
/// The seed decides which pairs are tried and so, where several lines halve both, which is found.
PlaneDirection conjugate_direction(
    std::span<const PlanePoint> lower,
    std::span<const PlanePoint> upper,
    PlaneDirection line,
    std::uint64_t seed = 0);

} // namespace vera
