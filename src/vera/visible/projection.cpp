// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/projection.h"

#include "vera/base/diagnostic.h"
#include "vera/base/long_loop.h"
#include "vera/visible/cut_polygon.h"
#include "vera/visible/vertex_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

namespace vera {

namespace {

/// From what is nearest on, this part of the way is shown.
constexpr double nearest_part = 0x1p-16;

Affine3 map_of(Vec3 x, Vec3 y, Vec3 z, Vec3 origin) {
    Affine3 map;
    for (std::size_t axis = 0; axis < 3; ++axis)
        map.linear.rows[axis] = {x[axis], y[axis], z[axis]};
    map.translation = origin;
    return map;
}

/// What lies in the frame, and no nearer than w = nearest nor farther than w = farthest.
void cut_to_frame(CutPolygon& polygon, double nearest, double farthest) {
    if (std::isfinite(farthest))
        polygon.cut(
            [&](const ImagePoint& p) { return farthest - p.w; },
            [&](ImagePoint& p) { p.w = farthest; });
    polygon.cut(
        [&](const ImagePoint& p) { return p.w - nearest; }, [&](ImagePoint& p) { p.w = nearest; });
    polygon.cut([](const ImagePoint& p) { return p.x; }, [](ImagePoint& p) { p.x = 0; });
    polygon.cut([](const ImagePoint& p) { return p.w - p.x; }, [](ImagePoint& p) { p.x = p.w; });
    polygon.cut([](const ImagePoint& p) { return p.y; }, [](ImagePoint& p) { p.y = 0; });
    polygon.cut([](const ImagePoint& p) { return p.w - p.y; }, [](ImagePoint& p) { p.y = p.w; });
}

bool is_in_frame(const ImagePoint& p) {
    return p.w > 0 && p.x >= 0 && p.x <= p.w && p.y >= 0 && p.y <= p.w;
}

bool is_finite(const ImagePoint& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.w) && std::isfinite(p.depth);
}

bool are_all_outside(const std::array<ImagePoint, 3>& corners) {
    const auto all = [&](const auto& outside) {
        return std::all_of(corners.begin(), corners.end(), outside);
    };
    return all([](const ImagePoint& p) { return p.w <= 0; })
        || all([](const ImagePoint& p) { return p.x < 0; })
        || all([](const ImagePoint& p) { return p.x > p.w; })
        || all([](const ImagePoint& p) { return p.y < 0; })
        || all([](const ImagePoint& p) { return p.y > p.w; });
}

/// From where to where what is seen reaches.
struct DepthRange {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();

