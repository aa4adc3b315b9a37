// SPDX-License-Identifier: Apache-2.0
// A pixel of a tile in a register of 16 bytes, which every processor of 64 bits has: its samples,
// and lanes that mean nothing. Vectors of the compiler, not Highway's, whose smallest x86 has
// SSSE3.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace vera::detail {

template <typename Pixel>
Pixel lesser(Pixel a, Pixel b) {
    return a < b ? a : b;
}

template <typename Pixel>
Pixel greater(Pixel a, Pixel b) {
    return a < b ? b : a;
}

/// What the median of left, above, and left + above - above_left leaves out of left + above.
template <typename Pixel>
Pixel left_out(Pixel left, Pixel above, Pixel above_left) {
    return lesser(greater(above_left, lesser(left, above)), greater(left, above));
}

/// Where nothing is lost: a lane is a sample, and sums are taken modulo what it holds.
template <typename Sample>
struct ExactPixels {
    using Lane = Sample;
    using Pixel [[gnu::vector_size(16)]] = Lane;
    static constexpr std::size_t lanes = 4; ///< that are read and written

    static Pixel load(const Lane* samples) {
        Word word = 0;
        std::memcpy(&word, samples, sizeof word);
        return std::bit_cast<Pixel>(Words{word});
    }

    /// Writes over what stands behind the pixel: that comes later, or lies behind the last.
    static void store(Pixel pixel, Sample* samples) {
        const Word word = std::bit_cast<Words>(pixel)[0];
        std::memcpy(samples, &word, sizeof word);
    }

    static Pixel load_difference(const Lane* from) { return load(from); }

    static Lane lane(int value) { return static_cast<Lane>(value); }

    static Pixel sum(Pixel neighbour, Pixel difference) { return neighbour + difference; }

    static Pixel next(Pixel left, Pixel above, Pixel above_left, Pixel difference) {
        // In this order four operations follow each other from one pixel to the next.
        return left + (above + difference) - left_out(left, above, above_left);
    }

private:
    using Word = std::conditional_t<sizeof(Sample) == 1, std::uint32_t, std::uint64_t>;
    using Words [[gnu::vector_size(16)]] = Word;
};

/// Where there is an error: lanes hold differences of samples, and sums are limited to samples.
template <typename Sample>
struct LimitedPixels {
    using Lane = std::conditional_t<sizeof(Sample) == 1, std::int16_t, std::int32_t>;
    using Pixel [[gnu::vector_size(16)]] = Lane;
    static constexpr std::size_t lanes = 16 / sizeof(Lane);

    static Pixel load(const Sample* samples) {
        Narrow narrow;
        std::memcpy(&narrow, samples, sizeof narrow);
        return __builtin_convertvector(narrow, Pixel);
    }

    static void store(Pixel pixel, Sample* samples) {
        const auto narrow = __builtin_convertvector(pixel, Narrow);
        std::memcpy(samples, &narrow, sizeof narrow);
    }

    static Pixel load_difference(const Lane* from) {
        Pixel difference;
        std::memcpy(&difference, from, sizeof difference);
        return difference;
    }

    /// More than a sample holds leads no farther.
    static Lane lane(int value) {
        return static_cast<Lane>(std::clamp<int>(value, -full_scale, full_scale));
    }

    static Pixel sum(Pixel neighbour, Pixel difference) {
        return lesser(greater(neighbour + difference, Pixel{}), Pixel{} + full_scale);
    }

    static Pixel next(Pixel left, Pixel above, Pixel above_left, Pixel difference) {
        return sum(left + above - left_out(left, above, above_left), difference);
    }

private:
    static constexpr Lane full_scale = Sample(-1);
    using Narrow [[gnu::vector_size(lanes * sizeof(Sample))]] = Sample;
};

} // namespace vera::detail
