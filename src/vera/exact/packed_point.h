// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/check.h"
#include "vera/exact/screen_point.h"

#include <array>
#include <cstdint>

namespace vera {

/// A RationalPoint of the picture in 24 bytes in place of 32, for lists of millions of them. Equal
/// ones have equal words, as the point is in lowest terms.
class PackedPoint {
public:
    PackedPoint()
        : PackedPoint(RationalPoint{}) {}

    /// The point must lie in the picture, as all that point_at() returns do.
    PackedPoint(const RationalPoint& point) { // NOLINT: it is the same point
        // Then nothing is cut off here. A number below 0 has bits above all that there is room for.
        VERA_CHECK(
            (bits(point.whole.x) | bits(point.whole.y)) <= half_mask
            && (bits(point.x_numerator) | bits(point.y_numerator) | bits(point.denominator))
                <= most_number);
        const std::uint64_t whole = bits(point.whole.x) << half_bits | bits(point.whole.y);
        const auto word = [&](std::int64_t number, int third) {
            return bits(number) << third_bits | (whole >> (third * third_bits) & third_mask);
        };
        words_ = {
            word(point.x_numerator, 0), word(point.y_numerator, 1), word(point.denominator, 2)};
    }

    operator RationalPoint() const { // NOLINT: it is the same point
        const std::uint64_t whole = (words_[0] & third_mask)
            | (words_[1] & third_mask) << third_bits | (words_[2] & third_mask) << (2 * third_bits);
        const auto number = [&](std::size_t i) {
            return static_cast<std::int64_t>(words_[i] >> third_bits);
        };
        return {
            {static_cast<std::int32_t>(whole >> half_bits),
             static_cast<std::int32_t>(whole & half_mask)},
            number(0),
            number(1),
            number(2)};
    }

    double x() const { return RationalPoint(*this).x(); }

    double y() const { return RationalPoint(*this).y(); }

    friend bool operator==(const PackedPoint& a, const PackedPoint& b) {
        // Without a call of memcmp(), which takes longer than a look.
        return ((a.words_[0] ^ b.words_[0]) | (a.words_[1] ^ b.words_[1])
                | (a.words_[2] ^ b.words_[2]))
            == 0;
    }

    friend std::uint64_t hash_of(const PackedPoint& point) {
        std::uint64_t hash = 0;
        for (const std::uint64_t word : point.words_) {
            hash = (hash ^ word) * 0x9e3779b97f4a7c15U;
            hash ^= hash >> 32U;
        }
        return hash;
    }

private:
    static constexpr std::uint64_t bits(std::int64_t number) {
        return static_cast<std::uint64_t>(number);
    }

    // Both whole coordinates in 48 bits, of which each word has a third below one of the fraction's
    // numbers.
    static constexpr int half_bits = 24;
    static constexpr int third_bits = 16;
    static constexpr std::uint64_t half_mask = (std::uint64_t{1} << half_bits) - 1;
    static constexpr std::uint64_t third_mask = (std::uint64_t{1} << third_bits) - 1;
    static constexpr std::uint64_t most_number = ~std::uint64_t{0} >> third_bits;
    static_assert(screen_bits < half_bits, "screen_size itself is a coordinate");
    static_assert(2 * screen_bits + 1 < 64 - third_bits, "that of crossing_place() is the longest");

    std::array<std::uint64_t, 3> words_ = {};
};

} // namespace vera
