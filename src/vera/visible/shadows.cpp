// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/shadows.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/math/box3.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/cells.h"
#include "vera/visible/closed_bodies.h"
#include "vera/visible/cut_polygon.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/light_views.h"
#include "vera/visible/vertex_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace vera {

namespace {

/// A face as what shadows fall on.
struct Receiver {
    /// Where it is on the screen, with some steps around it: shadows end there.
    ScreenPoint low = {screen_size, screen_size};
    ScreenPoint high = {0, 0};
    std::uint32_t largest = no_triangle; ///< of its triangles on the screen
    bool is_seen = false;
};

/// Of each face.
std::vector<Receiver>
receivers_of(const ScreenScene& screen, const VisiblePieces& seen, std::size_t faces) {
    // Beyond its sides, so that no crumb of the face is left lit between them and the shadow.
    constexpr std::int32_t around = 8;
    std::vector<Receiver> receivers(faces);
    std::vector<std::int64_t> areas(faces);
    for (std::uint32_t i = 0; i < screen.triangles.size(); ++i) {
        const std::uint32_t face = screen.triangles[i].source;
        Receiver& receiver = receivers[face];
        const auto corners = corners_of(screen, screen.triangles[i]);
        for (const ScreenVertex& corner : corners) {
            const ScreenPoint p = corner.point;
            receiver.low = {
                std::max(std::min(receiver.low.x, p.x - around), 0),
                std::max(std::min(receiver.low.y, p.y - around), 0)};
            receiver.high = {
                std::min(std::max(receiver.high.x, p.x + around), screen_size),
                std::min(std::max(receiver.high.y, p.y + around), screen_size)};
        }
        const std::int64_t area = orientation(corners[0].point, corners[1].point, corners[2].point);
        if (area > areas[face]) {
            areas[face] = area;
            receiver.largest = i;
        }
    }
    for (const VisiblePiece& piece : seen.pieces)
        for (const std::uint32_t triangle : {piece.left, piece.right})
            if (triangle != no_triangle)
                receivers[screen.triangles[triangle].source].is_seen = true;
    return receivers;
}

/// The plane of a face, whose normal is on the side of the light.
struct FacePlane {
    Vec3 point;
    Vec3 normal; ///< unit, or 0 of a face without an area

    double height(Vec3 p) const { return dot(normal, p - point); }
};

/// By the largest of its facets.
FacePlane plane_of(const ShadowedScene& shadowed, std::uint32_t face, std::uint32_t end_facet) {
    FacePlane plane;
    double largest = 0;
    for (std::uint32_t i = shadowed.faces.first_facet[face]; i < end_facet; ++i) {
        const auto corner = [&](std::size_t j) {
            return shadowed.facets.corners[shadowed.facets.triangles[i].corners[j]];
        };
        const Vec3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
        const double area = length(normal);
        if (area > largest) {
            largest = area;
            plane = {corner(0), normal / area};
        }
    }
    return plane;
}

/// How high over the plane the viewer is: of parallel rays only the sign tells.
double viewer_height(const Camera& camera, const FacePlane& plane) {
    return camera.projection == Camera::Projection::parallel ? -dot(plane.normal, camera.direction)
                                                             : plane.height(camera.viewpoint);
}

/// What is seen: the borders of it, each on the planes beside it, and a box of them.
struct SeenPlaces {
    std::vector<SeenSegment> segments;
    Box3 box;
};

SeenPlaces
seen_places(const ShadowedScene& shadowed, const ScreenScene& screen, const CancelFlag* cancel) {
    Box3 all;
    for (const Vec3& corner : shadowed.facets.corners)
        all = grown(all, corner);
    SeenPlaces seen;
    const LongLoop loop(shadowed.seen.pieces.size(), {}, cancel);
    for (std::size_t number = 0; number < shadowed.seen.pieces.size(); ++number) {
        loop.turn(number);
        const VisiblePiece& piece = shadowed.seen.pieces[number];
        for (const std::uint32_t triangle : {piece.left, piece.right}) {
            if (triangle == no_triangle)
                continue;
            const std::uint32_t face = screen.triangles[triangle].source;
            const std::uint32_t facet = shadowed.faces.first_facet[face];
            const FacePlane plane = plane_of(shadowed, face, facet + 1);
            SeenSegment segment;
            for (std::size_t i = 0; i < 2; ++i) {
                const RationalPoint& end = shadowed.seen.points[i == 0 ? piece.from : piece.to];
                const Ray ray =
                    view_ray(shadowed.camera, end.x() / screen_size, end.y() / screen_size);
                const Vec3 at =
                    point_at(ray, -plane.height(ray.origin) / dot(plane.normal, ray.direction));
                // Of a plane seen edge-on it may be anywhere; what is not finite leaves the box.
                segment.ends[i] = min(max(at, all.lower), all.upper);
                segment.pixels[i] =
                    shadowed.map.size_of_pixel(shadowed.width, shadowed.height, segment.ends[i]);
                seen.box = grown(seen.box, segment.ends[i]);
            }
            seen.segments.push_back(segment);
        }
    }
    const bool is_finite = std::isfinite(length(seen.box.upper - seen.box.lower));
    if (seen.box.empty() || !is_finite)
        seen.box = all;
    return seen;
}

/// A face on which shadows of a light may fall.
struct Receiving {
    std::uint32_t face = 0;
    FacePlane plane;
    double light_height = 0;
    /// What is no higher lies in the plane: within what the grid may have moved it.
    double flat = 0;
};

/// A facet that throws a shadow on a face, by their numbers.
struct Throw {
    std::uint32_t partly_lit = 0;
    std::uint32_t facet = 0;

