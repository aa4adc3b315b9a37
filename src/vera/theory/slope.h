// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace vera {

/// By how much a line rises for each step along z, exactly.
struct Slope {
    std::int64_t rise = 0; ///< at most 2^31 in magnitude
    std::int64_t run = 1;  ///< likewise; positive

    /// A run of either sign, but not 0.
    static constexpr Slope of(std::int64_t rise, std::int64_t run) {
        return run > 0 ? Slope{rise, run} : Slope{-rise, -run};
    }

    /// Equal slopes need not have equal members.
    friend constexpr bool operator==(Slope a, Slope b) { return a.rise * b.run == b.rise * a.run; }

    friend constexpr std::strong_ordering operator<=>(Slope a, Slope b) {
        return a.rise * b.run <=> b.rise * a.run;
    }
};

/// How a ray's line looks from the side: x = (slope.rise z + height) / slope.run.
struct SideView {
    Slope slope;
    std::int64_t height = 0; ///< at most 2^62 in magnitude
};

} // namespace vera
