// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/convex_piece.h"

#include "vera/scene/contour.h"

namespace vera {

Convexity convexity(const PrimitivePath& path, std::uint32_t piece) {
    const Item& item = path.geometry->items[path.element.item];
    if (item.kind == ItemKind::sphere)
        return Convexity::outwards;
    if (item.kind != ItemKind::rotational_shape)
        return Convexity::none;
    const RotationalShape& shape = path.geometry->rotational_shapes[item.index];
    const ContourPiece& contour = shape.contour[piece];
    const ContourPiece::Point start = piece == 0 ? shape.start : shape.contour[piece - 1].end;
    const Hodograph directions = hodograph(contour, start);
    if (inflections(directions).count > 0 || extremes(directions, {0, 1}).count > 0)
        return Convexity::none;
    // It goes up all the way or down, and turns left all the way or right. Its outer side is on the
    // right: going up, it is that away from the axis.
    const ContourPiece::Point first = direction_at(directions, 0);
    const ContourPiece::Point last = direction_at(directions, 1);
    const double turn = first.r * last.h - first.h * last.r;
    const double up = first.h + last.h;
    if (up > 0 && turn >= 0)
        return Convexity::outwards;
    return up < 0 && turn <= 0 ? Convexity::inwards : Convexity::none;
}

SurfacePoint meeting_by_planes(
    const PrimitivePath& path, std::uint32_t piece, const Ray& local, const Passage& passage) {
    constexpr int most_steps = 40;
    constexpr double nearest = 1e-6; // of the way, and of the last step, which squares it
    const double reach = 0.5 * (passage.to - passage.from);
    const double forward = passage.enters ? 1 : -1;
    const double turned = convexity(path, piece) == Convexity::outwards ? 1 : -1;
    double t = passage.enters ? passage.from : passage.to;
    SurfacePoint surface = surface_within(path, piece, point_at(local, t));
    for (int i = 0; i < most_steps; ++i) {
        const Vec3 outwards = turned * surface.geometric_normal;
        const double off = dot(outwards, point_at(local, t) - surface.point);
        const double speed = -forward * dot(outwards, local.direction);
        if (!(speed > 0 && off > nearest * speed * reach))
            break;
        t += forward * off / speed;
        surface = surface_within(path, piece, point_at(local, t));
    }
    return surface;
}

} // namespace vera
