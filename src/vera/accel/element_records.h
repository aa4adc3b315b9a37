// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/local_geometry.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vera::detail {

/// How an element is met by a cheap test in single precision that never misses a ray which meets
/// the element, in local coordinates.
struct ElementRecord {
    enum class Kind : std::uint8_t {
        sphere,     ///< center, radius
        triangle,   ///< corner, edge e to the second corner, edge f to the third
        quadrangle, ///< corner, edges e and f to its neighbours, x and y: corner + x e + y f is the
                    ///< opposite corner
        box,        ///< lower corner, upper corner
        mantle,     ///< of a cylinder or truncated cone: center, axis (unit), radius and half its
                    ///< length, how much the radius grows along the axis
        cylinder,   ///< one around a rotational shape: center, axis (unit), radius, half its length
        call        ///< of a subscene: as box
    };

    std::array<float, 11> values = {};
    Kind kind = Kind::box;
};

constexpr std::size_t element_kinds = static_cast<std::size_t>(ElementRecord::Kind::call) + 1;

/// The record of an element that lies within the box; both in local coordinates.
ElementRecord element_record(const LocalGeometry& local, Element element, const Box3& local_box);

} // namespace vera::detail
