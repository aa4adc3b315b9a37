// SPDX-License-Identifier: Apache-2.0
#include "vera/render/facet_hit.h"

#include "vera/accel/primitive_hit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace vera {

double facet_t(const Facets& facets, std::uint32_t facet, const Ray& ray) {
    constexpr double grazing = 0x1p-10;
    std::array<Vec3, 3> from_origin;
    std::array<double, 3> along;
    for (std::size_t i = 0; i < 3; ++i) {
        from_origin[i] = facets.corners[facets.triangles[facet].corners[i]] - ray.origin;
        along[i] = dot(from_origin[i], ray.direction);
    }
    const Vec3 normal =
        normalized(cross(from_origin[1] - from_origin[0], from_origin[2] - from_origin[0]));
    const double speed = dot(normal, ray.direction);
    const double t = dot(normal, from_origin[0]) / speed;
    if (std::abs(speed) >= grazing)
        return std::max(t, ray.t_min);
    const auto [least, most] = std::minmax_element(along.begin(), along.end());
    return std::max(speed != 0 ? std::clamp(t, *least, *most) : *least, ray.t_min);
}

Hit facet_hit(const Scene& scene, const Facets& facets, std::uint32_t facet, const Ray& ray) {
    const Facets::Triangle& triangle = facets.triangles[facet];
    const Hit hit = primitive_hit(scene, ray, triangle.primitive);
    if (hit.found())
        return hit;
    return {facet_t(facets, facet, ray), {triangle.primitive, triangle.piece}};
}

} // namespace vera
