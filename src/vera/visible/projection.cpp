// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/projection.h"

#include "vera/base/diagnostic.h"

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

/// A polygon that is cut side by side.
class CutPolygon {
public:
    explicit CutPolygon(const std::array<ImagePoint, 3>& corners) {
        for (const ImagePoint& corner : corners)
            points_[count_++] = corner;
    }

    /// Leaves where inside(point), which is affine, is not negative. adjust(point) is called for
    /// new points, on which it is 0.
    template <typename Inside, typename Adjust>
    void cut(const Inside& inside, const Adjust& adjust) {
        const std::array<ImagePoint, most> from = points_;
        const std::size_t count = count_;
        count_ = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const ImagePoint& here = from[i];
            const ImagePoint& next = from[i + 1 == count ? 0 : i + 1];
            const double at_here = inside(here);
            const double at_next = inside(next);
            if (at_here >= 0)
                add(here);
            if ((at_here > 0 && at_next < 0) || (at_here < 0 && at_next > 0)) {
                ImagePoint point = between(here, next, at_here, at_next);
                adjust(point);
                add(point);
            }
        }
    }

    std::span<const ImagePoint> points() const { return std::span(points_).first(count_); }

private:
    // Each of five cuts adds one point at most; rounding may add another.
    static constexpr std::size_t most = 13;

    void add(const ImagePoint& point) {
        if (count_ < most)
            points_[count_++] = point;
    }

    /// The same to the bit from either end, so that faces that share a side share its cuts.
    static ImagePoint between(ImagePoint a, ImagePoint b, double at_a, double at_b) {
        if (std::tie(b.x, b.y, b.w, b.depth) < std::tie(a.x, a.y, a.w, a.depth)) {
            std::swap(a, b);
            std::swap(at_a, at_b);
        }
        const double part = at_a / (at_a - at_b);
        const auto mixed = [&](double from, double to) { return from + part * (to - from); };
        return {mixed(a.x, b.x), mixed(a.y, b.y), mixed(a.w, b.w), mixed(a.depth, b.depth)};
    }

    std::array<ImagePoint, most> points_ = {};
    std::size_t count_ = 0;
};

/// What lies in the frame, and no nearer than w = nearest.
void cut_to_frame(CutPolygon& polygon, double nearest) {
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

/// Numbers vertices, equal ones alike.
class VertexNumbers {
public:
    explicit VertexNumbers(std::vector<ScreenVertex>& vertices)
        : vertices_(vertices)
        , places_(1024, none) {}

    std::uint32_t number(const ScreenVertex& vertex) {
        if (2 * vertices_.size() >= places_.size())
            grow();
        const std::size_t place = place_of(vertex);
        if (places_[place] == none) {
            places_[place] = static_cast<std::uint32_t>(vertices_.size());
            vertices_.push_back(vertex);
        }
        return places_[place];
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    std::size_t place_of(const ScreenVertex& vertex) const {
        std::uint64_t hash = static_cast<std::uint64_t>(vertex.point.x) << 32U
            | static_cast<std::uint32_t>(vertex.point.y);
        hash = (hash ^ hash >> 29U) * 0x9e3779b97f4a7c15U;
        hash = (hash ^ static_cast<std::uint64_t>(vertex.nearness)) * 0xbf58476d1ce4e5b9U;
        std::size_t place = (hash ^ hash >> 32U) & (places_.size() - 1);
        while (places_[place] != none && vertices_[places_[place]] != vertex)
            place = (place + 1) & (places_.size() - 1);
        return place;
    }

    void grow() {
        places_.assign(2 * places_.size(), none);
        for (std::uint32_t i = 0; i < vertices_.size(); ++i)
            places_[place_of(vertices_[i])] = i;
    }

    std::vector<ScreenVertex>& vertices_;
    std::vector<std::uint32_t> places_;
};

/// Moves points to the grid.
struct Snap {
    bool is_parallel = false;
    DepthRange range;

    static double rounded(double value) { return std::floor(value + 0.5); }

    ScreenVertex vertex(const ImagePoint& p) const {
        const double nearness = is_parallel
            ? (range.most > range.least ? (range.most - p.depth) / (range.most - range.least) : 1)
            : range.least / p.w;
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
    const std::array<ImagePoint, 3>& corners, double nearest, const Visit& visit) {
    // What overflowed lies beyond anything that a picture shows.
    if (are_all_outside(corners) || !std::all_of(corners.begin(), corners.end(), is_finite))
        return;
    const bool is_whole = std::all_of(corners.begin(), corners.end(), [&](const ImagePoint& p) {
        return is_in_frame(p) && p.w >= nearest;
    });
    if (is_whole)
        return visit(std::span<const ImagePoint>(corners));
    CutPolygon polygon(corners);
    cut_to_frame(polygon, nearest);
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

ScreenScene
screen_scene(const Facets& facets, const CameraMap& map, std::span<const std::uint32_t> sources) {
    std::vector<ImagePoint> points(facets.corners.size());
    parallel_ranges(points.size(), 4096, [&](std::size_t first, std::size_t last) {
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
            farthest = std::max(farthest, point.w);
    Snap snap = {map.is_parallel(), {}};
    const double tiny = farthest * 0x1p-40;
    for (const Facets::Triangle& facet : facets.triangles)
        for_visible_part(corners_of_facet(facet), tiny, [&](std::span<const ImagePoint> part) {
            for (const ImagePoint& point : part)
                snap.range.include(map.is_parallel() ? point.depth : point.w);
        });
    ScreenScene scene;
    if (!map.is_parallel() && snap.range.least < nearest_part * snap.range.most) {
        snap.range.least = nearest_part * snap.range.most;
        scene.cut_nearness = snap.range.least;
    }
    const double nearest = map.is_parallel() ? 0 : snap.range.least;

    VertexNumbers numbers(scene.vertices);
    for (std::size_t i = 0; i < facets.triangles.size(); ++i)
        for_visible_part(
            corners_of_facet(facets.triangles[i]), nearest, [&](std::span<const ImagePoint> part) {
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
    return scene;
}

} // namespace vera