    friend auto operator<=>(const Throw&, const Throw&) = default;
};

/// Whether the triangles have more than a side or corner in common, by the axes that could part
/// them.
bool overlap(const std::array<ScreenVertex, 3>& a, const std::array<ScreenVertex, 3>& b) {
    const auto is_parted_by_sides_of = [](const auto& one, const auto& other) {
        for (std::size_t i = 0; i < 3; ++i) {
            const ScreenPoint from = one[i].point;
            const ScreenPoint to = one[(i + 1) % 3].point;
            if (orientation(from, to, other[0].point) <= 0
                && orientation(from, to, other[1].point) <= 0
                && orientation(from, to, other[2].point) <= 0)
                return true;
        }
        return false;
    };
    return !is_parted_by_sides_of(a, b) && !is_parted_by_sides_of(b, a);
}

/// Adds the facets that the light sees where a triangle of its view lies, and that overlap it.
void add_throws(
    const LightView& view,
    const LitFacets& lit,
    std::uint32_t facet,
    const std::array<ScreenVertex, 3>& corners,
    std::uint32_t partly_lit,
    std::vector<Throw>& throws) {
    const std::size_t first = throws.size();
    for_each_cell_of(view.cells, corners, [&](std::size_t cell) {
        for (const std::uint32_t i : view.cells.triangles_of(cell)) {
            const ScreenTriangle& other = view.screen.triangles[i];
            if (other.source != facet && lit.is_seen(other.source)
                && overlap(corners, corners_of(view.screen, other)))
                throws.push_back({partly_lit, other.source});
        }
    });
    const auto begin = throws.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(begin, throws.end());
    throws.erase(std::unique(begin, throws.end()), throws.end());
}

/// The shadows of one light.
class LightShadows {
public:
    LightShadows(
        const ShadowedScene& shadowed,
        std::span<const Receiver> receivers,
        const SeenPlaces& seen,
        std::uint32_t light,
        ScreenScene& screen,
        const CancelFlag* cancel)
        : shadowed_(shadowed)
        , receivers_(receivers)
        , seen_(seen)
        , light_(light)
        , position_(shadowed.scene.lights[light].position)
        , screen_(screen)
        , memory_(screen)
        , cancel_(cancel) {}

    void add(const ClosedBodies& bodies, const Progress& progress, ShadowCounts& counts);

private:
    void find_turned();
    std::vector<std::uint32_t> facets_to_look_at(const ClosedBodies& bodies) const;
    void keep_partly_lit(const LitFacets& lit);
    std::vector<Throw> throws(const LightViews& views) const;
    std::vector<ImagePoint> shadow(const Throw& thrown) const;
    void
    add_to_screen(const Throw& thrown, std::span<const ImagePoint> shadow, VertexNumbers& numbers);

