// SPDX-License-Identifier: Apache-2.0
#include "ray_sets.h"

#include "vera/base/check.h"
#include "vera/base/parallel.h"
#include "vera/math/elementary.h"
#include "vera/scene/bounds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "lattice.h"

namespace vera {

namespace {

std::array<float, 3> floats(Vec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// What is left of a vector as floats.
Vec3 rounded(Vec3 v) {
    const auto [x, y, z] = floats(v);
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

void add(RaySet& set, const QueryRay& query, Vec3 float_origin, Vec3 float_direction) {
    set.queries.push_back(query);
    set.floats.push_back(
        {floats(float_origin), floats(float_direction), static_cast<float>(query.ray.t_max)});
}

/// The normal of the side that the viewer sees.
Vec3 facing_normal(const SurfacePoint& surface, const Ray& seen_along) {
    const bool outside = dot(surface.geometric_normal, seen_along.direction) < 0;
    return outside ? surface.geometric_normal : -surface.geometric_normal;
}

/// Beside the face. A step along the normal, unlike a smallest t, is enough however flat the ray
/// leaves.
Vec3 float_start(const SurfacePoint& surface, Vec3 normal, double beside) {
    const double size = std::max(max_component(abs(surface.point)), 1e-3);
    return surface.point + (beside * size) * normal;
}

QueryRay leaving(const SurfacePoint& surface, Vec3 direction) {
    QueryRay query;
    query.ray.origin = surface.point;
    query.ray.origin_error = surface.point_error;
    query.ray.direction = direction;
    query.start = surface.face;
    return query;
}

RaySet primary_rays(const Camera& camera, std::size_t raster) {
    constexpr std::size_t side = 32;
    constexpr std::size_t square = 4;
    VERA_CHECK(raster > 0 && raster % side == 0);
    const auto n = static_cast<double>(raster);
    RaySet set = {"primary", Question::nearest, Coherence::coherent, {}, {}};
    for (std::size_t i = 0; i < raster * raster; ++i) {
        const std::size_t tile = i / (side * side);
        const std::size_t block = i % (side * side) / (square * square);
        const std::size_t pixel = i % (square * square);
        const std::size_t x =
            tile % (raster / side) * side + block % (side / square) * square + pixel % square;
        const std::size_t y =
            tile / (raster / side) * side + block / (side / square) * square + pixel / square;
        QueryRay query;
        query.ray = view_ray(
            camera, (static_cast<double>(x) + 0.5) / n, (static_cast<double>(y) + 0.5) / n);
        query.ray.origin = rounded(query.ray.origin);
        query.ray.direction = rounded(query.ray.direction);
        add(set, query, query.ray.origin, query.ray.direction);
    }
    return set;
}

/// Calls sink(surface, normal, pixel, ray) for each hit: the normal on the viewer's side, the
/// number of the primary ray and the ray.
template <typename Sink>
void for_each_hit(const PrimaryHits& hits, const Sink& sink) {
    for (std::size_t i = 0; i < hits.hitting.size(); ++i) {
        const std::size_t pixel = hits.hitting[i];
        const Ray& ray = hits.rays.queries[pixel].ray;
        sink(hits.surfaces[i], facing_normal(hits.surfaces[i], ray), pixel, ray);
    }
}

RaySet shadow_rays(const Scene& scene, const PrimaryHits& hits) {
    RaySet set = {"shadow", Question::any, Coherence::coherent, {}, {}};
    VERA_CHECK(!scene.lights.empty());
    const Vec3 light = scene.lights.front().position;
    for_each_hit(hits, [&](const SurfacePoint& surface, Vec3 normal, std::size_t, const Ray&) {
        QueryRay query = leaving(surface, light - surface.point);
        query.ray.t_max = 1;
        if (!(dot(query.ray.direction, normal) > 0))
            return;
        const Vec3 start = float_start(surface, normal, hits.beside);
        add(set, query, start, light - start);
    });
    return set;
}

RaySet diffuse_rays(const PrimaryHits& hits) {
    RaySet set = {"diffuse", Question::nearest, Coherence::incoherent, {}, {}};
    for_each_hit(
        hits, [&](const SurfacePoint& surface, Vec3 normal, std::size_t pixel, const Ray&) {
            // A point of the unit sphere that touches the surface lies in a direction that is
            // distributed by the cosine to the normal.
            const double height = 2 * random_part(1, pixel, 0) - 1;
            const double angle = 360 * random_part(1, pixel, 1);
            const double radius = std::sqrt(std::max(0.0, 1 - height * height));
            const Vec3 on_sphere = {
                radius * cos_degrees(angle), radius * sin_degrees(angle), height};
            const Vec3 direction = rounded(normalized(on_sphere + 1.0001 * normal));
            add(set,
                leaving(surface, direction),
                float_start(surface, normal, hits.beside),
                direction);
        });
    return set;
}

RaySet shuffled(RaySet set) {
    for (std::size_t i = set.queries.size(); i > 1; --i) {
        const std::size_t other = random(2, i, 0) % i;
        std::swap(set.queries[i - 1], set.queries[other]);
        std::swap(set.floats[i - 1], set.floats[other]);
    }
    return set;
}

RaySet mirrored_rays(const Scene& scene, const PrimaryHits& hits) {
    RaySet set = {"mirror", Question::nearest, Coherence::incoherent, {}, {}};
    const Box3 box = bounds(scene);
    // Some forty waves through the scene; they tilt the normal by a few degrees.
    const double waves = 40 * 360 / max_component(box.upper - box.lower);
    for_each_hit(hits, [&](const SurfacePoint& surface, Vec3 normal, std::size_t, const Ray& ray) {
        const Vec3 phase = waves * surface.point;
        const Vec3 tilt = {
            sin_degrees(phase.y + 2 * phase.z),
            sin_degrees(phase.z + 2 * phase.x),
            sin_degrees(phase.x + 2 * phase.y)};
        const Vec3 bumpy = normalized(normal + 0.08 * tilt);
        const Vec3 mirrored = ray.direction - (2 * dot(ray.direction, bumpy)) * bumpy;
        // What the waves would send into the surface is mirrored out of it again.
        const double into = std::min(dot(mirrored, normal), 0.0);
        const Vec3 direction = rounded(normalized(mirrored - (2.01 * into) * normal));
        add(set, leaving(surface, direction), float_start(surface, normal, hits.beside), direction);
    });
    return set;
}

} // namespace

const std::vector<std::string>& ray_set_names() {
    static const std::vector<std::string> names = {
        "primary", "shadow", "diffuse", "shuffled", "ao", "mirror"};
    return names;
}

PrimaryHits
primary_hits(const Scene& scene, const RayIndex& index, std::size_t raster, double beside) {
    VERA_CHECK(scene.camera.has_value());
    PrimaryHits result;
    result.beside = beside;
    result.rays = primary_rays(*scene.camera, raster);
    const std::vector<QueryRay>& rays = result.rays.queries;
    std::vector<Hit> hits(rays.size());
    constexpr std::size_t generation = 1024;
    parallel_ranges(rays.size(), generation, [&](std::size_t first, std::size_t last) {
        QueryCounts counts;
        index.nearest_hits(
            std::span(rays).subspan(first, last - first),
            std::span(hits).subspan(first, last - first),
            counts);
    });
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].found())
            continue;
        result.hitting.push_back(i);
        result.surfaces.push_back(surface_at(scene, rays[i].ray, hits[i]));
    }
    return result;
}

RaySet ray_set(const std::string& name, const Scene& scene, const PrimaryHits& hits) {
    if (name == "primary")
        return hits.rays;
    if (name == "shadow")
        return shadow_rays(scene, hits);
    if (name == "mirror")
        return mirrored_rays(scene, hits);
    RaySet set = diffuse_rays(hits);
    set.name = name;
    if (name == "ao")
        set.question = Question::any;
    if (name == "shuffled")
        return shuffled(std::move(set));
    VERA_CHECK(name == "diffuse" || name == "ao");
    return set;
}

} // namespace vera