    void include(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

/// Moves points to the grid.
struct Snap {
    bool is_parallel = false;
    DepthRange range;

    static double rounded(double value) { return std::floor(value + 0.5); }

    ScreenVertex vertex(const ImagePoint& p) const {
        // From the nearest to the farthest. Of perspective, what is affine in the picture is 1 / w.
        // Through a very long lens that is hardly different, and rounding is not to be blown up.
        constexpr double least_span = 0x1p-22;
        double nearness = 1;
        if (range.most > range.least)
            nearness = is_parallel
                ? (range.most - p.depth) / (range.most - range.least)
                : (range.most / p.w - 1) / std::max(range.most / range.least - 1, least_span);
        return {
            {static_cast<std::int32_t>(rounded(p.x / p.w * screen_size)),
             static_cast<std::int32_t>(rounded((1 - p.y / p.w) * screen_size))},
            static_cast<std::int64_t>(
                rounded(std::clamp(nearness, 0.0, 1.0) * static_cast<double>(depth_size)))};
    }
};

/// Calls visit(points) for what of the facet is seen: its own three corners, or those that cutting
/// left.
template <typename Visit>
void for_visible_part(
    const std::array<ImagePoint, 3>& corners, double nearest, double farthest, const Visit& visit) {
    // What overflowed lies beyond anything that a picture shows.
    if (are_all_outside(corners) || !std::all_of(corners.begin(), corners.end(), is_finite))
        return;
    const bool is_whole = std::all_of(corners.begin(), corners.end(), [&](const ImagePoint& p) {
        return is_in_frame(p) && p.w >= nearest && p.w <= farthest;
    });
    if (is_whole)
        return visit(std::span<const ImagePoint>(corners));
    CutPolygon polygon(corners);
    cut_to_frame(polygon, nearest, farthest);
    visit(polygon.points());
}

} // namespace

CameraMap::CameraMap(const Camera& camera)
    : is_parallel_(camera.projection == Camera::Projection::parallel) {
    const ViewRays rays(camera);
    width_ = length(rays.across);
    height_ = length(rays.up);
    const Vec3 view = is_parallel_ ? rays.origin_or_direction : rays.corner;
    const double distance = length(view);
    // By unit vectors: what is seen through a long lens is a narrow picture far away.
    auto from_world = inverse(map_of(
        normalized(rays.across),
        normalized(rays.up),
        normalized(view),
        is_parallel_ ? rays.corner : rays.origin_or_direction));
    if (!from_world) {
        Diagnostic problem;
        problem.problem = "the camera sees its image plane edge-on";
        problem.remedy =
            "let the three corners of the picture span a plane, and the view not lie in it";
        throw InputError({problem});
    }
    const Vec3 sizes = {width_, height_, distance};
    Vec3& translation = from_world->translation;
    for (std::size_t axis = 0; axis < 3; ++axis)
        from_world->linear.rows[axis] = from_world->linear.rows[axis] / sizes[axis];
    translation = {translation.x / sizes.x, translation.y / sizes.y, translation.z / sizes.z};
    from_world_ = *from_world;
}

ImagePoint CameraMap::image_point(Vec3 point) const {
    const Vec3 p = transformed_point(from_world_, point);
    return is_parallel_ ? ImagePoint{p.x, p.y, 1, p.z} : ImagePoint{p.x, p.y, p.z, 0};
}

double CameraMap::size_of_pixel(double columns, double rows, Vec3 point) const {
    const double w = image_point(point).w;
    if (!(w > 0))
        return std::numeric_limits<double>::infinity();
    return std::min(width_ / columns, height_ / rows) * std::max(w, nearest_part);
}

ScreenScene screen_scene(
    const Facets& facets,
    const CameraMap& map,
    std::span<const std::uint32_t> sources,
    double most_far,
    const CancelFlag* cancel) {
    std::vector<ImagePoint> points(facets.corners.size());
    parallel_ranges(points.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t i = first; i < last; ++i)
            points[i] = map.image_point(facets.corners[i]);
    });
    const auto corners_of_facet = [&](const Facets::Triangle& facet) {
        return std::array<ImagePoint, 3>{
            points[facet.corners[0]], points[facet.corners[1]], points[facet.corners[2]]};
    };
    // What is so near that the rest would shrink to nothing is cut away.
    double farthest = 0;
    for (const ImagePoint& point : points)
        if (is_finite(point))
            farthest = std::max(farthest, std::min(point.w, most_far));
    Snap snap = {map.is_parallel(), {}};
    const double tiny = farthest * 0x1p-40;
    const LongLoop loop(facets.triangles.size(), {}, cancel);
    for (std::size_t i = 0; i < facets.triangles.size(); ++i) {
        loop.turn(i);
        for_visible_part(
            corners_of_facet(facets.triangles[i]),
            tiny,
            most_far,
            [&](std::span<const ImagePoint> part) {
                for (const ImagePoint& point : part)
                    snap.range.include(map.is_parallel() ? point.depth : point.w);
            });
    }
    ScreenScene scene;
    if (!map.is_parallel() && snap.range.least < nearest_part * snap.range.most) {
        snap.range.least = nearest_part * snap.range.most;
        scene.cut_nearness = snap.range.least;
    }
    const double nearest = map.is_parallel() ? 0 : snap.range.least;

    VertexNumbers numbers(scene.vertices);
    for (std::size_t i = 0; i < facets.triangles.size(); ++i) {
        loop.turn(i);
        for_visible_part(
            corners_of_facet(facets.triangles[i]),
            nearest,
            most_far,
            [&](std::span<const ImagePoint> part) {
                if (part.size() < 3)
                    return;
                const std::uint32_t first = numbers.number(snap.vertex(part[0]));
                std::uint32_t last = numbers.number(snap.vertex(part[1]));
                for (std::size_t j = 2; j < part.size(); ++j) {
                    const std::uint32_t next = numbers.number(snap.vertex(part[j]));
                    add_triangle(scene, {first, last, next}, sources[i]);
                    last = next;
                }
            });
    }
    return scene;
}

} // namespace vera
