// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/outline_curves.h"

#include "vera/drawing/elliptic_arc.h"
#include "vera/math/transform.h"
#include "vera/math/vec3.h"
#include "vera/scene/contour.h"
#include "vera/scene/surface.h"

#include <algorithm>
#include <cmath>

namespace vera {

namespace {

/// The ellipse about the center of the points whose coordinates have that covariance.
std::optional<DrawingEllipse> ellipse_of(DrawingPoint center, double xx, double xy, double yy) {
    constexpr double thinnest = 1e-3; // pixels
    constexpr double longest = 1e7;
    const double mean = (xx + yy) / 2;
    const double half = (xx - yy) / 2;
    const double off = std::sqrt(half * half + xy * xy);
    const double most = mean + off;
    const double least = most > 0 ? (xx * yy - xy * xy) / most : 0;
    if (!(least > thinnest * thinnest && most < longest * longest))
        return std::nullopt;
    // The longer of two forms of the same direction, in which nothing cancels.
    DrawingPoint to = half >= 0 ? DrawingPoint{half + off, xy} : DrawingPoint{xy, off - half};
    const double size = distance(to, {});
    to = size > 0 ? DrawingPoint{to.x / size, to.y / size} : DrawingPoint{1, 0};
    const double a = std::sqrt(most);
    const double b = std::sqrt(std::min(least, most));
    return DrawingEllipse{center, {a * to.x, a * to.y}, {-b * to.y, b * to.x}};
}

/// Two unit vectors square to the axis and each other.
std::array<Vec3, 2> across(Vec3 axis) {
    const Vec3 other = std::abs(axis.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 first = normalized(cross(axis, other));
    return {first, cross(axis, first)};
}

ContourPiece::Point start_of(const RotationalShape& shape, std::size_t piece) {
    return piece == 0 ? shape.start : shape.contour[piece - 1].end;
}

/// Whether the contour makes a corner before piece i, or begins or ends there.
bool has_corner_before(const RotationalShape& shape, std::size_t i) {
    constexpr double smooth = 0.999; // the cosine
    const std::size_t count = shape.contour.size();
    const bool is_closed = shape.contour.back().end == shape.start;
    if (!is_closed && (i == 0 || i == count))
        return true;
    const auto direction = [&](std::size_t piece, double v) {
        return direction_at(hodograph(shape.contour[piece], start_of(shape, piece)), v);
    };
    const ContourPiece::Point a = direction(i == 0 ? count - 1 : i - 1, 1);
    const ContourPiece::Point b = direction(i == count ? 0 : i, 0);
    const double along = a.r * b.r + a.h * b.h;
    return along <= smooth * std::sqrt((a.r * a.r + a.h * a.h) * (b.r * b.r + b.h * b.h));
}

/// The sphere about the axis that the piece is a part of: where along the axis, and how large.
struct OnAxis {
    double h = 0;
    double radius = 0;

    bool is_about(const OnAxis& other) const {
        const double off = 1e-9 * radius;
        return std::abs(h - other.h) <= off && std::abs(radius - other.radius) <= off;
    }
};

std::optional<OnAxis> sphere_of(const RotationalShape& shape, std::size_t piece) {
    const ContourPiece& contour = shape.contour[piece];
    const ContourPiece::Point a = start_of(shape, piece);
    const ContourPiece::Point b = contour.end;
    if (contour.kind != ContourPiece::Kind::conic || a.h == b.h)
        return std::nullopt;
    // As far from one end as from the other; and from all between, if it is one.
    const double h = (a.h + b.h) / 2 + (a.r - b.r) * (a.r + b.r) / (2 * (a.h - b.h));
    const auto radius = [&](ContourPiece::Point p) {
        return std::sqrt(p.r * p.r + (p.h - h) * (p.h - h));
    };
    for (const double v : {0.25, 0.5, 0.75})
        if (std::abs(radius(point_at(contour, a, v)) - radius(a)) > 1e-9 * radius(a))
            return std::nullopt;
    return OnAxis{h, radius(a)};
}

} // namespace

std::optional<DrawingEllipse> outline_ellipse(
    const CameraMap& map, const PictureSettings& picture, Vec3 center, std::span<const Vec3> axes) {
    // The dual conic of the outline is the image of that of the ellipsoid (Hartley and Zisserman,
    // Multiple View Geometry in Computer Vision, 2004, section 8.3): here with the image's origin
    // in the center's, so that nothing cancels.
    const ImagePoint middle = map.image_point(center);
    if (!(middle.w > 0))
        return std::nullopt;
    const double x = middle.x / middle.w;
    const double y = middle.y / middle.w;
    double xx = 0;
    double xy = 0;
    double yy = 0;
    double xw = 0;
    double yw = 0;
    double ww = middle.w * middle.w;
    for (const Vec3& axis : axes) {
        const ImagePoint end = map.image_point(center + axis);
        const double dw = end.w - middle.w;
        const double dx = (end.x - middle.x) - x * dw;
        const double dy = (end.y - middle.y) - y * dw;
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
        xw -= dx * dw;
        yw -= dy * dw;
        ww -= dw * dw;
    }
    if (!(ww > 1e-9 * middle.w * middle.w))
        return std::nullopt;
    const double off_x = xw / ww;
    const double off_y = yw / ww;
    // Of which y grows upward.
    const auto width = static_cast<double>(picture.width);
    const auto height = static_cast<double>(picture.height);
    return ellipse_of(
        {(x + off_x) * width, (1 - y - off_y) * height},
        (xx / ww + off_x * off_x) * width * width,
        -(xy / ww + off_x * off_y) * width * height,
        (yy / ww + off_y * off_y) * height * height);
}

double curve_tolerance(const PictureSettings& picture, double deviation) {
    return deviation + 4.0 * std::max(picture.width, picture.height) / screen_size;
}

DrawingPoint in_pixels(const PictureSettings& picture, const RationalPoint& point) {
    return {point.x() * picture.width / screen_size, point.y() * picture.height / screen_size};
}

OutlineCurves::OutlineCurves(
    const Scene& scene,
    const CameraMap& map,
    const PictureSettings& picture,
    std::span<const std::uint64_t> primitives) {
    for (const std::uint64_t primitive : primitives) {
        const PrimitivePath path = path_to(scene, primitive);
        const Item& item = path.geometry->items[path.element.item];
        const auto curve = [&](Vec3 center, std::vector<Vec3> axes) {
            for (Vec3& axis : axes)
                axis = transformed_vector(path.to_world, axis);
            const auto ellipse =
                outline_ellipse(map, picture, transformed_point(path.to_world, center), axes);
            if (!ellipse)
                return no_curve;
            curves_.push_back(*ellipse);
            return static_cast<std::uint32_t>(curves_.size() - 1);
        };
        if (item.kind == ItemKind::sphere) {
            const Sphere& sphere = path.geometry->spheres[item.index];
            const double r = sphere.radius;
            primitives_.push_back({primitive, pieces_.size()});
            pieces_.push_back(
                {no_curve, no_curve, curve(sphere.center, {{r, 0, 0}, {0, r, 0}, {0, 0, r}})});
        } else if (item.kind == ItemKind::rotational_shape) {
            primitives_.push_back({primitive, pieces_.size()});
            add_pieces(path.geometry->rotational_shapes[item.index], curve);
        }
    }
}

void OutlineCurves::add_pieces(const RotationalShape& shape, const CurveOf& curve) {
    const auto [u, v] = across(shape.axis);
    const auto circle_before = [&, u = u, v = v](std::size_t i) {
        const ContourPiece::Point at = start_of(shape, i);
        return has_corner_before(shape, i) // else no line runs along it
            ? curve(shape.base + at.h * shape.axis, {at.r * u, at.r * v})
            : no_curve;
    };
    std::optional<OnAxis> last; // which several pieces may be parts of
    std::uint32_t sphere = no_curve;
    std::uint32_t circle = circle_before(0);
    for (std::size_t i = 0; i < shape.contour.size(); ++i) {
        const std::uint32_t next_circle = circle_before(i + 1);
        const std::optional<OnAxis> found = sphere_of(shape, i);
        if (found && !(last && last->is_about(*found)))
            sphere = curve(
                shape.base + found->h * shape.axis,
                {found->radius * u, found->radius * v, found->radius * shape.axis});
        if (found)
            last = found;
        pieces_.push_back({circle, next_circle, found ? sphere : no_curve});
        circle = next_circle;
    }
}

std::uint32_t OutlineCurves::curve_of(
    const Facets::Triangle& facet,
    bool is_silhouette,
    const std::array<DrawingPoint, 2>& ends,
    double tolerance) const {
    const auto found = std::lower_bound(
        primitives_.begin(),
        primitives_.end(),
        facet.primitive,
        [](const OfPrimitive& of, std::uint64_t primitive) { return of.primitive < primitive; });
    if (found == primitives_.end() || found->primitive != facet.primitive)
        return no_curve;
    const DrawingPoint middle = {(ends[0].x + ends[1].x) / 2, (ends[0].y + ends[1].y) / 2};
    const OfPiece& piece = pieces_[found->first_piece + facet.piece];
    for (const std::uint32_t curve :
         {piece.begin, piece.end, is_silhouette ? piece.sphere : no_curve}) {
        if (curve == no_curve)
            continue;
        const DrawingEllipse& ellipse = curves_[curve];
        const double a = distance(ellipse.major, {});
        const double b = distance(ellipse.minor, {});
        const auto is_near = [&](DrawingPoint point) {
            // Where the ellipse is the unit circle; lengths there are shorter by b at least.
            const double x = point.x - ellipse.center.x;
            const double y = point.y - ellipse.center.y;
            const double radius = distance(
                {(x * ellipse.major.x + y * ellipse.major.y) / (a * a),
                 (x * ellipse.minor.x + y * ellipse.minor.y) / (b * b)},
                {});
            if (std::abs(radius - 1) * b > tolerance)
                return false;
            return distance(point, point_at(ellipse, nearest_degrees(ellipse, point))) <= tolerance;
        };
        if (is_near(ends[0]) && is_near(ends[1]) && is_near(middle))
            return curve;
    }
    return no_curve;
}

} // namespace vera
