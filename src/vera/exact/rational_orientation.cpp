// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/rational_orientation.h"

namespace vera {

namespace {

/// The way from one point to another, times both denominators.
struct WideStep {
    Int128 x;
    Int128 y;
};

static_assert(5 * screen_bits + 6 < 127, "wide_step() must not overflow");

WideStep wide_step(const RationalPoint& from, const RationalPoint& to) {
    const ScreenStep whole = step(from.whole, to.whole);
    const Int128 denominators = Int128{from.denominator} * to.denominator;
    const auto component = [&](std::int64_t steps, std::int64_t numerator, std::int64_t minus) {
        return denominators * steps + Int128{numerator} * from.denominator
            - Int128{minus} * to.denominator;
    };
    return {
        component(whole.x, to.x_numerator, from.x_numerator),
        component(whole.y, to.y_numerator, from.y_numerator)};
}

} // namespace

int orientation(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
    // Positive factors, by which both ways are longer, leave the sign of their cross product.
    const WideStep to_b = wide_step(a, b);
    const WideStep to_c = wide_step(a, c);
    return sign_of_difference(to_b.x, to_c.y, to_b.y, to_c.x);
}

} // namespace vera
