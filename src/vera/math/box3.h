// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"

#include <limits>

namespace vera {

/// An axis-aligned box. A box made without corners is empty: it contains no point, and
/// growing it by a point gives that point.
struct Box3 {
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    Vec3 lower = {infinity, infinity, infinity};
    Vec3 upper = {-infinity, -infinity, -infinity};

    constexpr bool empty() const {
        return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z);
    }

    friend constexpr bool operator==(const Box3&, const Box3&) = default;
};

constexpr Box3 grown(const Box3& box, Vec3 point) {
    return {min(box.lower, point), max(box.upper, point)};
}

constexpr Box3 united(const Box3& a, const Box3& b) {
    return {min(a.lower, b.lower), max(a.upper, b.upper)};
}

constexpr Vec3 center(const Box3& box) {
    return 0.5 * box.lower + 0.5 * box.upper;
}

constexpr Vec3 extent(const Box3& box) {
    return box.empty() ? Vec3{} : box.upper - box.lower;
}

constexpr bool contains(const Box3& box, Vec3 point) {
    return point.x >= box.lower.x && point.x <= box.upper.x && point.y >= box.lower.y
        && point.y <= box.upper.y && point.z >= box.lower.z && point.z <= box.upper.z;
}

/// Corner number i, from 0 to 7: bit a of i chooses the upper side of axis a.
constexpr Vec3 corner(const Box3& box, unsigned i) {
    return {
        (i & 1U) != 0 ? box.upper.x : box.lower.x,
        (i & 2U) != 0 ? box.upper.y : box.lower.y,
        (i & 4U) != 0 ? box.upper.z : box.lower.z};
}

} // namespace vera
