// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/projection.h"

#include "vera/base/diagnostic.h"
#include "vera/base/long_loop.h"
#include "vera/visible/cut_polygon.h"
#include "vera/visible/first_equal.h"
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

constexpr std::size_t block = 4096; ///< facets, corners or triangles that a thread takes at a time

/// What is seen of facets.
class VisibleParts {
public:
    VisibleParts(
        const Facets& facets, const CameraMap& map, double most_far, const CancelFlag* cancel)
        : facets_(facets)
        , is_parallel_(map.is_parallel())
        , most_far_(most_far)
        , cancel_(cancel)
        , points_(facets.corners.size()) {
        parallel_ranges(points_.size(), block, [&](std::size_t first, std::size_t last) {
            stop_if_raised(cancel_);
            for (std::size_t i = first; i < last; ++i)
                points_[i] = map.image_point(facets_.corners[i]);
        });
    }

    DepthRange depths() const;

    /// Adds triangles that part them in fans, with the sources of the facets; returns the corners,
    /// by whose places in the result the triangles name them.
    std::vector<ScreenVertex> fans(
        double nearest,
        const Snap& snap,
        std::span<const std::uint32_t> sources,
        std::vector<ScreenTriangle>& triangles) const;

private:
    std::size_t blocks() const { return (facets_.triangles.size() + block - 1) / block; }

    /// Calls visit(facet, points) for those of a block that are seen.
    template <typename Visit>
    void for_each(std::size_t number, double nearest, const Visit& visit) const {
        stop_if_raised(cancel_);
        const std::size_t end = std::min(facets_.triangles.size(), (number + 1) * block);
        for (std::size_t i = number * block; i < end; ++i) {
            const std::array<std::uint32_t, 3>& corners = facets_.triangles[i].corners;
            for_visible_part(
                {points_[corners[0]], points_[corners[1]], points_[corners[2]]},
                nearest,
                most_far_,
                [&](std::span<const ImagePoint> part) {
                    if (part.size() >= 3)
                        visit(i, part);
                });
        }
    }

    const Facets& facets_;
    bool is_parallel_;
    double most_far_;
    const CancelFlag* cancel_;
    std::vector<ImagePoint> points_; ///< of the facets' corners
};

DepthRange VisibleParts::depths() const {
    // What is so near that the rest would shrink to nothing is cut away.
    double farthest = 0;
    for (const ImagePoint& point : points_)
        if (is_finite(point))
            farthest = std::max(farthest, std::min(point.w, most_far_));
    std::vector<DepthRange> of_blocks(blocks());
    parallel_ranges(blocks(), 1, [&](std::size_t number, std::size_t) {
        for_each(number, farthest * 0x1p-40, [&](std::size_t, std::span<const ImagePoint> part) {
            for (const ImagePoint& point : part)
                of_blocks[number].include(is_parallel_ ? point.depth : point.w);
        });
    });
    DepthRange range;
    for (const DepthRange& of_block : of_blocks) {
        range.least = std::min(range.least, of_block.least);
        range.most = std::max(range.most, of_block.most);
    }
    return range;
}

