// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/brute_force.h"

namespace vera {

int inclusion(const std::array<ScreenVertex, 3>& corners, std::int64_t x, std::int64_t y) {
    int result = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenPoint from = corners[i].point;
        const ScreenStep side = step(from, corners[(i + 1) % 3].point);
        const std::int64_t doubled =
            cross(side, {x - 2 * std::int64_t{from.x}, y - 2 * std::int64_t{from.y}});
        if (doubled < 0)
            return -1;
        result = doubled == 0 ? 0 : result;
    }
    return result;
}

DoubledNearness doubled_nearness(const DepthPlane& plane, std::int64_t x, std::int64_t y) {
    return {
        Int128{plane.area} * plane.nearness * 2
            + Int128{plane.along_x} * (x - 2 * std::int64_t{plane.at.x})
            + Int128{plane.along_y} * (y - 2 * std::int64_t{plane.at.y}),
        plane.area};
}

SeenAt seen_at(const ScreenScene& scene, std::int64_t x_in_halves, std::int64_t y_in_halves) {
    SeenAt result = {no_source, 0, false};
    DoubledNearness best = {};
    for (const ScreenTriangle& triangle : scene.triangles) {
        const auto corners = corners_of(scene, triangle);
        const int included = inclusion(corners, x_in_halves, y_in_halves);
        if (included < 0)
            continue;
        result.has_side_at = result.has_side_at || included == 0;
        if (triangle.is_shadow())
            continue;
        const DoubledNearness here =
            doubled_nearness(depth_plane(corners), x_in_halves, y_in_halves);
        const int ahead = result.source == no_source ? 1 : order(here, best);
        if (ahead > 0 || (ahead == 0 && triangle.source < result.source)) {
            best = here;
            result.source = triangle.source;
        }
    }
    result.unlit = scene.unlit_of(result.source);
    for (const ScreenTriangle& triangle : scene.triangles)
        if (triangle.is_shadow() && triangle.source == result.source
            && inclusion(corners_of(scene, triangle), x_in_halves, y_in_halves) >= 0)
            result.unlit |= LightSet{1} << triangle.light;
    return result;
}

} // namespace vera
