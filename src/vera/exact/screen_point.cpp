// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/screen_point.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>

namespace vera {

namespace {

/// whole + rest / denominator, where the rest is not negative and less than that.
struct Quotient {
    std::int64_t whole = 0;
    std::int64_t rest = 0;
};

/// That part of a length; the place is on the segment.
Quotient part_of(std::int64_t length, SegmentPlace place) {
    // The estimate, no longer than the length, is off by three roundings of 2^-53: by less than
    // one.
    static_assert(screen_bits + 2 < 53);
    const double estimate = place.value() * static_cast<double>(length);
    auto whole = static_cast<std::int64_t>(estimate);
    // Of numbers that may be longer than 64 bits the difference is not, and so comes out right.
    const auto product = [](std::int64_t one, std::int64_t other) {
        return static_cast<std::uint64_t>(one) * static_cast<std::uint64_t>(other);
    };
    auto rest = static_cast<std::int64_t>(
        product(place.numerator, length) - product(whole, place.denominator));
    while (rest < 0) {
        --whole;
        rest += place.denominator;
    }
    while (rest >= place.denominator) {
        ++whole;
        rest -= place.denominator;
    }
    return {whole, rest};
}

/// By Euclid's algorithm with the least remainders, which takes a third fewer divisions. Processors
/// divide so fast that shifts and differences (Stein 1967) take longer.
std::uint64_t common_divisor(std::uint64_t a, std::uint64_t b) {
    while (b != 0) {
        const std::uint64_t rest = a % b;
        a = std::exchange(b, std::min(rest, b - rest));
    }
    return a;
}

/// Of three, the last of which is positive: most often 1 after two of them.
std::int64_t common_divisor(std::int64_t a, std::int64_t b, std::int64_t c) {
    const std::uint64_t of_two =
        common_divisor(static_cast<std::uint64_t>(a), static_cast<std::uint64_t>(b));
    if (of_two == 0)
        return c;
    if (of_two == 1)
        return 1;
    return static_cast<std::int64_t>(
        common_divisor(of_two, static_cast<std::uint64_t>(c) % of_two));
}

} // namespace

SegmentPlace crossing_place(ScreenPoint a, ScreenPoint b, ScreenPoint p, ScreenPoint q) {
    const ScreenStep other = step(p, q);
    const std::int64_t denominator = cross(step(a, b), other);
    const std::int64_t numerator = cross(step(a, p), other);
    return denominator > 0 ? SegmentPlace{numerator, denominator}
                           : SegmentPlace{-numerator, -denominator};
}

SegmentPlace place_on(ScreenPoint a, ScreenPoint b, ScreenPoint point) {
    const ScreenStep whole = step(a, b);
    const ScreenStep part = step(a, point);
    // Along the axis on which the segment is longer.
    const bool by_x = std::abs(whole.x) >= std::abs(whole.y);
    const std::int64_t denominator = by_x ? whole.x : whole.y;
    const std::int64_t numerator = by_x ? part.x : part.y;
    return denominator > 0 ? SegmentPlace{numerator, denominator}
                           : SegmentPlace{-numerator, -denominator};
}

RationalPoint point_at(ScreenPoint a, ScreenPoint b, SegmentPlace place) {
    const ScreenStep whole = step(a, b);
    const Quotient x = part_of(whole.x, place);
    const Quotient y = part_of(whole.y, place);
    const std::int64_t common = common_divisor(x.rest, y.rest, place.denominator);
    return {
        {static_cast<std::int32_t>(a.x + x.whole), static_cast<std::int32_t>(a.y + y.whole)},
        x.rest / common,
        y.rest / common,
        place.denominator / common};
}

int order(const RationalPoint& a, const RationalPoint& b) {
    const auto by = [](std::int32_t whole_a,
                       std::int64_t numerator_a,
                       std::int64_t denominator_a,
                       std::int32_t whole_b,
                       std::int64_t numerator_b,
                       std::int64_t denominator_b) {
        if (whole_a != whole_b)
            return whole_a < whole_b ? -1 : 1;
        return order(
            SegmentPlace{numerator_a, denominator_a}, SegmentPlace{numerator_b, denominator_b});
    };
    const int of_x =
        by(a.whole.x, a.x_numerator, a.denominator, b.whole.x, b.x_numerator, b.denominator);
    return of_x != 0
        ? of_x
        : by(a.whole.y, a.y_numerator, a.denominator, b.whole.y, b.y_numerator, b.denominator);
}

} // namespace vera
