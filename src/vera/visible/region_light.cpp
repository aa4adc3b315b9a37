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

/// Whether the normal is interpolated.
bool is_patch(const PrimitivePath& path) {
    const Item& item = path.geometry->items[path.element.item];
    return item.kind == ItemKind::patch
        || (item.kind == ItemKind::mesh && !path.geometry->meshes[item.index].normals.empty());
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
    if (kind == ItemKind::sphere || kind == ItemKind::rotational_shape)
        curved_.emplace(path_, facet_.piece);
    convexity_ = convexity(path_, facet_.piece);
    shows_outside_ =
        dot(normal_,
            camera.projection == Camera::Projection::parallel ? camera.direction
                                                              : corner_ - camera.viewpoint)
        < 0;
    if (convexity_ == Convexity::none) {
        const Vec3 corner = transformed_point(path_.from_world, corner_);
        if (curved_)
            parameter_ = curved_->parameter_near(corner);
        else if (!is_patch(path_))
            flat_normal_ = surface_within(path_, facet_.piece, corner).geometric_normal;
        return;
    }
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
    SurfacePoint surface = convexity_ == Convexity::none ? on_facet(ray) : on_body(ray);
    surface.point_error = std::max(surface.point_error, error_of_seen(ray, surface.point));
    const Material& material = material_of(scene_, facet_.material);
    const Incidence at = incidence(surface, ray.direction);
    LocalTerms terms = unlit(at, material, ambient_);
    for (std::size_t i = 0; i < scene_.lights.size(); ++i)
        if (contains(lights_, i))
            terms += unshadowed(at, material, scene_.lights[i]);
    return clamped(sum(terms));
}

double error_of_seen(const Ray& ray, Vec3 point) {
    return 0x1p-50 * (max_component(abs(ray.origin)) + max_component(abs(point)));
}

SurfacePoint RegionLight::at(Vec3 point, Vec3 local_normal) const {
    SurfacePoint surface;
    surface.point = point;
    surface.geometric_normal = surface.shading_normal = path_.in_main_scene
        ? local_normal
        : normalized(transposed_times(path_.from_world.linear, local_normal));
    return surface;
}

SurfacePoint RegionLight::on_facet(const Ray& ray) const {
    const double speed = dot(normal_, ray.direction);
    const double t = speed == 0 ? dot(corner_ - ray.origin, ray.direction)
                                : dot(normal_, corner_ - ray.origin) / speed;
    const Vec3 point = point_at(ray, t);
    if (flat_normal_)
        return at(point, *flat_normal_);
    const Ray local = transformed_ray(path_.from_world, ray);
    double parameter = parameter_;
    const std::optional<CurvedPiece::Place> met =
        curved_ ? curved_->meeting_near(local, t, parameter) : std::nullopt;
    SurfacePoint surface = met
        ? at(point_at(ray, met->t), met->normal)
        : carried_to_main_scene(path_, surface_within(path_, facet_.piece, point_at(local, t)));
    if (curved_)
        turn_towards_viewer(surface, ray.direction, speed < 0);
    return surface;
}

SurfacePoint RegionLight::on_body(const Ray& ray) const {
    const bool enters = shows_outside_ == (convexity_ == Convexity::outwards);
    // Not quite from a place that a scene of round numbers might have on an axis.
    const double middle = dot(corner_ - ray.origin, ray.direction);
    const double reach = 1.0127 * reach_;
    const Ray local = transformed_ray(path_.from_world, ray);
    SurfacePoint surface;
    if (const auto met = curved_->meeting(local, {middle - reach, middle + reach, enters}))
        surface = at(point_at(ray, met->t), met->normal);
    else
        surface = carried_to_main_scene(
            path_,
            meeting_by_planes(
                path_, facet_.piece, local, {middle - reach, middle + reach, enters}));
    turn_towards_viewer(surface, ray.direction, shows_outside_);
    return surface;
}

} // namespace vera
