// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace vera {

/// A ray that a MeshIndex or a SphereIndex is asked about, in the coordinates of what the index is
/// of: the points origin + t direction for t_min <= t <= t_max. The direction has any length. A ray
/// with a number that is none, an infinite origin or direction, or no direction meets nothing.
struct IndexRay {
    std::array<float, 3> origin = {};
    float t_min = 0;
    std::array<float, 3> direction = {};
    float t_max = std::numeric_limits<float>::infinity();
};

/// How much work is put into an index.
enum class IndexQuality : std::uint8_t {
    usual,
    high ///< parts are moved to where they cost rays the least: slower to build, faster to ask
};

} // namespace vera
