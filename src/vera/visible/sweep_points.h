// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/screen_point.h"
#include "vera/visible/sweep_counts.h"
#include "vera/visible/sweep_segments.h"

#include <cstdint>
#include <optional>
#include <span>

namespace vera {

constexpr std::uint32_t no_segment = ~std::uint32_t{0};

/// A point at which a sweep stops: an end of segments, or where two segments cross, of which x and
/// y are then off by less than 2^-29.
struct SweepPoint {
    double x = 0;
    double y = 0;
    std::uint32_t first = no_segment; ///< the segments that cross
    std::uint32_t second = no_segment;

    bool is_crossing() const { return first != no_segment; }
};

SweepPoint at_end(ScreenPoint point);

/// What a sweep asks about points and segments. Doubles answer where they are sure to be right,
/// which is almost always, else whole numbers.
class SweepPredicates {
public:
    /// Both must outlive this.
    SweepPredicates(std::span<const SweepSegments::Segment> segments, PlaneSweepCounts& counts)
        : segments_(segments)
        , counts_(counts) {}

    /// Orders by x, then by y.
    int order(const SweepPoint& a, const SweepPoint& b) const;

    /// Orders by x alone.
    int order_of_x(const SweepPoint& a, const SweepPoint& b) const;

    /// Positive where the point lies above the segment's line, to the left of its way.
    int side(std::uint32_t segment, const SweepPoint& point) const;

    /// Where two segments cross within both, of which the first is below the other to the left of
    /// that point.
    std::optional<SweepPoint> crossing(std::uint32_t below, std::uint32_t above) const;

    RationalPoint exact(const SweepPoint& point) const;

private:
    struct Fraction;
    Fraction fraction(const SweepPoint& point) const;
    SegmentPlace place(const SweepPoint& point) const;

    std::span<const SweepSegments::Segment> segments_;
    PlaneSweepCounts& counts_;
};

} // namespace vera
