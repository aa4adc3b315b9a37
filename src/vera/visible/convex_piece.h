// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/surface.h"

#include <cstdint>

namespace vera {

/// Of a piece of a curved primitive: whether it is part of the border of a convex body. Then no
/// line meets its outside twice, nor its inside: what is seen of either is one smooth whole.
enum class Convexity : std::uint8_t {
    none,     ///< it is not, or is plane, or not known to be
    outwards, ///< the body is behind its outside, as of spheres
    inwards   ///< the body is behind its inside, as of the wall of a bore
};

Convexity convexity(const PrimitivePath& path, std::uint32_t piece);

} // namespace vera
