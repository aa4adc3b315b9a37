// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/sloped_ray.h"

#include <cstddef>
#include <stdexcept>
#include <string>

namespace vera {

PlaneStrip x_strip(const IsoRectangle& rectangle) {
    return {{rectangle.z, 1}, rectangle.lower_x, rectangle.upper_x};
}

PlaneStrip y_strip(const IsoRectangle& rectangle) {
    return {{rectangle.z, 1}, rectangle.lower_y, rectangle.upper_y};
}

bool meets(const SlopedRay& ray, const IsoRectangle& rectangle) {
    return rectangle.z >= ray.first_z && contains(x_strip(rectangle), x_point(ray))
        && contains(y_strip(rectangle), y_point(ray));
}

void require_sloped_rays(std::span<const SlopedRay> rays) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const SlopedRay& ray = rays[i];
        for (const std::int32_t value :
             {ray.slope_x, ray.offset_x, ray.slope_y, ray.offset_y, ray.first_z})
            if (value < -largest_plane_coordinate || value > largest_plane_coordinate)
                throw std::invalid_argument(
                    "ray " + std::to_string(i) + " has the number " + std::to_string(value)
                    + ", and the largest magnitude is " + std::to_string(largest_plane_coordinate)
                    + ": scale everything down");
    }
}

std::vector<std::uint32_t>
brute_force_rays_met(const IsoRectangle& rectangle, std::span<const SlopedRay> rays) {
    std::vector<std::uint32_t> met;
    for (std::uint32_t i = 0; i < rays.size(); ++i)
        if (meets(rays[i], rectangle))
            met.push_back(i);
    return met;
}

FirstRectangles brute_force_first_rectangles(
    std::span<const IsoRectangle> rectangles, std::span<const SlopedRay> rays) {
    require_rectangles(rectangles);
    require_sloped_rays(rays);
    FirstRectangles first(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        for (std::uint32_t k = 0; k < rectangles.size(); ++k)
            if (meets(rays[i], rectangles[k])
                && (!first[i] || rectangles[k].z < rectangles[*first[i]].z))
                first[i] = k;
    return first;
}

} // namespace vera
