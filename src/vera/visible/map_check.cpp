// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/map_check.h"

#include "vera/accel/primitive_hit.h"
#include "vera/base/long_loop.h"
#include "vera/base/random.h"
#include "vera/scene/crossings.h"
#include "vera/scene/surface.h"
#include "vera/visible/map_locator.h"
#include "vera/visible/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>

namespace vera {

namespace {

/// How far, in pixels, what is exact may be off: 16 steps of the grid in a picture of 4096 pixels,
/// 128 in one of 512.
constexpr double exact_reach = 1.0 / 64;

/// What all points are compared by.
struct Comparison {
    const PrimitiveMap& drawn;
    const Scene& scene;
    const CameraMap camera_map;
    const ViewRays view_rays;
    const RayIndex& index;
    const MapCheckSettings& settings;
    const MapLocator locator;
};

/// Number i of those that cover the picture, as parts of its width and height.
std::array<double, 2> point_number(std::uint64_t i) {
    const auto part = [&](std::uint64_t axis) {
        return static_cast<double>(random(0, i, axis) >> 11U) * 0x1p-53;
    };
    return {part(0), part(1)};
}

/// Through that point, from where on the map shows things.
QueryRay ray_through(const Comparison& all, double x, double y) {
    QueryRay query;
    query.ray = all.view_rays.ray(x, y);
    if (all.drawn.cut_nearness > 0)
        query.ray.t_min =
            all.drawn.cut_nearness / all.camera_map.image_point(point_at(query.ray, 1)).w;
    return query;
}

bool is_curved(const Scene& scene, std::uint64_t primitive) {
    if (primitive == no_primitive)
        return false;
    const PrimitivePath path = path_to(scene, primitive);
    const ItemKind kind = path.geometry->items[path.element.item].kind;
    return kind == ItemKind::sphere || kind == ItemKind::rotational_shape;
}

bool is_of_source(const Comparison& all, std::uint32_t source, std::uint64_t primitive) {
    const auto& joined = all.drawn.joined;
    return all.drawn.primitives[source] == primitive
        || std::binary_search(joined.begin(), joined.end(), JoinedPrimitive{source, primitive});
}

/// Where the ray meets one of the source's primitives soon behind what it meets first; not found
/// where it takes long to come there. What is drawn in place of that lies closely behind it.
Hit hit_soon_behind(
    const Comparison& all,
    const Ray& ray,
    std::uint32_t source,
    const Hit& traced,
    QueryCounts& counts) {
    constexpr int most_steps = 8;
    std::array<QueryRay, 1> query = {QueryRay{ray, traced.face}};
    query[0].ray.t_min = std::max(ray.t_min, traced.t - coincidence_tolerance(ray, traced.t));
    for (int i = 0; i < most_steps; ++i) {
        std::array<Hit, 1> next;
        all.index.nearest_hits(query, next, counts);
        if (!next[0].found() || is_of_source(all, source, next[0].face.primitive))
            return next[0];
        query[0].start = next[0].face;
        query[0].ray.t_min = next[0].t;
    }
    return {};
}

/// Where the ray first meets what the map shows: any of the source's primitives. A plane face may
/// have a million, so that they are asked one by one only where there are few or nothing else
/// helps.
Hit hit_of_source(
    const Comparison& all,
    const Ray& ray,
    std::uint32_t source,
    const Hit& traced,
    QueryCounts& counts,
    std::uint64_t& asked) {
    if (source == no_source)
        return {};
    const auto& joined = all.drawn.joined;
    auto other = std::lower_bound(joined.begin(), joined.end(), JoinedPrimitive{source, 0});
    const auto end = std::upper_bound(
        other, joined.end(), JoinedPrimitive{source, std::numeric_limits<std::uint64_t>::max()});
    constexpr std::ptrdiff_t few = 16;
    if (traced.found() && end - other > few)
        if (const Hit hit = hit_soon_behind(all, ray, source, traced, counts); hit.found())
            return hit;
    Hit nearest = primitive_hit(all.scene, ray, all.drawn.primitives[source]);
    asked += 1 + static_cast<std::uint64_t>(end - other);
    for (; other != end; ++other)
        if (const Hit hit = primitive_hit(all.scene, ray, other->primitive); hit.t < nearest.t)
            nearest = hit;
    return nearest;
}

/// How far the two surfaces are from each other where the ray meets them, across the one that it
/// meets more steeply; infinite where it meets one of them alone.
double gap(const Scene& scene, const Ray& ray, const Hit& traced, const Hit& drawn) {
    if (!traced.found() || !drawn.found())
        return std::numeric_limits<double>::infinity();
    const auto across = [&](const Hit& hit) {
        return std::abs(dot(surface_at(scene, ray, hit).geometric_normal, ray.direction));
    };
    return std::abs(drawn.t - traced.t) * std::min(across(traced), across(drawn));
}

/// Whether the grid and the facets explain the difference.
bool is_explained(
    const Comparison& all,
    const MapDifference& difference,
    std::uint32_t source,
    const Ray& ray,
    const Hit& traced,
    QueryCounts& counts,
    std::uint64_t& asked) {
    const MapCheckSettings& settings = all.settings;
    const bool has_facets =
        is_curved(all.scene, difference.drawn) || is_curved(all.scene, difference.traced);
    const double reach = exact_reach + (has_facets ? settings.deviation : 0);
    const double steps_across = screen_size / settings.width;
    const double steps_down = screen_size / settings.height;
    if (all.locator.has_side_near(
            difference.x * steps_across,
            difference.y * steps_down,
            reach * steps_across,
            reach * steps_down))
        return true;
    if (!difference.is_sound)
        return false;
    const double apart =
        gap(all.scene, ray, traced, hit_of_source(all, ray, source, traced, counts, asked));
    if (!std::isfinite(apart))
        return false;
    const double pixel =
        all.camera_map.size_of_pixel(settings.width, settings.height, point_at(ray, traced.t));
    return apart <= reach * pixel;
}

/// What the map shows where it shows the source: the one of its primitives that the ray met, if
/// that is one of them.
std::uint64_t primitive_at(const Comparison& all, std::uint32_t source, std::uint64_t traced) {
    if (source == no_source)
        return no_primitive;
    const auto& joined = all.drawn.joined;
    return std::binary_search(joined.begin(), joined.end(), JoinedPrimitive{source, traced})
        ? traced
        : all.drawn.primitives[source];
}

void compare(const Comparison& all, std::uint64_t number, QueryCounts& counts, MapCheck& result) {
    ++result.points;
    const auto [x, y] = point_number(number);
    const std::array<QueryRay, 1> ray = {ray_through(all, x, y)};
    std::array<Hit, 1> traced;
    all.index.nearest_hits(ray, traced, counts);
    const MapPlace shown = all.locator.at(x * screen_size, y * screen_size);
    const MapDifference difference = {
        x * all.settings.width,
        y * all.settings.height,
        primitive_at(all, shown.source, traced[0].face.primitive),
        traced[0].face.primitive,
        shown.is_sound};
    if (shown.is_sound && difference.drawn == difference.traced)
        return;
    if (is_explained(all, difference, shown.source, ray[0].ray, traced[0], counts, result.asked)) {
        ++result.near;
        return;
    }
    ++result.far;
    if (!result.first_far)
        result.first_far = difference;
}

} // namespace

MapCheck check_map(
    const PrimitiveMap& drawn,
    const Scene& scene,
    const Camera& camera,
    const RayIndex& index,
    const MapCheckSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    constexpr std::size_t part = 256; // points
    const Comparison all = {
        drawn,
        scene,
        CameraMap(camera),
        ViewRays(camera),
        index,
        settings,
        MapLocator(drawn.map, cancel)};
    std::mutex mutex;
    std::size_t done = 0;
    std::vector<MapCheck> parts((settings.points + part - 1) / part);
    parallel_ranges(parts.size(), 1, [&](std::size_t first, std::size_t last) {
        QueryCounts counts;
        for (std::size_t i = first; i < last; ++i) {
            const std::size_t end = std::min(settings.points, (i + 1) * part);
            for (std::size_t point = i * part; point < end; ++point) {
                stop_if_raised(cancel); // what shows a face of many primitives may take long
                compare(all, point, counts, parts[i]);
            }
        }
        const std::lock_guard lock(mutex);
        done += last - first;
        if (progress)
            progress(static_cast<double>(done) / static_cast<double>(parts.size()));
    });
    MapCheck result;
    for (const MapCheck& of_part : parts) {
        result.points += of_part.points;
        result.near += of_part.near;
        result.far += of_part.far;
        result.asked += of_part.asked;
        if (!result.first_far)
            result.first_far = of_part.first_far;
    }
    return result;
}

} // namespace vera
