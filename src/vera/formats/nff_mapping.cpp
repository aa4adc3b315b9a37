// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/nff_mapping.h"

#include "vera/math/elementary.h"

#include <algorithm>
#include <cmath>

namespace vera {

std::optional<Camera> camera_of(const NffView& view) {
    if (!(view.angle_degrees > 0 && view.angle_degrees < 180))
        return std::nullopt;
    const double distance = length(view.at - view.from);
    const Vec3 forward = normalized(view.at - view.from);
    const Vec3 right = normalized(cross(forward, normalized(view.up)));
    const Vec3 up = cross(right, forward);
    const double half_width =
        distance * sin_degrees(view.angle_degrees / 2) / cos_degrees(view.angle_degrees / 2);
    const double half_height =
        half_width * static_cast<double>(view.height) / static_cast<double>(view.width);
    Camera camera;
    camera.viewpoint = view.from;
    camera.lower_left = view.at - half_width * right - half_height * up;
    camera.lower_right = view.at + half_width * right - half_height * up;
    camera.upper_left = view.at - half_width * right + half_height * up;
    const Vec3 area =
        cross(camera.lower_right - camera.lower_left, camera.upper_left - camera.lower_left);
    const bool good = distance > 0 && right != Vec3{} && area != Vec3{} && is_finite(area)
        && is_finite(camera.lower_left);
    return good ? std::optional(camera) : std::nullopt;
}

double spc_of(double shine) {
    if (!(shine > 0))
        return 1;
    // With u = (1 - x) / (1 - SPC), f(x) is u^2 - 1, so that f(x)^2 = 1/2 where
    // u^2 = 1 - sqrt(1/2); and x^shine = 1/2 where x = 2^(-1/shine).
    const double u = std::sqrt(1 - std::sqrt(0.5));
    const double x = exp2_of(-1 / std::max(shine, 0.001));
    return 1 - (1 - x) / u;
}

Material material_of(const NffFill& fill) {
    Material material;
    material.drf = fill.kd * fill.color;
    material.rab = {fill.ks, fill.ks, fill.ks};
    material.tab = {fill.transmittance, fill.transmittance, fill.transmittance};
    material.spc = fill.ks > 0 ? spc_of(fill.shine) : 1;
    material.ref = fill.index > 0 ? fill.index : 1;
    return material;
}

std::optional<RotationalShape> shape_of(const NffCone& cone) {
    const double height = length(cone.apex - cone.base);
    ContourPiece::Point base = {std::abs(cone.base_radius), 0};
    ContourPiece::Point apex = {std::abs(cone.apex_radius), height};
    if (!(height > 0) || !std::isfinite(height) || !(base.r + apex.r > 0))
        return std::nullopt;
    RotationalShape shape;
    shape.base = cone.base;
    shape.axis = normalized(cone.apex - cone.base);
    if (cone.base_radius < 0 || cone.apex_radius < 0)
        std::swap(base, apex);
    shape.start = base;
    ContourPiece line;
    line.end = apex;
    shape.contour.push_back(line);
    return shape;
}

} // namespace vera
