// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vera {

/// A permutation of the 64-bit numbers that leaves no visible trace of its argument's order
/// (the finaliser of SplitMix64: Steele, Lea and Flood 2014).
constexpr std::uint64_t scrambled_bits(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebU;
    return bits ^ (bits >> 31);
}

/// Random bits that depend on the three numbers and on nothing else: the same for any number of
/// threads, in any order.
constexpr std::uint64_t random(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample) {
    constexpr std::uint64_t step = 0x9e3779b97f4a7c15U; // 2^64 by the golden ratio
    return scrambled_bits(
        scrambled_bits(scrambled_bits(seed + step) + pixel + step) + sample + step);
}

} // namespace vera
