// SPDX-License-Identifier: Apache-2.0
// Where a ray meets the body of a convex piece of a rotational shape: the tangent at a place of the
// contour sweeps a cone round the body, which the ray meets where a quadratic equation says. Of
// that point the nearest place on the contour is looked for by one step of Newton's method, and so
// on. At the place that is met the cone touches the body, so that what the parameter is off counts
// by its square alone: both converge as Newton's method does.
#include "vera/visible/curved_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vera {

namespace {

using Point = ContourPiece::Point;

constexpr int most_steps = 16;
constexpr double near = 1e-6; // of the parameter: the next one is off by the square of that, about
constexpr double nearby = 1e-4; // likewise, for places that are all but known

/// The way of a ray round an axis: h = h + t dh along it, and r^2 = rr + 2 t rd + t^2 dd off it.
struct WayRoundAxis {
    double h = 0;
    double dh = 0;
    double rr = 0;
    double rd = 0;
    double dd = 0;

    WayRoundAxis(const RotationalShape& shape, Vec3 origin, Vec3 direction) {
        const Vec3 from_base = origin - shape.base;
        h = dot(from_base, shape.axis);
        dh = dot(direction, shape.axis);
        const Vec3 across = from_base - h * shape.axis;
        const Vec3 along = direction - dh * shape.axis;
        rr = dot(across, across);
        rd = dot(across, along);
        dd = dot(along, along);
    }

    Point at(double t) const {
        return {std::sqrt(std::max(0.0, rr + t * (2 * rd + t * dd))), h + t * dh};
    }
};

/// A cone round the axis: out.r * r + out.h * h = reach, where out.r >= 0.
struct Cone {
    Point out;
    double reach = 0;
};

/// Where the way enters or leaves the cone's inside, which is convex: it does where out.r * r is
/// what is left of the reach, k - l * t. Where it passes the inside, where it is nearest to that;
/// infinite where it comes from inside for ever, or goes there.
double passage(const WayRoundAxis& way, const Cone& cone, bool enters) {
    const double aa = cone.out.r * cone.out.r;
    const double k = cone.reach - cone.out.h * way.h;
    const double l = cone.out.h * way.dh;
    const double sign = enters ? -1 : 1;
    const double q = aa * way.dd - l * l;
    const double discriminant = k * (k * way.dd + 2 * l * way.rd) + l * l * way.rr
        + aa * (way.rd * way.rd - way.dd * way.rr);
    if (q > 0 && !(discriminant >= 0 && k * way.dd + l * way.rd >= 0)) {
        const double off = std::max(0.0, way.rr - way.rd * way.rd / way.dd);
        return -l * std::sqrt(off / (way.dd * q)) - way.rd / way.dd;
    }
    if (q <= 0 && !(sign * l > 0))
        return sign * std::numeric_limits<double>::infinity();
    const double root = sign * cone.out.r * std::sqrt(std::max(0.0, discriminant));
    const double half = -(aa * way.rd + k * l);
    // Of the two forms the one that does not cancel.
    return (half < 0) == (root < 0) ? (half + root) / q : (aa * way.rr - k * k) / (half - root);
}

} // namespace

struct CurvedPiece::Contact {
    Point point;
    Point along;      ///< unit
    double speed = 0; ///< of the point by the parameter
    double turn = 0;  ///< of the direction by the parameter, to the left

    Point out() const { return {along.h, -along.r}; }
};

CurvedPiece::CurvedPiece(const PrimitivePath& path, std::uint32_t piece) {
    const Item& item = path.geometry->items[path.element.item];
    if (item.kind == ItemKind::sphere) {
        sphere_ = &path.geometry->spheres[item.index];
        return;
    }
    shape_ = &path.geometry->rotational_shapes[item.index];
    contour_ = shape_->contour[piece];
    start_ = piece == 0 ? shape_->start : shape_->contour[piece - 1].end;
    directions_ = hodograph(contour_, start_);
    turned_ = convexity(path, piece) == Convexity::inwards ? -1 : 1;
}

CurvedPiece::Contact CurvedPiece::contact_at(double parameter) const {
    const double v = parameter;
    const double w = 1 - v;
    const auto& [first, middle, last] = directions_.coefficients;
    const Point low = {w * first.r + v * middle.r, w * first.h + v * middle.h};
    const Point high = {w * middle.r + v * last.r, w * middle.h + v * last.h};
    Point along = {w * low.r + v * high.r, w * low.h + v * high.h};
    double factor = 1; // of the derivative by the hodograph
    if (contour_.kind == ContourPiece::Kind::conic) {
        const double sum = w * w + 2 * v * w * contour_.weight + v * v;
        factor = 2 / (sum * sum);
    } else if (contour_.kind == ContourPiece::Kind::cubic) {
        factor = 3;
    }
    const double squared = along.r * along.r + along.h * along.h;
    const double size = std::sqrt(squared);
    Contact contact;
    contact.point = point_at(contour_, start_, v);
    contact.along = {along.r / size, along.h / size};
    contact.speed = factor * size;
    contact.turn = 2 * (along.r * (high.h - low.h) - along.h * (high.r - low.r)) / squared;
    return contact;
}

