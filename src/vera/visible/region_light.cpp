// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_light.h"

#include "vera/scene/surface.h"
#include "vera/shade/lighting.h"

#include <algorithm>

namespace vera {

namespace {

/// Near the silhouette of a curved surface a facet still shows its outside where the surface has
/// turned away. Such a place is seen as one on the silhouette.
void turn_towards_viewer(SurfacePoint& surface, Vec3 ray_direction, bool shows_outside) {
    const double off = dot(surface.geometric_normal, ray_direction);
    if ((off < 0) == shows_outside)
        return;
    const Vec3 across = surface.geometric_normal - off * ray_direction;
    // Sure to be on the facet's side after rounding.
    constexpr double slight = 0x1p-40;
    const Vec3 towards = shows_outside ? -ray_direction : ray_direction;
    surface.geometric_normal = surface.shading_normal = normalized(across + slight * towards);
}

} // namespace

RegionLight::RegionLight(
    const Scene& scene,
    const Camera& camera,
    const PictureSettings& picture,
    const Facets& facets,
    std::uint32_t first_facet,
    LightSet lights)
    : scene_(scene)
    , rays_(camera)
    , width_(picture.width)
    , height_(picture.height)
    , ambient_(picture.ambient)
    , facet_(facets.triangles[first_facet])
    , path_(path_to(scene, facet_.primitive))
    , corner_(facets.corners[facet_.corners[0]])
    , normal_(normalized(cross(
          facets.corners[facet_.corners[1]] - corner_,
          facets.corners[facet_.corners[2]] - corner_)))
    , lights_(lights) {
    const ItemKind kind = path_.geometry->items[path_.element.item].kind;
    is_curved_ = kind == ItemKind::sphere || kind == ItemKind::rotational_shape;
    convexity_ = convexity(path_, facet_.piece);
    shows_outside_ =
        dot(normal_,
            camera.projection == Camera::Projection::parallel ? camera.direction
                                                              : corner_ - camera.viewpoint)
        < 0;
    if (convexity_ == Convexity::none)
        return;
    for (std::size_t i = first_facet; i < facets.triangles.size(); ++i) {
        const Facets::Triangle& facet = facets.triangles[i];
        if (facet.primitive != facet_.primitive || facet.piece != facet_.piece)
            break;
        for (const std::uint32_t corner : facet.corners)
            reach_ = std::max(reach_, length(facets.corners[corner] - corner_));
    }
}

Color RegionLight::operator()(DrawingPoint point) const {
    const Ray ray = rays_.ray(point.x / width_, point.y / height_);
    const SurfacePoint surface = convexity_ == Convexity::none ? on_facet(ray) : on_body(ray);
    const Material& material = material_of(scene_, facet_.material);
    const Incidence at = incidence(surface, ray.direction);
    LocalTerms terms = unlit(at, material, ambient_);
    for (std::size_t i = 0; i < scene_.lights.size(); ++i)
        if (contains(lights_, i))
            terms += unshadowed(at, material, scene_.lights[i]);
    return clamped(sum(terms));
}

SurfacePoint RegionLight::on_facet(const Ray& ray) const {
    const double speed = dot(normal_, ray.direction);
    const double t = speed == 0 ? dot(corner_ - ray.origin, ray.direction)
                                : dot(normal_, corner_ - ray.origin) / speed;
    const Vec3 place = transformed_point(path_.from_world, point_at(ray, t));
    SurfacePoint surface = carried_to_main_scene(path_, surface_within(path_, facet_.piece, place));
    if (is_curved_)
        turn_towards_viewer(surface, ray.direction, speed < 0);
    return surface;
}

/// Goes from beyond all that is seen to where the ray meets the convex body, from plane to plane:
/// that which touches the body nearest to where one is does not cut it, so that one never comes too
/// far. (Newton's method. It converges slowly only where the ray all but misses.)
SurfacePoint RegionLight::on_body(const Ray& ray) const {
    constexpr int most_steps = 40;
    constexpr double nearest = 1e-6; // of the reach, and of the last step, which squares it
    const bool enters = shows_outside_ == (convexity_ == Convexity::outwards);
    const double forward = enters ? 1 : -1;
    const double turned = convexity_ == Convexity::outwards ? 1 : -1;
    const Ray local = transformed_ray(path_.from_world, ray);
    // Not quite from a place that a scene of round numbers might have on an axis.
    double t = dot(corner_ - ray.origin, ray.direction) - 1.0127 * forward * reach_;
    SurfacePoint surface = surface_within(path_, facet_.piece, point_at(local, t));
    for (int i = 0; i < most_steps; ++i) {
        const Vec3 outwards = turned * surface.geometric_normal;
        const double off = dot(outwards, point_at(local, t) - surface.point);
        const double speed = -forward * dot(outwards, local.direction);
        if (!(speed > 0 && off > nearest * speed * reach_))
            break;
        t += forward * off / speed;
        surface = surface_within(path_, facet_.piece, point_at(local, t));
    }
    surface = carried_to_main_scene(path_, surface);
    turn_towards_viewer(surface, ray.direction, shows_outside_);
    return surface;
}

} // namespace vera
