// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/scattered_rectangles.h"

#include "vera/theory/whole_within.h"

#include <cmath>

namespace vera {

namespace {

constexpr std::int32_t reach = 20000;
constexpr std::int32_t slope = 1000;

} // namespace

std::vector<IsoRectangle>
scattered_rectangles(std::size_t count, double parts, std::mt19937_64& random) {
    const auto longest =
        static_cast<std::uint64_t>(parts * reach / std::sqrt(static_cast<double>(count)));
    const auto side = [&] { return static_cast<std::int32_t>(random() % (longest + 1)); };
    std::vector<IsoRectangle> made(count);
    for (IsoRectangle& rectangle : made) {
        rectangle.z = whole_within(reach, random);
        rectangle.lower_x = whole_within(reach, random);
        rectangle.lower_y = whole_within(reach, random);
        rectangle.upper_x = rectangle.lower_x + side();
        rectangle.upper_y = rectangle.lower_y + side();
    }
    return made;
}

WholeRay scattered_ray(std::mt19937_64& random) {
    WholeRay ray;
    for (std::int32_t& value : ray.origin)
        value = whole_within(reach, random);
    for (std::int32_t& value : ray.direction)
        value = whole_within(slope, random);
    ray.direction[2] = ray.direction[2] == 0 ? 1 : ray.direction[2];
    return ray;
}

} // namespace vera
