// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/wide_integer.h"

namespace vera {

namespace {

constexpr UInt128 low_half(UInt128 value) {
    return value & 0xffffffffffffffffULL;
}

constexpr UInt128 magnitude(Int128 value) {
    return value < 0 ? -static_cast<UInt128>(value) : static_cast<UInt128>(value);
}

} // namespace

UInt256 product(UInt128 a, UInt128 b) {
    const UInt128 lowest = low_half(a) * low_half(b);
    const UInt128 one = low_half(a) * (b >> 64U);
    const UInt128 other = (a >> 64U) * low_half(b);
    const UInt128 middle = (lowest >> 64U) + low_half(one) + low_half(other);
    return {
        (a >> 64U) * (b >> 64U) + (one >> 64U) + (other >> 64U) + (middle >> 64U),
        (middle << 64U) | low_half(lowest)};
}

int sign_of_difference(Int128 a, Int128 b, Int128 c, Int128 d) {
    const int first = sign(a) * sign(b);
    const int second = sign(c) * sign(d);
    if (first != second)
        return first > second ? 1 : -1;
    const UInt256 of_first = product(magnitude(a), magnitude(b));
    const UInt256 of_second = product(magnitude(c), magnitude(d));
    if (of_first == of_second)
        return 0;
    return (of_first > of_second) == (first > 0) ? 1 : -1;
}

} // namespace vera
