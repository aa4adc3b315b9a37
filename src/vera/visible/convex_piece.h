// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/ray.h"
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

/// A part of a ray, and whether it is to go into a convex body there or to come out of it.
struct Passage {
    double from = 0;
    double to = 0;
    bool enters = true;
};

/// Where the ray, in the coordinates of the piece's geometry, meets the body of a convex piece:
/// from beyond that it goes from plane to plane. The plane that touches the body nearest to where
/// one is does not cut it, so that one never comes too far (Newton's method. It converges slowly
/// where the ray all but misses, and ends somewhere near the body where it does.) The plain
/// reference of CurvedPiece::meeting(), which takes less time.
SurfacePoint meeting_by_planes(
    const PrimitivePath& path, std::uint32_t piece, const Ray& local, const Passage& passage);

} // namespace vera
