// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/wide_integer.h"

#include <array>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// Digits of 16 bits, the lowest first: as slow as can be, and plain.
using Digits = std::array<std::uint32_t, 16>;

Digits product_by_hand(UInt128 a, UInt128 b) {
    Digits digits = {};
    for (std::size_t i = 0; i < 8; ++i) {
        std::uint32_t carry = 0;
        for (std::size_t j = 0; j < 8; ++j) {
            const auto of_a = static_cast<std::uint32_t>(a >> (16 * i) & 0xffffU);
            const auto of_b = static_cast<std::uint32_t>(b >> (16 * j) & 0xffffU);
            const std::uint64_t sum = std::uint64_t{of_a} * of_b + digits[i + j] + carry;
            digits[i + j] = static_cast<std::uint32_t>(sum & 0xffffU);
            carry = static_cast<std::uint32_t>(sum >> 16U);
        }
        digits[i + 8] = carry;
    }
    return digits;
}

/// Numbers of all lengths, many of them with long runs of ones or zeros.
UInt128 number_of_any_length(std::mt19937_64& random) {
    UInt128 value = 0;
    for (int i = 0; i < 4; ++i) {
        const std::uint64_t part =
            std::array<std::uint64_t, 5>{0, 1, 0xffffffff, 0x80000000, random()}[random() % 5];
        value = value << 32U | (part & 0xffffffffU);
    }
    return value >> (random() % 128);
}

TEST(WideInteger, ProductsAreThoseByHand) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 100'000; ++i) {
        const UInt128 a = number_of_any_length(random);
        const UInt128 b = number_of_any_length(random);
        const UInt256 found = product(a, b);
        const Digits expected = product_by_hand(a, b);
        for (std::size_t digit = 0; digit < 16; ++digit) {
            const UInt128 half = digit < 8 ? found.low : found.high;
            ASSERT_EQ(
                static_cast<std::uint32_t>(half >> (16 * (digit % 8)) & 0xffffU), expected[digit]);
        }
    }
}

TEST(WideInteger, DifferencesOfProductsHaveTheSignOfSmallOnes) {
    for (int a = -3; a <= 3; ++a)
        for (int b = -3; b <= 3; ++b)
            for (int c = -3; c <= 3; ++c)
                for (int d = -3; d <= 3; ++d) {
                    EXPECT_EQ(sign_of_difference(a, b, c, d), sign(a * b - c * d));
                    // (2^100 + a) (2^100 + b) - (2^100 + c) (2^100 + d)
                    const Int128 large = Int128{1} << 100U;
                    const Int128 by_hand = (Int128{a} + b - c - d) * (Int128{1} << 64U)
                        + (a * b > c * d       ? 1
                               : a * b < c * d ? -1
                                               : 0);
                    EXPECT_EQ(
                        sign_of_difference(large + a, large + b, large + c, large + d),
                        sign(by_hand));
                    EXPECT_EQ(
                        sign_of_difference(-(large + a), large + b, -(large + c), large + d),
                        -sign(by_hand));
                }
}

} // namespace
} // namespace vera
