// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/framing.h"

#include "vera/base/diagnostic.h"
#include "vera/math/elementary.h"
#include "vera/scene/bounds.h"
#include "vera/scene/support.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vera {

namespace {

[[noreturn]] void refuse(const Scene& scene, const char* problem, const char* remedy) {
    Diagnostic diagnostic;
    if (!scene.files.empty())
        diagnostic.place.file = scene.files.front();
    diagnostic.problem = problem;
    diagnostic.remedy = remedy;
    throw InputError({diagnostic});
}

/// A support iteration converges faster than quadratically on smooth scenes and in finitely many
/// steps on polyhedral ones; this many are never needed.
constexpr int most_steps = 100;

void refuse_empty(const Scene& scene, const SceneSupport& support) {
    if (support.bounds().empty())
        refuse(scene, "the scene holds nothing that could be framed", "add some geometry");
}

double picture_aspect(const FrameSettings& frame) {
    return static_cast<double>(frame.width) * frame.pixel_aspect
        / static_cast<double>(frame.height);
}

/// Where a point lies in coordinates across, up and along the view, from the view point.
struct ViewBasis {
    Vec3 right;
    Vec3 up;
    Vec3 forward;
};

/// The default view: 30 degrees to the right, 20 above.
ViewBasis three_quarter_view() {
    const double across = cos_degrees(20);
    const Vec3 forward =
        normalized({-sin_degrees(30) * across, -sin_degrees(20), -cos_degrees(30) * across});
    const Vec3 right = normalized(cross(forward, {0, 1, 0}));
    return {right, cross(right, forward), forward};
}

/// Two planes through the view point, with the slope to either side, that touch the scene: the
/// point where they meet, in coordinates `side` and along the view.
struct Wedge {
    double side = 0;
    double depth = 0;
};

Wedge touching_wedge(const SceneSupport& support, Vec3 side, Vec3 forward, double slope) {
    const auto reach = [&](Vec3 normal) { return dot(*support.farthest_point(normal), normal); };
    const double ahead = reach(side - slope * forward);
    const double behind = reach(-side - slope * forward);
    return {0.5 * (ahead - behind), -(ahead + behind) / (2 * slope)};
}

/// The place `side` from which, at this depth, the scene reaches equally far to both sides.
double
centered_side(const SceneSupport& support, Vec3 side, Vec3 forward, double slope, double depth) {
    double center = 0;
    // The slope of the wedge that touches the scene and has its point at the depth: Dinkelbach's
    // iteration on the sum of the two sides, which falls as the slope grows.
    for (int step = 0; step < most_steps; ++step) {
        const Vec3 ahead = *support.farthest_point(side - slope * forward);
        const Vec3 behind = *support.farthest_point(-side - slope * forward);
        center = 0.5 * (dot(ahead, side - slope * forward) + dot(behind, side + slope * forward));
        const double depths = (dot(ahead, forward) - depth) + (dot(behind, forward) - depth);
        const double better = (dot(ahead, side) - dot(behind, side)) / depths;
        const bool done = std::abs(better - slope) <= 0x1p-50 * std::abs(slope);
        slope = better;
        if (done)
            break;
    }
    return center;
}

/// A linear coordinate of a point in the image plane, as a function of what is seen there:
/// shift + (numerator . p') / (denominator . p'), with p' = p - viewpoint; in parallel projection
/// the denominator is 1.
struct PlaneCoordinate {
    Vec3 numerator;
    double shift = 0;
};

struct Interval {
    double first = 0;
    double last = 0;
};

Interval parallel_extent(const SceneSupport& support, const PlaneCoordinate& coordinate) {
    const auto value = [&](Vec3 direction) {
        return dot(*support.farthest_point(direction), coordinate.numerator) + coordinate.shift;
    };
    return {value(-coordinate.numerator), value(coordinate.numerator)};
}

/// The largest (numerator . p') / (denominator . p') of the scene: from a point's quotient on to
/// that of the point that is farthest beyond it, until none is (Dinkelbach 1967).
double
largest_quotient(const SceneSupport& support, Vec3 viewpoint, Vec3 numerator, Vec3 denominator) {
    const auto quotient = [&](Vec3 point) {
        const Vec3 seen = point - viewpoint;
        return dot(numerator, seen) / dot(denominator, seen);
    };
    double best = quotient(*support.farthest_point(numerator));
    for (int step = 0; step < most_steps; ++step) {
        const double next = quotient(*support.farthest_point(numerator - best * denominator));
        if (!(next > best))
            break;
        best = next;
    }
    return best;
}

Interval perspective_extent(
    const SceneSupport& support,
    Vec3 viewpoint,
    const PlaneCoordinate& coordinate,
    Vec3 denominator) {
    const Vec3 numerator = coordinate.numerator;
    return {
        coordinate.shift - largest_quotient(support, viewpoint, -numerator, denominator),
        coordinate.shift + largest_quotient(support, viewpoint, numerator, denominator)};
}

void refuse_what_is_behind(
    const Scene& scene, const SceneSupport& support, Vec3 viewpoint, Vec3 forward) {
    const Vec3 nearest = *support.farthest_point(-forward);
    const Vec3 farthest = *support.farthest_point(forward);
    const double nearest_depth = dot(nearest - viewpoint, forward);
    if (dot(farthest - viewpoint, forward) <= 0)
        refuse(
            scene,
            "all of the scene lies behind the view point",
            "turn the image plane of PROJECTION to the other side of the view point");
    // What passes the view point sideways has no end in the image plane.
    const double size = max_component(abs(viewpoint)) + length(extent(support.bounds()));
    if (nearest_depth <= 0x1p-40 * size)
        refuse(
            scene,
            "the scene cannot be framed: a part of it lies beside or behind the view point",
            "move the view point of PROJECTION away from the scene");
}

/// The longer of what the scene needs and what the picture's shape asks for, and the scene in the
/// middle.
std::pair<Interval, Interval>
fitted(Interval x, Interval y, double aspect, const FrameSettings& frame) {
    const double inner = 1 - 2 * frame.margin;
    const double width =
        std::max((x.last - x.first) / inner, aspect * ((y.last - y.first) / inner));
    const double height = width / aspect;
    const double x_center = 0.5 * (x.first + x.last);
    const double y_center = 0.5 * (y.first + y.last);
    return {
        {x_center - 0.5 * width, x_center + 0.5 * width},
        {y_center - 0.5 * height, y_center + 0.5 * height}};
}

} // namespace

