// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

namespace vera {

/// No primitive, or no piece.
constexpr std::uint64_t no_primitive = ~std::uint64_t{0};
constexpr std::uint32_t no_piece = ~std::uint32_t{0};

/// A face of the scene: the primitive's number, counted from 0 in text order with subscenes
/// expanded at each call, and the piece of it (of a rotational shape's contour, of a split
/// quadrangle).
struct FaceId {
    std::uint64_t primitive = no_primitive;
    std::uint32_t piece = 0;

    friend constexpr bool operator==(const FaceId&, const FaceId&) = default;
    friend constexpr auto operator<=>(const FaceId&, const FaceId&) = default;
};

/// The first face that a ray meets, and where; no_primitive and infinity where it meets none.
struct Hit {
    double t = std::numeric_limits<double>::infinity();
    FaceId face;

    bool found() const { return face.primitive != no_primitive; }

    friend constexpr bool operator==(const Hit&, const Hit&) = default;
};

} // namespace vera
