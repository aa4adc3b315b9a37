// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

namespace vera {

/// A point or a direction.
struct Vec3 {
    double x = 0;
    double y = 0;
    double z = 0;

    constexpr double operator[](std::size_t axis) const {
        return axis == 0 ? x : axis == 1 ? y : z;
    }

    constexpr double& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }

    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

constexpr Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

constexpr Vec3 operator-(Vec3 a) {
    return {-a.x, -a.y, -a.z};
}

constexpr Vec3 operator*(double factor, Vec3 a) {
    return {factor * a.x, factor * a.y, factor * a.z};
}

constexpr Vec3 operator*(Vec3 a, double factor) {
    return factor * a;
}

constexpr Vec3 operator/(Vec3 a, double divisor) {
    return {a.x / divisor, a.y / divisor, a.z / divisor};
}

constexpr double dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Changes its sign, and nothing else, when the arguments are exchanged: also when rounded.
constexpr Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

constexpr Vec3 min(Vec3 a, Vec3 b) {
    return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

constexpr Vec3 max(Vec3 a, Vec3 b) {
    return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

inline Vec3 abs(Vec3 a) {
    return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}

constexpr double max_component(Vec3 a) {
    const double larger = a.x > a.y ? a.x : a.y;
    return larger > a.z ? larger : a.z;
}

/// The axis (0, 1, 2) along which a is longest; the first of them on a tie.
inline std::size_t longest_axis(Vec3 a) {
    const Vec3 length = abs(a);
    if (length.x >= length.y && length.x >= length.z)
        return 0;
    return length.y >= length.z ? 1 : 2;
}

namespace detail {

/// length() of a vector whose largest component has that absolute value, however large or small.
double scaled_length(Vec3 a, double largest);

} // namespace detail

/// Neither overflows nor underflows where the result does not.
inline double length(Vec3 a) {
    const double largest = max_component(abs(a));
    if (largest > 1e-140 && largest < 1e140) [[likely]]
        return std::sqrt(dot(a, a));
    return detail::scaled_length(a, largest);
}

/// The unit vector in a's direction; a itself where a is zero.
inline Vec3 normalized(Vec3 a) {
    const double norm = length(a);
    return norm > 0 ? a / norm : a;
}

inline bool is_finite(Vec3 a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

} // namespace vera
