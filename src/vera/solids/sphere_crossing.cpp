// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/sphere_crossing.h"

#include <algorithm>
#include <cmath>

namespace vera {

namespace {

/// From a point to the segment; also to one of no length.
double distance_to_segment(Vec3 point, Vec3 from, Vec3 to) {
    const Vec3 side = to - from;
    const double square = dot(side, side);
    const double t = square > 0 ? std::clamp(dot(point - from, side) / square, 0.0, 1.0) : 0;
    return length(point - from - t * side);
}

double distance_to_triangle(Vec3 point, const TriangleCorners& triangle) {
    const auto& [a, b, c] = triangle;
    const Vec3 normal = cross(b - a, c - a);
    const double size = length(normal);
    const bool is_over_it = size > 0 && dot(cross(b - a, point - a), normal) >= 0
        && dot(cross(c - b, point - b), normal) >= 0 && dot(cross(a - c, point - c), normal) >= 0;
    if (is_over_it)
        return std::abs(dot(point - a, normal)) / size;
    return std::min(
        {distance_to_segment(point, a, b),
         distance_to_segment(point, b, c),
         distance_to_segment(point, c, a)});
}

} // namespace

bool is_crossing(const Sphere& a, const Sphere& b) {
    const double distance = length(a.center - b.center);
    const double sum = a.radius + b.radius;
    return distance < (1 - touching_part) * sum
        && distance > std::abs(a.radius - b.radius) + touching_part * sum;
}

bool is_crossing(const Sphere& sphere, const TriangleCorners& triangle) {
    double farthest = 0;
    for (const Vec3 corner : triangle)
        farthest = std::max(farthest, length(corner - sphere.center));
    return farthest > (1 + touching_part) * sphere.radius
        && distance_to_triangle(sphere.center, triangle) < (1 - touching_part) * sphere.radius;
}

} // namespace vera