/// Newton's step of the parameter towards where the way to the point is square to the contour.
double CurvedPiece::step_towards(const Contact& contact, Point point) const {
    const Point way = {point.r - contact.point.r, point.h - contact.point.h};
    const Point out = contact.out();
    const double ahead = way.r * contact.along.r + way.h * contact.along.h;
    const double off = way.r * out.r + way.h * out.h;
    return ahead / std::max(contact.speed + contact.turn * off, 0.25 * contact.speed);
}

std::optional<CurvedPiece::Place>
CurvedPiece::sphere_meeting(const Ray& ray, const Passage& passage) const {
    const Vec3 to_center = sphere_->center - ray.origin;
    const double squared = dot(ray.direction, ray.direction);
    const double middle = dot(to_center, ray.direction) / squared;
    const Vec3 off = to_center - middle * ray.direction;
    const double half =
        std::sqrt(std::max(0.0, (sphere_->radius * sphere_->radius - dot(off, off)) / squared));
    const double t = passage.enters ? middle - half : middle + half;
    return Place{t, normalized(point_at(ray, t) - sphere_->center)};
}

std::optional<CurvedPiece::Place> CurvedPiece::meeting(const Ray& ray, const Passage& part) const {
    if (sphere_ != nullptr)
        return sphere_meeting(ray, part);
    const double middle = 0.5 * (part.from + part.to);
    const double reach = part.to - middle;
    const WayRoundAxis way(*shape_, point_at(ray, middle), ray.direction);
    const bool is_line = contour_.kind == ContourPiece::Kind::line;
    double parameter = 0.5;
    double t = 0; // from the middle
    for (int i = 0; i < most_steps; ++i) {
        const Contact contact = contact_at(parameter);
        const Point out = {turned_ * contact.out().r, turned_ * contact.out().h};
        const Cone cone = {out, out.r * contact.point.r + out.h * contact.point.h};
        const double next = std::clamp(passage(way, cone, part.enters), -reach, reach);
        const Point there = way.at(next);
        const double step = is_line
            ? 0
            : std::clamp(parameter + step_towards(contact, there), 0.0, 1.0) - parameter;
        const bool is_near =
            is_line || (std::abs(step) < near && (std::abs(next - t) < near * reach || step == 0));
        t = next;
        if (is_near && there.r > 0) {
            const Vec3 from_base = point_at(ray, middle + t) - shape_->base;
            const Vec3 across = from_base - there.h * shape_->axis;
            const Vec3 normal = contact.out().r / there.r * across + contact.out().h * shape_->axis;
            return Place{middle + t, normal};
        }
        parameter += step;
    }
    return std::nullopt;
}

std::optional<CurvedPiece::Nearest> CurvedPiece::nearest_to(Vec3 point, double& parameter) const {
    if (sphere_ != nullptr) {
        const Vec3 way = point - sphere_->center;
        return Nearest{normalized(way), length(way) - sphere_->radius};
    }
    const Vec3 from_base = point - shape_->base;
    const double h = dot(from_base, shape_->axis);
    const Vec3 across = from_base - h * shape_->axis;
    const double r = length(across);
    double v = parameter;
    for (int i = 0; i < most_steps; ++i) {
        const Contact contact = contact_at(v);
        const double step = std::clamp(v + step_towards(contact, {r, h}), 0.0, 1.0) - v;
        v += step;
        if (std::abs(step) < nearby && r > 0) {
            parameter = v;
            const Point out = contact.out();
            return Nearest{
                out.r / r * across + out.h * shape_->axis,
                out.r * (r - contact.point.r) + out.h * (h - contact.point.h)};
        }
    }
    return std::nullopt;
}

std::optional<CurvedPiece::Place>
CurvedPiece::meeting_near(const Ray& ray, double t, double& parameter) const {
    // Newton's method, whose steps become shorter the more the ray goes along the surface, where it
    // would end far away: they are those of the normal equation with a slight term added
    // (Levenberg 1944).
    constexpr double slight = 0.01; // squared cosine of the ray and the normal
    const double squared = dot(ray.direction, ray.direction);
    const auto step = [&](const Nearest& nearest) {
        const double speed = dot(nearest.normal, ray.direction);
        return -nearest.off * speed / (speed * speed + slight * squared);
    };
    const std::optional<Nearest> first = nearest_to(point_at(ray, t), parameter);
    if (!first)
        return std::nullopt;
    t += step(*first);
    const std::optional<Nearest> second = nearest_to(point_at(ray, t), parameter);
    if (!second)
        return std::nullopt;
    return Place{t + step(*second), second->normal};
}

double CurvedPiece::parameter_near(Vec3 point) const {
    if (sphere_ != nullptr)
        return 0;
    const Vec3 from_base = point - shape_->base;
    const double h = dot(from_base, shape_->axis);
    return nearest_parameter(contour_, start_, {length(from_base - h * shape_->axis), h});
}

} // namespace vera
