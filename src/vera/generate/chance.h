// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/random.h"

#include <cstddef>
#include <cstdint>

namespace vera {

/// Random numbers by a counter: the n-th one of a thing depends on the seed, the thing and n alone.
class Chance {
public:
    Chance(std::uint64_t seed, std::uint64_t thing)
        : seed_(seed)
        , thing_(thing) {}

    /// From low up to high.
    double between(double low, double high) {
        constexpr double two_to_53 = 9007199254740992.0;
        const std::uint64_t bits = random(seed_, thing_, count_++) >> 11U;
        return low + (high - low) * (static_cast<double>(bits) / two_to_53);
    }

    /// From 0 to below count.
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(between(0, static_cast<double>(count)));
    }

private:
    std::uint64_t seed_;
    std::uint64_t thing_;
    std::uint64_t count_ = 0;
};

} // namespace vera
