// SPDX-License-Identifier: Apache-2.0
#include "vera/shade/lighting.h"

#include "vera/base/check.h"

#include <cmath>
#include <cstddef>

namespace vera {

Incidence incidence(const SurfacePoint& surface, Vec3 ray_direction) {
    Incidence at;
    at.point = surface.point;
    at.point_error = surface.point_error;
    at.to_viewer = -ray_direction;

    at.from_outside = dot(at.to_viewer, surface.geometric_normal) >= 0;
    at.geometric_normal = at.from_outside ? surface.geometric_normal : -surface.geometric_normal;

    const double cosine = dot(at.to_viewer, surface.shading_normal);
    at.normal = cosine < 0 ? -surface.shading_normal : surface.shading_normal;
    at.cos_viewer = std::abs(cosine);
    at.mirrored = normalized(2 * at.cos_viewer * at.normal - at.to_viewer);
    return at;
}

double highlight_factor(double x, double spc) {
    if (!(spc < 1 && x >= spc))
        return 0;
    const double width = 1 - spc;
    return (x - spc) * (x + spc - 2) / (width * width);
}

bool is_lit_from(const Incidence& at, Vec3 to_light) {
    // What a light in the plane is off by: at most sqrt(3) of the point's error, and what a
    // difference and a product of a unit vector round. Without it such a light would reach some
    // places and others not, at random.
    const double rounding = 2 * at.point_error + 0x1p-48 * max_component(abs(to_light));
    return dot(to_light, at.normal) > 0 && dot(to_light, at.geometric_normal) > rounding;
}

LightTerms unshadowed(const Incidence& at, const Material& material, const PointLight& light) {
    const Vec3 to_light = light.position - at.point;
    if (!is_lit_from(at, to_light))
        return {};

    const double distance = length(to_light);
    const Vec3 light_direction = to_light / distance;
    const double strength = light.falloff == Falloff::inverse_square
        ? light.intensity / distance / distance
        : light.intensity;
    const Color intensity = strength * light.color;

    const double cos_viewer = dot(light_direction, at.to_viewer);
    const double factor = highlight_factor(dot(light_direction, at.mirrored), material.spc);
    LightTerms terms;
    terms.diffuse = (dot(light_direction, at.normal) * material.drf
                     + (cos_viewer > 0 ? cos_viewer : 0) * material.arf)
        * intensity;
    terms.highlight = factor * factor * intensity;
    return terms;
}

LocalTerms unlit(const Incidence& at, const Material& material, Color ambient_light) {
    LocalTerms terms;
    terms.ambient = (at.cos_viewer * material.drf + material.arf) * ambient_light;
    terms.luminosity = luminosity(at.cos_viewer, material);
    return terms;
}

std::optional<Vec3> refracted(const Incidence& at, double ref) {
    // Without a change of index the ray goes on as it came, to the bit.
    if (ref == 1)
        return -at.to_viewer;

    const double ratio = at.from_outside ? 1 / ref : ref;
    const Vec3 across = at.cos_viewer * at.normal - at.to_viewer; // its length is the sine
    const double cos_squared = 1 - ratio * ratio * dot(across, across);
    if (cos_squared < 0)
        return std::nullopt;
    return normalized(ratio * across - std::sqrt(cos_squared) * at.normal);
}

const Material& material_of(const Scene& scene, MaterialId material) {
    static const Material fallback = Material::fallback();
    if (material == inherited_material)
        return fallback;
    const auto number = static_cast<std::size_t>(material);
    VERA_CHECK(number < scene.materials.size());
    return scene.materials[number];
}

} // namespace vera
