// SPDX-License-Identifier: Apache-2.0
// Rectangles across the z axis with sides along x and y, and rays that may meet them (VERA 3.3.1),
// in whole numbers.
#pragma once

#include "vera/theory/plane_strip.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace vera {

/// The points (x, y, z) with lower_x <= x <= upper_x and lower_y <= y <= upper_y. Its border
/// belongs to it; it may be a point or a line.
struct IsoRectangle {
    std::int32_t z = 0;
    std::int32_t lower_x = 0;
    std::int32_t upper_x = 0;
    std::int32_t lower_y = 0;
    std::int32_t upper_y = 0;
};

/// From the origin on, which belongs to it.
struct WholeRay {
    std::array<std::int32_t, 3> origin = {};
    std::array<std::int32_t, 3> direction = {}; ///< the z is not 0; need not be unit
};

/// A ray's line is at (x, y) where it is at the z of a rectangle. That x is at most upper_x where,
/// in a plane of its own, the point (z, upper_x) lies on one side of the line that the ray's line
/// looks like; and so on. So a line meets a rectangle where each of these points lies in a
/// half-plane.
enum class SideCondition { below_upper_x, above_lower_x, below_upper_y, above_lower_y };

constexpr std::size_t side_condition_count = 4;

/// The point of the rectangle that the condition asks about: (z, upper_x) or the like.
PlanePoint condition_point(const IsoRectangle& rectangle, SideCondition condition);

/// Where that point must lie. The normals are multiples of the direction's components.
PlaneStrip condition_half_plane(const WholeRay& ray, SideCondition condition);

/// Those of all conditions, in their order. Throws std::invalid_argument where the ray's direction
/// has no z, or its origin lies farther off than largest_plane_coordinate.
std::array<PlaneStrip, side_condition_count> condition_half_planes(const WholeRay& ray);

/// Throws std::invalid_argument where a rectangle's lower side is not the lower one, or a
/// coordinate is larger than largest_plane_coordinate.
void require_rectangles(std::span<const IsoRectangle> rectangles);

/// Whether a rectangle at z lies where the ray goes, and not behind its origin.
constexpr bool is_ahead(const WholeRay& ray, std::int32_t z) {
    return ray.direction[2] > 0 ? z >= ray.origin[2] : z <= ray.origin[2];
}

/// Whether the ray comes to a before it comes to b; both lie ahead.
constexpr bool is_nearer(const WholeRay& ray, std::int32_t a, std::int32_t b) {
    return ray.direction[2] > 0 ? a < b : a > b;
}

/// The reference: the number of the rectangle that the ray meets first, of several in one plane the
/// smallest one; nothing where it meets none. Looks at each. Throws std::invalid_argument as
/// condition_half_planes() does.
std::optional<std::uint32_t>
brute_force_first_rectangle(std::span<const IsoRectangle> rectangles, const WholeRay& ray);

} // namespace vera
