// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace vera {

/// 127 bits and a sign.
__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

constexpr int sign(Int128 value) {
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// The magnitude of a product of 128 and 128 bits.
struct UInt256 {
    UInt128 high = 0;
    UInt128 low = 0;

    friend constexpr bool operator==(const UInt256&, const UInt256&) = default;
    friend constexpr auto operator<=>(const UInt256&, const UInt256&) = default;
};

UInt256 product(UInt128 a, UInt128 b);

/// The sign of a b - c d, exactly. None of the numbers is -2^127.
int sign_of_difference(Int128 a, Int128 b, Int128 c, Int128 d);

} // namespace vera
