// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/face_color.h"

#include "vera/scene/surface.h"
#include "vera/shade/firmament.h"
#include "vera/shade/lighting.h"
#include "vera/visible/drawn_color.h"
#include "vera/visible/region_light.h"
#include "vera/visible/tones.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace vera {

namespace {

/// What the face gives back towards the viewer at the point of its plane that is seen in the middle
/// of the ring, without mirrors.
Color light_of_face(const FillSources& sources, std::uint32_t face, const VisibleMap::Ring& ring) {
    const LightSet lights = ~sources.map.regions[ring.region].unlit;
    const Facets::Triangle& facet = sources.facets.triangles[sources.faces.first_facet[face]];
    const Vec3 a = sources.facets.corners[facet.corners[0]];
    const Vec3 normal = normalized(cross(
        sources.facets.corners[facet.corners[1]] - a,
        sources.facets.corners[facet.corners[2]] - a));
    double x = 0;
    double y = 0;
    for (const std::uint32_t vertex : sources.map.vertices_of(ring)) {
        x += sources.map.vertices[vertex].x();
        y += sources.map.vertices[vertex].y();
    }
    const double per_part = 1 / (static_cast<double>(ring.count) * screen_size);
    const Ray ray = view_ray(sources.camera, x * per_part, y * per_part);
    const double speed = dot(normal, ray.direction);
    SurfacePoint surface;
    surface.point = speed == 0 ? a : point_at(ray, dot(normal, a - ray.origin) / speed);
    surface.point_error = error_of_seen(ray, surface.point);
    surface.geometric_normal = surface.shading_normal = normal;
    surface.material = facet.material;
    const Material& material = material_of(sources.scene, facet.material);
    const Incidence at = incidence(surface, ray.direction);
    LocalTerms terms = unlit(at, material, sources.picture.ambient);
    for (std::size_t i = 0; i < sources.scene.lights.size(); ++i)
        if (contains(lights, i))
            terms += unshadowed(at, material, sources.scene.lights[i]);
    return sum(terms);
}

} // namespace

DrawingColor region_color(const FillSources& sources, std::span<const VisibleMap::Ring> region) {
    const std::uint32_t face = region.front().source;
    const Facets::Triangle& facet = sources.facets.triangles[sources.faces.first_facet[face]];
    const auto largest =
        std::max_element(region.begin(), region.end(), [&](const auto& a, const auto& b) {
            return doubled_area(sources.map, a) < doubled_area(sources.map, b);
        });
    const Color light = light_of_face(sources, face, *largest);
    return drawn_color(
        sources.style == DrawingStyle::toon
            ? toned(light, material_of(sources.scene, facet.material))
            : light);
}

std::optional<DrawingColor> background_color(const FillSources& sources) {
    switch (sources.style) {
    case DrawingStyle::flat:
    case DrawingStyle::toon:
        return drawn_color(firmament_color(
            sources.picture.firmament, view_ray(sources.camera, 0.5, 0.5).direction));
    case DrawingStyle::shaded: // painted with its outlines
    case DrawingStyle::ids:    // of numbers: see numbered_areas.h
    case DrawingStyle::lines:
    case DrawingStyle::hidden_lines:
        break;
    }
    return std::nullopt;
}

} // namespace vera
