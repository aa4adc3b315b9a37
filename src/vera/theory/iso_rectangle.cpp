// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/iso_rectangle.h"

#include <stdexcept>
#include <string>

namespace vera {

namespace {

void require_small(const std::string& name, std::int32_t value) {
    if (value < -largest_plane_coordinate || value > largest_plane_coordinate)
        throw std::invalid_argument(
            name + " has the coordinate " + std::to_string(value)
            + ", and the largest magnitude is " + std::to_string(largest_plane_coordinate)
            + ": scale everything down");
}

bool meets(
    const IsoRectangle& rectangle,
    const std::array<PlaneStrip, side_condition_count>& half_planes) {
    for (std::size_t i = 0; i < side_condition_count; ++i)
        if (!contains(half_planes[i], condition_point(rectangle, static_cast<SideCondition>(i))))
            return false;
    return true;
}

} // namespace

PlanePoint condition_point(const IsoRectangle& rectangle, SideCondition condition) {
    switch (condition) {
    case SideCondition::below_upper_x:
        return {rectangle.z, rectangle.upper_x};
    case SideCondition::above_lower_x:
        return {rectangle.z, rectangle.lower_x};
    case SideCondition::below_upper_y:
        return {rectangle.z, rectangle.upper_y};
    case SideCondition::above_lower_y:
        break;
    }
    return {rectangle.z, rectangle.lower_y};
}

PlaneStrip condition_half_plane(const WholeRay& ray, SideCondition condition) {
    const bool is_of_x =
        condition == SideCondition::below_upper_x || condition == SideCondition::above_lower_x;
    const bool is_of_upper =
        condition == SideCondition::below_upper_x || condition == SideCondition::below_upper_y;
    const std::size_t axis = is_of_x ? 0 : 1;
    // At z the line is at origin + (z - origin_z) direction / direction_z. Times direction_z, made
    // positive, that is compared with a side: dot(normal, (z, side)) is at most, or at least, the
    // same of the origin.
    const std::int64_t sense = ray.direction[2] > 0 ? 1 : -1;
    const PlaneDirection normal = {sense * ray.direction[axis], -sense * ray.direction[2]};
    const std::int64_t at_origin = dot(normal, PlanePoint{ray.origin[2], ray.origin[axis]});
    PlaneStrip half_plane = {normal};
    (is_of_upper ? half_plane.highest : half_plane.lowest) = at_origin;
    return half_plane;
}

std::array<PlaneStrip, side_condition_count> condition_half_planes(const WholeRay& ray) {
    if (ray.direction[2] == 0)
        throw std::invalid_argument(
            "the ray's direction has no z, and so it meets a rectangle in a plane across z only "
            "where it lies in that plane: turn it, or leave it out");
    for (const std::int32_t value : ray.origin)
        require_small("the ray's origin", value);
    std::array<PlaneStrip, side_condition_count> half_planes;
    for (std::size_t i = 0; i < side_condition_count; ++i)
        half_planes[i] = condition_half_plane(ray, static_cast<SideCondition>(i));
    return half_planes;
}

void require_rectangles(std::span<const IsoRectangle> rectangles) {
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
        const IsoRectangle& rectangle = rectangles[i];
        const std::string name = "rectangle " + std::to_string(i);
        if (rectangle.lower_x > rectangle.upper_x || rectangle.lower_y > rectangle.upper_y)
            throw std::invalid_argument(
                name + " has a lower side above its upper side: exchange the two");
        for (const std::int32_t value :
             {rectangle.z,
              rectangle.lower_x,
              rectangle.upper_x,
              rectangle.lower_y,
              rectangle.upper_y})
            require_small(name, value);
    }
}

std::optional<std::uint32_t>
brute_force_first_rectangle(std::span<const IsoRectangle> rectangles, const WholeRay& ray) {
    const auto half_planes = condition_half_planes(ray);
    std::optional<std::uint32_t> first;
    for (std::uint32_t i = 0; i < rectangles.size(); ++i)
        if (is_ahead(ray, rectangles[i].z) && meets(rectangles[i], half_planes)
            && (!first || is_nearer(ray, rectangles[i].z, rectangles[*first].z)))
            first = i;
    return first;
}

} // namespace vera