    /// How high the point is over the outer side of the facet, in some unit.
    double outer_height(std::uint32_t facet, Vec3 point) const {
        const auto& corners = shadowed_.facets.triangles[facet].corners;
        const auto corner = [&](std::size_t i) { return shadowed_.facets.corners[corners[i]]; };
        return dot(cross(corner(1) - corner(0), corner(2) - corner(0)), point - corner(0));
    }

    std::uint32_t end_facet(std::uint32_t face) const {
        const auto& first = shadowed_.faces.first_facet;
        return face + 1 < first.size()
            ? first[face + 1]
            : static_cast<std::uint32_t>(shadowed_.facets.triangles.size());
    }

    const ShadowedScene& shadowed_;
    std::span<const Receiver> receivers_;
    const SeenPlaces& seen_;
    std::uint32_t light_;
    Vec3 position_;
    ScreenScene& screen_;
    ShadowMemory memory_;
    const CancelFlag* cancel_;
    std::vector<Receiving> turned_; ///< to the light; then those that it reaches a part of
};

/// Finds the faces of which the viewer sees the side that is turned to the light: the lighting
/// formula gives nothing to the others.
void LightShadows::find_turned() {
    const LongLoop loop(receivers_.size(), {}, cancel_);
    for (std::uint32_t face = 0; face < receivers_.size(); ++face) {
        loop.turn(face);
        if (!receivers_[face].is_seen)
            continue;
        FacePlane plane = plane_of(shadowed_, face, end_facet(face));
        double light_height = plane.height(position_);
        double from_viewer = viewer_height(shadowed_.camera, plane);
        if (light_height < 0) {
            plane.normal = -plane.normal;
            light_height = -light_height;
            from_viewer = -from_viewer;
        }
        if (light_height > 0 && from_viewer > 0)
            turned_.push_back({face, plane, light_height, 0});
    }
}

/// The facets that the light's views are made of. From outside a closed body, what is seen behind a
/// facet that faces away from the light is behind one that faces it as well: between the light and
/// a place outside, a way goes out as often as it goes in.
std::vector<std::uint32_t> LightShadows::facets_to_look_at(const ClosedBodies& bodies) const {
    std::vector<std::uint8_t> is_turned(receivers_.size());
    for (const Receiving& receiving : turned_)
        is_turned[receiving.face] = 1;
    const bool is_parallel = shadowed_.camera.projection == Camera::Projection::parallel;
    std::vector<std::uint8_t> is_outside(bodies.boxes.size());
    for (std::size_t i = 0; i < is_outside.size(); ++i) {
        const Box3& box = bodies.boxes[i];
        is_outside[i] = !contains(box, position_)
            && (is_parallel || !contains(box, shadowed_.camera.viewpoint));
    }
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < bodies.of_facet.size(); ++i) {
        const std::uint32_t body = bodies.of_facet[i];
        const bool may_be_left_out =
            body != no_body && is_outside[body] != 0 && is_turned[shadowed_.faces.of_facet[i]] == 0;
        if (!may_be_left_out || outer_height(i, position_) >= 0)
            result.push_back(i);
    }
    return result;
}

/// Tells of which of the faces the light reaches nothing, and leaves those of which it does a part.
void LightShadows::keep_partly_lit(const LitFacets& lit) {
    std::erase_if(turned_, [&](Receiving& receiving) {
        const std::uint32_t face = receiving.face;
        bool all = true;
        bool any_shown = false;
        bool any_lit = false;
        double step = std::numeric_limits<double>::infinity();
        for (std::uint32_t i = shadowed_.faces.first_facet[face]; i < end_facet(face); ++i) {
            // What the light's views do not show is so small or near that nothing is before it.
            const bool is_shown = lit.is_shown(i) || !lit.is_opaque(i);
            any_shown = any_shown || is_shown;
            any_lit = any_lit || (is_shown && (lit.is_seen(i) || !lit.is_opaque(i)));
            all = all && (!is_shown || lit.is_wholly_seen(i));
            for (const std::uint32_t corner : shadowed_.facets.triangles[i].corners)
                step = std::min(
                    step,
                    shadowed_.map.size_of_pixel(
                        screen_size, screen_size, shadowed_.facets.corners[corner]));
        }
        receiving.flat = 0.25 * step;
        const bool is_unlit = any_shown && !any_lit;
        if (is_unlit)
            screen_.unlit[face] |= LightSet{1} << light_;
        return is_unlit || all;
    });
}

