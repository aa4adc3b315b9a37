// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/screen_point.h"

#include <cstdlib>
#include <numeric>

namespace vera {

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
    const Int128 x = Int128{place.numerator} * whole.x + Int128{a.x} * place.denominator;
    const Int128 y = Int128{place.numerator} * whole.y + Int128{a.y} * place.denominator;
    RationalPoint result;
    result.whole = {
        static_cast<std::int32_t>(x / place.denominator),
        static_cast<std::int32_t>(y / place.denominator)};
    result.x_numerator = static_cast<std::int64_t>(x % place.denominator);
    result.y_numerator = static_cast<std::int64_t>(y % place.denominator);
    const std::int64_t common =
        std::gcd(std::gcd(result.x_numerator, result.y_numerator), place.denominator);
    result.x_numerator /= common;
    result.y_numerator /= common;
    result.denominator = place.denominator / common;
    return result;
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
