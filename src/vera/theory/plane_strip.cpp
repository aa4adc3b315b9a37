// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/plane_strip.h"

#include <stdexcept>
#include <string>

namespace vera {

void require_plane_points(std::span<const PlanePoint> points) {
    for (std::size_t i = 0; i < points.size(); ++i)
        for (const std::int32_t value : {points[i].x, points[i].y})
            if (value < -largest_plane_coordinate || value > largest_plane_coordinate)
                throw std::invalid_argument(
                    "point " + std::to_string(i) + " has the coordinate " + std::to_string(value)
                    + ", and the largest magnitude is " + std::to_string(largest_plane_coordinate)
                    + ": scale the points down");
}

void require_plane_strip(const PlaneStrip& strip) {
    for (const std::int64_t value : {strip.normal.x, strip.normal.y})
        if (value < -largest_plane_direction || value > largest_plane_direction)
            throw std::invalid_argument(
                "the strip's normal has the component " + std::to_string(value)
                + ", and the largest magnitude is " + std::to_string(largest_plane_direction)
                + ": divide the normal and both bounds by their common factors");
}

std::vector<std::uint32_t>
brute_force_numbers_in(std::span<const PlanePoint> points, const PlaneStrip& strip) {
    require_plane_strip(strip);
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        if (contains(strip, points[i]))
            numbers.push_back(i);
    return numbers;
}

} // namespace vera