std::vector<ScreenVertex> VisibleParts::fans(
    double nearest,
    const Snap& snap,
    std::span<const std::uint32_t> sources,
    std::vector<ScreenTriangle>& triangles) const {
    struct Start {
        std::size_t corner = 0;
        std::size_t triangle = 0;
    };

    std::vector<Start> starts(blocks() + 1);
    starts[0].triangle = triangles.size();
    parallel_ranges(blocks(), 1, [&](std::size_t number, std::size_t) {
        for_each(number, nearest, [&](std::size_t, std::span<const ImagePoint> part) {
            starts[number + 1].corner += part.size();
            starts[number + 1].triangle += part.size() - 2;
        });
    });
    for (std::size_t i = 1; i < starts.size(); ++i) {
        starts[i].corner += starts[i - 1].corner;
        starts[i].triangle += starts[i - 1].triangle;
    }
    std::vector<ScreenVertex> corners(starts.back().corner);
    triangles.resize(starts.back().triangle);
    parallel_ranges(blocks(), 1, [&](std::size_t number, std::size_t) {
        std::size_t corner = starts[number].corner;
        std::size_t triangle = starts[number].triangle;
        for_each(number, nearest, [&](std::size_t facet, std::span<const ImagePoint> part) {
            const auto first = static_cast<std::uint32_t>(corner);
            for (const ImagePoint& point : part)
                corners[corner++] = snap.vertex(point);
            for (std::uint32_t i = 2; i < part.size(); ++i)
                triangles[triangle++] = {{first, first + i - 1, first + i}, sources[facet]};
        });
    });
    return corners;
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
    if (!is_parallel_) {
        viewpoint_ = rays.origin_or_direction;
        farthest_corner_ = std::max(
            {distance,
             length(rays.corner + rays.across),
             length(rays.corner + rays.up),
             length(rays.corner + rays.across + rays.up)});
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

double CameraMap::size_of_pixel_around(double columns, double rows, Vec3 point) const {
    const double pixel = std::min(width_ / columns, height_ / rows);
    // What moves across a ray that meets the image plane at a slant moves farther there, by the
    // cosine.
    if (is_parallel_)
        return pixel * unit_depth();
    const double distance = length(point - viewpoint_);
    if (!(distance > 0))
        return pixel * nearest_part;
    // In the picture w is the larger one: a point of the image plane is no farther than the corner.
    const double part = std::max(image_point(point).w, distance / farthest_corner_);
    const double cosine = part * unit_depth() / distance;
    return pixel * std::max(part * cosine, nearest_part);
}

double CameraMap::way_behind(Vec3 point) const {
    return std::max(0.0, -image_point(point).w * unit_depth());
}

double CameraMap::unit_depth() const {
    return 1 / length(from_world_.linear.rows[2]);
}

Deviation deviation_in_pixels(
    const CameraMap& map, double columns, double rows, double pixels, FacetReach reach) {
    return [=, &map](Vec3 point) {
        const double in_pixels = pixels * map.size_of_pixel_around(columns, rows, point);
        return reach == FacetReach::seen ? std::max(in_pixels, map.way_behind(point)) : in_pixels;
    };
}

ScreenScene screen_scene(
    const Facets& facets,
    const CameraMap& map,
    std::span<const std::uint32_t> sources,
    double most_far,
    const CancelFlag* cancel) {
    const VisibleParts parts(facets, map, most_far, cancel);
    Snap snap = {map.is_parallel(), parts.depths()};
    ScreenScene scene;
    if (!map.is_parallel() && snap.range.least < nearest_part * snap.range.most) {
        snap.range.least = nearest_part * snap.range.most;
        scene.cut_nearness = snap.range.least;
    }
    const double nearest = map.is_parallel() ? 0 : snap.range.least;
    std::vector<ScreenVertex> corners = parts.fans(nearest, snap, sources, scene.triangles);
    UnfilledVector<std::uint32_t> numbers = first_equal(
        corners.size(),
        [&](std::size_t i) { return hash_of(corners[i]); },
        [&](std::size_t i, std::size_t j) { return corners[i] == corners[j]; },
        cancel);
    const std::vector<std::uint32_t> firsts = number_consecutively(numbers);
    scene.vertices.resize(firsts.size());
    constexpr std::size_t many = 4 * block; // for fewer to wake another thread takes longer
    parallel_ranges(firsts.size(), many, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            scene.vertices[i] = corners[firsts[i]];
    });
    parallel_ranges(scene.triangles.size(), many, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            for (std::uint32_t& vertex : scene.triangles[i].vertices)
                vertex = numbers[vertex];
    });
    stop_if_raised(cancel);
    turn_to_left(scene);
    return scene;
}

} // namespace vera