Camera framed_camera(const Scene& scene, const FrameSettings& frame) {
    const SceneSupport support(scene);
    refuse_empty(scene, support);
    const auto [right, up, forward] = three_quarter_view();

    // Tangent of 18 degrees: half the field of view of the longer side of the picture.
    constexpr double half_field = 0.3249196962329063;
    const double aspect = picture_aspect(frame);
    const double half_width = aspect >= 1 ? half_field : half_field * aspect;
    const double half_height = half_width / aspect;

    // The view point lies where the planes through the margins touch the scene; of the two wedges
    // that they make, the one that has its point farther back decides.
    const double inner = 1 - 2 * frame.margin;
    const Wedge across = touching_wedge(support, right, forward, inner * half_width);
    const Wedge upwards = touching_wedge(support, up, forward, inner * half_height);
    double x = across.side;
    double y = upwards.side;
    const double depth = std::min(across.depth, upwards.depth);
    if (across.depth <= upwards.depth)
        y = centered_side(support, up, forward, inner * half_height, depth);
    else
        x = centered_side(support, right, forward, inner * half_width, depth);

    Camera camera;
    camera.viewpoint = x * right + y * up + depth * forward;
    const double distance = dot(center(support.bounds()) - camera.viewpoint, forward);
    camera.lower_left =
        camera.viewpoint + distance * (forward - half_width * right - half_height * up);
    camera.lower_right = camera.lower_left + 2 * distance * half_width * right;
    camera.upper_left = camera.lower_left + 2 * distance * half_height * up;
    return camera;
}

Camera reframed_camera(const Scene& scene, const Camera& camera, const FrameSettings& frame) {
    const SceneSupport support(scene);
    refuse_empty(scene, support);
    const Vec3 across = normalized(camera.lower_right - camera.lower_left);
    const Vec3 up = normalized(camera.upper_left - camera.lower_left);
    const Vec3 plane_normal = normalized(cross(across, up));

    Interval x;
    Interval y;
    if (camera.projection == Camera::Projection::parallel) {
        // Coordinates that do not change along the direction: x is square to it and to up.
        const Vec3 for_x = cross(up, camera.direction);
        const Vec3 for_y = cross(camera.direction, across);
        const auto coordinate = [&](Vec3 normal, Vec3 along) {
            const Vec3 numerator = normal / dot(normal, along);
            return PlaneCoordinate{numerator, -dot(numerator, camera.lower_left)};
        };
        x = parallel_extent(support, coordinate(for_x, across));
        y = parallel_extent(support, coordinate(for_y, up));
    } else {
        const double plane_distance = dot(plane_normal, camera.lower_left - camera.viewpoint);
        const Vec3 forward = plane_distance < 0 ? -plane_normal : plane_normal;
        const double distance = std::abs(plane_distance);
        refuse_what_is_behind(scene, support, camera.viewpoint, forward);
        const auto coordinate = [&](Vec3 normal, Vec3 along) {
            const Vec3 numerator = normal / dot(normal, along);
            return PlaneCoordinate{
                distance * numerator, dot(numerator, camera.viewpoint - camera.lower_left)};
        };
        x = perspective_extent(
            support, camera.viewpoint, coordinate(cross(up, plane_normal), across), forward);
        y = perspective_extent(
            support, camera.viewpoint, coordinate(cross(plane_normal, across), up), forward);
    }

    const auto [window_x, window_y] = fitted(x, y, picture_aspect(frame), frame);
    const auto in_plane = [&](double along_x, double along_y) {
        return camera.lower_left + along_x * across + along_y * up;
    };
    Camera result = camera;
    result.lower_left = in_plane(window_x.first, window_y.first);
    result.lower_right = in_plane(window_x.last, window_y.first);
    result.upper_left = in_plane(window_x.first, window_y.last);
    return result;
}

std::vector<PointLight> default_lights(const Scene& scene, const Camera& camera) {
    const Vec3 across = normalized(camera.lower_right - camera.lower_left);
    const Vec3 up = normalized(camera.upper_left - camera.lower_left);
    const Box3 box = bounds(scene);
    const Vec3 middle = box.empty() ? Vec3{} : center(box);
    const double size = length(extent(box));
    const bool parallel = camera.projection == Camera::Projection::parallel;
    const Vec3 viewer =
        parallel ? middle - 2 * size * normalized(camera.direction) : camera.viewpoint;
    const double distance = std::max(length(middle - viewer), 0.5 * size);
    PointLight light;
    light.position = viewer + distance * (0.7 * up - 0.5 * across);
    light.falloff = Falloff::none;
    return {light};
}

} // namespace vera
