// SPDX-License-Identifier: Apache-2.0
// Rays as points of two planes (VERA 3.3.2): the ray x = a z + b, y = c z + d has the points (a, b)
// and (c, d). A rectangle across the z axis is met where each of the two lies in a strip:
//
//     lower_x <= a z + b <= upper_x,    lower_y <= c z + d <= upper_y.
//
// All rays go the way z grows. Rays that go the other way are these once z is turned round, and
// rays along a plane across z meet a rectangle nowhere else than within its plane.
#pragma once

#include "vera/theory/iso_rectangle.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// From first_z on, which belongs to it.
struct SlopedRay {
    std::int32_t slope_x = 0;  ///< a
    std::int32_t offset_x = 0; ///< b
    std::int32_t slope_y = 0;  ///< c
    std::int32_t offset_y = 0; ///< d
    std::int32_t first_z = -largest_plane_coordinate;
};

/// (a, b)
constexpr PlanePoint x_point(const SlopedRay& ray) {
    return {ray.slope_x, ray.offset_x};
}

/// (c, d)
constexpr PlanePoint y_point(const SlopedRay& ray) {
    return {ray.slope_y, ray.offset_y};
}

/// Where the coordinate of which a point tells slope and offset is at z.
constexpr std::int64_t value_at(PlanePoint slope_and_offset, std::int32_t z) {
    return std::int64_t{slope_and_offset.x} * z + slope_and_offset.y;
}

/// The strips in which the points of those rays lie whose lines meet the rectangle.
PlaneStrip x_strip(const IsoRectangle& rectangle);
PlaneStrip y_strip(const IsoRectangle& rectangle);

/// Whether the ray meets the rectangle, whatever lies before it.
bool meets(const SlopedRay& ray, const IsoRectangle& rectangle);

/// Throws std::invalid_argument where a number is larger than largest_plane_coordinate.
void require_sloped_rays(std::span<const SlopedRay> rays);

/// The reference of all that tells the rays that a rectangle meets: their numbers, in their order.
/// Looks at each ray.
std::vector<std::uint32_t>
brute_force_rays_met(const IsoRectangle& rectangle, std::span<const SlopedRay> rays);

/// Of each ray, the number of the rectangle that it meets first; nothing where it meets none.
using FirstRectangles = std::vector<std::optional<std::uint32_t>>;

/// The reference of all that answers many rays at once: of several rectangles in one plane the one
/// of the smallest number. Looks at each pair. Throws std::invalid_argument as
/// require_sloped_rays() and require_rectangles() do.
FirstRectangles brute_force_first_rectangles(
    std::span<const IsoRectangle> rectangles, std::span<const SlopedRay> rays);

} // namespace vera
