// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vera {

/// What a scene text may ask for before it is refused.
struct SceneLimits {
    /// Statements of geometry, and corners of polygons, of one scene or subscene: as many as Scene
    /// can number.
    std::uint64_t items = 0xffff'fffe;
    /// Pairs of a polygon's sides that are looked at for a crossing: a second's work.
    std::uint64_t side_pairs = 100'000'000;
    /// Whether what MK asks for is made: fuzzers only read it.
    bool generators = true;
};

} // namespace vera