std::vector<Throw> LightShadows::throws(const LightViews& views) const {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::uint32_t> number(receivers_.size(), none);
    for (std::uint32_t i = 0; i < turned_.size(); ++i)
        number[turned_[i].face] = i;
    std::vector<Throw> result;
    std::mutex mutex;
    const auto add_all = [&](const LightView& view, const ScreenScene& of) {
        parallel_ranges(of.triangles.size(), 1024, [&](std::size_t first, std::size_t last) {
            std::vector<Throw> found;
            for (std::size_t i = first; i < last; ++i) {
                stop_if_raised(cancel_);
                const ScreenTriangle& triangle = of.triangles[i];
                const std::uint32_t partly_lit = number[shadowed_.faces.of_facet[triangle.source]];
                if (partly_lit != none)
                    add_throws(
                        view,
                        views.lit,
                        triangle.source,
                        corners_of(of, triangle),
                        partly_lit,
                        found);
            }
            const std::lock_guard lock(mutex);
            if (result.size() + found.size() > result.capacity())
                memory_.require(result.size() + found.size());
            result.insert(result.end(), found.begin(), found.end());
        });
    };
    for (const LightView& view : views.views) {
        add_all(view, view.screen);
        add_all(view, view.transparent);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

/// Where the facet's shadow lies on the face's plane, as the camera sees it, in the receiver's part
/// of the picture.
std::vector<ImagePoint> LightShadows::shadow(const Throw& thrown) const {
    const Receiving& on = turned_[thrown.partly_lit];
    const Facets::Triangle& facet = shadowed_.facets.triangles[thrown.facet];
    // Heights, by the light's, are kept in the points' depths.
    std::array<ImagePoint, 3> corners;
    bool stands_up = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 corner = shadowed_.facets.corners[facet.corners[i]];
        const double height = on.plane.height(corner);
        corners[i] = shadowed_.map.image_point(corner);
        corners[i].depth = std::abs(height) <= on.flat ? 0 : height / on.light_height;
        stands_up = stands_up || corners[i].depth > 0;
    }
    if (!stands_up)
        return {};
    CutPolygon polygon(corners);
    polygon.cut([](const ImagePoint& p) { return p.depth; }, [](ImagePoint& p) { p.depth = 0; });
    // What is as high as the light has its shadow infinitely far away.
    constexpr double highest = 1 - 0x1p-24;
    polygon.cut(
        [](const ImagePoint& p) { return highest - p.depth; },
        [](ImagePoint& p) { p.depth = highest; });
    // In homogeneous coordinates the projection from the light to the plane is p - height light.
    const ImagePoint light = shadowed_.map.image_point(position_);
    for (ImagePoint& p : polygon.points())
        p = {p.x - p.depth * light.x, p.y - p.depth * light.y, p.w - p.depth * light.w, 0};
    const Receiver& receiver = receivers_[on.face];
    const double left = static_cast<double>(receiver.low.x) / screen_size;
    const double right = static_cast<double>(receiver.high.x) / screen_size;
    const double low = 1 - static_cast<double>(receiver.high.y) / screen_size;
    const double high = 1 - static_cast<double>(receiver.low.y) / screen_size;
    polygon.cut(
        [&](const ImagePoint& p) { return p.x - left * p.w; },
        [&](ImagePoint& p) { p.x = left * p.w; });
    polygon.cut(
        [&](const ImagePoint& p) { return right * p.w - p.x; },
        [&](ImagePoint& p) { p.x = right * p.w; });
    polygon.cut(
        [&](const ImagePoint& p) { return p.y - low * p.w; },
        [&](ImagePoint& p) { p.y = low * p.w; });
    polygon.cut(
        [&](const ImagePoint& p) { return high * p.w - p.y; },
        [&](ImagePoint& p) { p.y = high * p.w; });
    const auto points = std::as_const(polygon).points();
    return {points.begin(), points.end()};
}

void LightShadows::add_to_screen(
    const Throw& thrown, std::span<const ImagePoint> shadow, VertexNumbers& numbers) {
    const std::uint32_t face = turned_[thrown.partly_lit].face;
    // A copy: triangles are added.
    const ScreenTriangle on = screen_.triangles[receivers_[face].largest];
    const NearnessSlope slope = nearness_slope(plane_of(screen_, on));
    const auto rounded = [](double value) { return std::floor(value + 0.5); };
    std::vector<std::uint32_t> vertices;
    for (const ImagePoint& p : shadow) {
        if (!(p.w > 0))
            return;
        const double x = std::clamp(rounded(p.x / p.w * screen_size), 0.0, 1.0 * screen_size);
        const double y = std::clamp(rounded((1 - p.y / p.w) * screen_size), 0.0, 1.0 * screen_size);
        const double nearness =
            std::clamp(std::ceil(slope.at({x, y})), 0.0, static_cast<double>(depth_size));
        vertices.push_back(numbers.number(
            {{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
             static_cast<std::int64_t>(nearness)}));
    }
    for (std::size_t i = 2; i < vertices.size(); ++i)
        add_part(screen_, {vertices[0], vertices[i - 1], vertices[i]}, on, light_);
}

void LightShadows::add(const ClosedBodies& bodies, const Progress& progress, ShadowCounts& counts) {
    StageProgress stages(progress, 4);
    find_turned();
    const LightViews views = light_views(
        shadowed_.scene,
        shadowed_.facets,
        facets_to_look_at(bodies),
        position_,
        seen_.box,
        seen_.segments,
        stages.next(3),
        cancel_);
    const Progress of_shadows = stages.next(1);
    counts.cut_nearness = std::max(counts.cut_nearness, views.cut_nearness);
    counts.light_step = std::max(counts.light_step, views.coarse_step);
    keep_partly_lit(views.lit);
    counts.partly_lit += turned_.size();
    const std::vector<Throw> thrown = throws(views);
    const std::size_t before = screen_.triangles.size();
    VertexNumbers numbers(screen_.vertices);
    constexpr std::size_t batch = 4096; // so that not all are kept twice
    std::vector<std::vector<ImagePoint>> shadows(std::min(batch, thrown.size()));
    const LongLoop loop(thrown.size(), of_shadows, cancel_, batch);
    for (std::size_t first = 0; first < thrown.size(); first += batch) {
        loop.turn(first);
        const std::size_t count = std::min(batch, thrown.size() - first);
        parallel_ranges(count, 256, [&](std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i)
                shadows[i] = shadow(thrown[first + i]);
        });
        for (std::size_t i = 0; i < count; ++i)
            add_to_screen(thrown[first + i], shadows[i], numbers);
    }
    counts.shadows += screen_.triangles.size() - before;
}

} // namespace

ShadowCounts add_shadows(
    const ShadowedScene& shadowed,
    ScreenScene& screen,
    const Progress& progress,
    const CancelFlag* cancel) {
    ShadowCounts counts;
    const std::size_t faces = shadowed.faces.first_facet.size();
    const std::vector<Receiver> receivers = receivers_of(screen, shadowed.seen, faces);
    const SeenPlaces seen = seen_places(shadowed, screen, cancel);
    const ClosedBodies bodies = closed_bodies(shadowed.facets);
    screen.unlit.assign(faces, 0);
    const std::size_t lights =
        std::min<std::size_t>(shadowed.scene.lights.size(), most_lights_of_a_set);
    for (std::uint32_t i = 0; i < lights; ++i)
        LightShadows(shadowed, receivers, seen, i, screen, cancel)
            .add(bodies, progress_part(progress, i, lights), counts);
    return counts;
}

} // namespace vera
