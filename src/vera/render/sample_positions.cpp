// SPDX-License-Identifier: Apache-2.0
#include "vera/render/sample_positions.h"

#include "vera/base/random.h"

namespace vera {

namespace {

constexpr double to_unit = 0x1p-32;

constexpr std::uint32_t reversed(std::uint32_t bits) {
    bits = (bits << 16) | (bits >> 16);
    bits = ((bits & 0x00ff00ffU) << 8) | ((bits >> 8) & 0x00ff00ffU);
    bits = ((bits & 0x0f0f0f0fU) << 4) | ((bits >> 4) & 0x0f0f0f0fU);
    bits = ((bits & 0x33333333U) << 2) | ((bits >> 2) & 0x33333333U);
    return ((bits & 0x55555555U) << 1) | ((bits >> 1) & 0x55555555U);
}

/// The second coordinate of Sobol's sequence: digits by Pascal's triangle modulo 2.
constexpr std::uint32_t second_sobol(std::uint32_t i) {
    std::uint32_t bits = 0;
    for (std::uint32_t column = 0x80000000U; i != 0; i >>= 1, column ^= column >> 1)
        if ((i & 1) != 0)
            bits ^= column;
    return bits;
}

/// Owen's scrambling, each binary digit flipped at random by the digits above it, which leaves a
/// net a net. In reversed bits that is a function in which a bit depends on lower ones alone, as in
/// sums and in products with even numbers (Laine and Karras 2011).
constexpr std::uint32_t owen_scrambled(std::uint32_t bits, std::uint64_t seed) {
    const auto offset = static_cast<std::uint32_t>(seed & 0xffffffffU);
    const auto factor = static_cast<std::uint32_t>(seed >> 32) | 1U;
    std::uint32_t low_first = reversed(bits) + offset;
    low_first ^= low_first * 0x9e3779b8U;
    low_first *= factor;
    low_first ^= low_first * 0x2c1b3c6cU;
    low_first ^= low_first * 0x297a2d3aU;
    return reversed(low_first);
}

} // namespace

SampleNet::SampleNet(std::uint64_t pixel)
    : across_seed_(random(0, pixel, 0))
    , down_seed_(random(0, pixel, 1)) {}

SamplePosition SampleNet::operator[](std::uint32_t i) const {
    return {
        to_unit * owen_scrambled(reversed(i), across_seed_),
        to_unit * owen_scrambled(second_sobol(i), down_seed_)};
}

SamplePosition probe_position(std::size_t x, std::size_t y) {
    // Steps by the fractions of the square roots of 2, 3, 5 and 7: neither they nor their sums and
    // differences are near a simple fraction.
    const auto i = static_cast<std::uint32_t>(x);
    const auto j = static_cast<std::uint32_t>(y);
    const std::uint32_t across = i * 0x6a09e667U + j * 0xbb67ae85U;
    const std::uint32_t down = i * 0x3c6ef372U + j * 0xa54ff53aU;
    return {to_unit * across, to_unit * down};
}

} // namespace vera
