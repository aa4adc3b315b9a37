// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/sweep_points.h"

#include <cmath>

namespace vera {

/// x / denominator and y / denominator.
struct SweepPredicates::Fraction {
    Int128 x;
    Int128 y;
    std::int64_t denominator;
};

namespace {

// Denominators of crossings have 2 screen_bits + 1 bits and so are exact as doubles, and so are
// numerators. Their quotient times a difference of coordinates, plus a coordinate, is rounded three
// times by 2^-31 or less.
constexpr double point_error = 0x1p-29;

static_assert(2 * screen_bits + 1 < 53, "numerators must be exact in doubles");
static_assert(5 * screen_bits + 4 < 127, "order() must not overflow");
static_assert(4 * screen_bits + 5 < 127, "side() must not overflow");

ScreenPoint end_at(const SweepPoint& point) {
    return {static_cast<std::int32_t>(point.x), static_cast<std::int32_t>(point.y)};
}

} // namespace

SweepPoint at_end(ScreenPoint point) {
    return {static_cast<double>(point.x), static_cast<double>(point.y)};
}

SegmentPlace SweepPredicates::place(const SweepPoint& point) const {
    const auto& [begin, end] = segments_[point.first];
    const auto& other = segments_[point.second];
    return crossing_place(begin, end, other.begin, other.end);
}

SweepPredicates::Fraction SweepPredicates::fraction(const SweepPoint& point) const {
    if (!point.is_crossing()) {
        const ScreenPoint end = end_at(point);
        return {end.x, end.y, 1};
    }
    const auto& [begin, end] = segments_[point.first];
    const auto [numerator, denominator] = place(point);
    const ScreenStep whole = step(begin, end);
    return {
        Int128{begin.x} * denominator + Int128{numerator} * whole.x,
        Int128{begin.y} * denominator + Int128{numerator} * whole.y,
        denominator};
}

RationalPoint SweepPredicates::exact(const SweepPoint& point) const {
    if (!point.is_crossing())
        return {end_at(point)};
    const auto& [begin, end] = segments_[point.first];
    return point_at(begin, end, place(point));
}

int SweepPredicates::order(const SweepPoint& a, const SweepPoint& b) const {
    ++counts_.comparisons;
    constexpr double sure = 2 * point_error;
    if (std::abs(a.x - b.x) > sure)
        return a.x < b.x ? -1 : 1;
    if (!a.is_crossing() && !b.is_crossing()) {
        if (a.x != b.x)
            return a.x < b.x ? -1 : 1;
        return a.y < b.y ? -1 : a.y > b.y ? 1 : 0;
    }
    if (a.first == b.first && a.second == b.second)
        return 0;
    ++counts_.exact_comparisons;
    const Fraction one = fraction(a);
    const Fraction other = fraction(b);
    const int by_x = sign(one.x * other.denominator - other.x * one.denominator);
    return by_x != 0 ? by_x : sign(one.y * other.denominator - other.y * one.denominator);
}

int SweepPredicates::order_of_x(const SweepPoint& a, const SweepPoint& b) const {
    ++counts_.comparisons;
    constexpr double sure = 2 * point_error;
    const bool are_same = a.is_crossing() && a.first == b.first && a.second == b.second;
    if (are_same || std::abs(a.x - b.x) > sure || (!a.is_crossing() && !b.is_crossing()))
        return are_same || a.x == b.x ? 0 : a.x < b.x ? -1 : 1;
    ++counts_.exact_comparisons;
    const Fraction one = fraction(a);
    const Fraction other = fraction(b);
    return sign(one.x * other.denominator - other.x * one.denominator);
}

int SweepPredicates::side(std::uint32_t segment, const SweepPoint& point) const {
    ++counts_.orientations;
    if (point.first == segment || point.second == segment)
        return 0;
    const auto& [begin, end] = segments_[segment];
    const ScreenStep whole = step(begin, end);
    const auto dx = static_cast<double>(whole.x);
    const auto dy = static_cast<double>(whole.y);
    const double turn = dx * (point.y - begin.y) - dy * (point.x - begin.x);
    // Coordinates are off by point_error, and each of the few operations rounds by no more.
    if (std::abs(turn) > (std::abs(dx) + std::abs(dy)) * (4 * point_error))
        return turn > 0 ? 1 : -1;
    ++counts_.exact_orientations;
    const Fraction at = fraction(point);
    return sign(
        whole.x * (at.y - Int128{begin.y} * at.denominator)
        - whole.y * (at.x - Int128{begin.x} * at.denominator));
}

std::optional<SweepPoint>
SweepPredicates::crossing(std::uint32_t below, std::uint32_t above) const {
    const auto& [begin, end] = segments_[below];
    const auto& other = segments_[above];
    const ScreenStep one_way = step(begin, end);
    const ScreenStep other_way = step(other.begin, other.end);
    const std::int64_t denominator = -cross(one_way, other_way);
    if (denominator <= 0)
        return std::nullopt; // they do not come closer to each other
    const ScreenStep between = step(begin, other.begin);
    const std::int64_t place = -cross(between, other_way);
    const std::int64_t other_place = -cross(between, one_way);
    // Ends are stopped at anyway.
    if (place <= 0 || place >= denominator || other_place <= 0 || other_place >= denominator)
        return std::nullopt;
    const double part = static_cast<double>(place) / static_cast<double>(denominator);
    return SweepPoint{
        begin.x + part * static_cast<double>(one_way.x),
        begin.y + part * static_cast<double>(one_way.y),
        below,
        above};
}

} // namespace vera
