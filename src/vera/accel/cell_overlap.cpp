// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/cell_overlap.h"

#include "vera/base/check.h"

#include <algorithm>
#include <cmath>

namespace vera::detail {

namespace {

/// How far the block reaches from its center in the direction, times the direction's length.
double reach(const Block& block, Vec3 direction) {
    return dot(block.half, abs(direction));
}

/// Whether the plane through the points across the direction separates block and triangle. The
/// bound on rounding: coordinates are at most 4 and a product of two is rounded by 2^-50 or less.
bool separates(const Block& block, const std::array<Vec3, 3>& corners, Vec3 direction) {
    const double a = dot(corners[0] - block.center, direction);
    const double b = dot(corners[1] - block.center, direction);
    const double c = dot(corners[2] - block.center, direction);
    const double size = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    const double far = reach(block, direction) + 0x1p-46 * size;
    return std::min({a, b, c}) > far || std::max({a, b, c}) < -far;
}

/// By the separating axes of two convex bodies: the normals of both, and the cross products of
/// their edges.
bool triangle_touches(const std::array<Vec3, 3>& corners, const Block& block) {
    constexpr std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    for (const Vec3& axis : axes)
        if (separates(block, corners, axis))
            return false;
    const Vec3 edges[] = {
        corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
    if (separates(block, corners, cross(edges[0], edges[1])))
        return false;
    for (const Vec3& edge : edges)
        for (const Vec3& axis : axes)
            if (separates(block, corners, cross(axis, edge)))
                return false;
    return true;
}

/// Keeps what lies on the side of the axis-parallel plane where side * coordinate <= side * at.
void clip(std::vector<Vec3>& corners, std::size_t axis, double side, double at) {
    std::vector<Vec3> kept;
    kept.reserve(corners.size() + 2);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 from = corners[i == 0 ? corners.size() - 1 : i - 1];
        const Vec3 to = corners[i];
        const double from_beyond = side * (from[axis] - at);
        const double to_beyond = side * (to[axis] - at);
        if ((from_beyond <= 0) != (to_beyond <= 0)) {
            const double part = from_beyond / (from_beyond - to_beyond);
            Vec3 crossing = from + part * (to - from);
            crossing[axis] = at;
            kept.push_back(crossing);
        }
        if (to_beyond <= 0)
            kept.push_back(to);
    }
    corners = std::move(kept);
}

bool polygon_touches(const std::vector<Vec3>& corners, const Block& block) {
    Vec3 lower = corners.front();
    Vec3 upper = lower;
    for (const Vec3& corner : corners) {
        lower = min(lower, corner);
        upper = max(upper, corner);
    }
    std::vector<Vec3> rest = corners;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Each clipping rounds a corner by a few units of 2^-53 of coordinates up to 4.
        const double from = block.center[axis] - block.half[axis] - 0x1p-46;
        const double to = block.center[axis] + block.half[axis] + 0x1p-46;
        if (upper[axis] < from || lower[axis] > to)
            return false;
        if (lower[axis] < from)
            clip(rest, axis, -1, from);
        if (upper[axis] > to)
            clip(rest, axis, 1, to);
        if (rest.empty())
            return false;
    }
    return true;
}

} // namespace

void CellShape::assign_triangle(std::size_t number, const std::array<Vec3, 3>& corners) {
    kind_ = Kind::triangles;
    triangle_count_ = number + 1;
    for (std::size_t i = 0; i < 3; ++i)
        triangles_[number][i] = local(corners[i]);
}

void CellShape::assign_polygon(const Polygon& polygon) {
    const Vec3* corners = geometry_->corners.data() + polygon.first_corner;
    if (polygon.shape == Polygon::Shape::split_quadrangle) {
        assign_triangle(0, {corners[0], corners[1], corners[2]});
        assign_triangle(1, {corners[0], corners[2], corners[3]});
        return;
    }
    kind_ = Kind::polygon;
    corners_.clear();
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i)
        corners_.push_back(local(corners[i]));
}

void CellShape::assign_rings(const RotationalShape& shape) {
    kind_ = Kind::rotational;
    center_ = local(shape.base);
    axis_ = shape.axis;
    rings_.clear();
    ContourPiece::Point start = shape.start;
    for (const ContourPiece& piece : shape.contour) {
        // A curve lies within the hull of its ends and control points.
        Ring ring = {
            std::min(start.h, piece.end.h),
            std::max(start.h, piece.end.h),
            std::max(start.r, piece.end.r)};
        const std::size_t controls = piece.kind == ContourPiece::Kind::line ? 0
            : piece.kind == ContourPiece::Kind::conic                       ? 1
                                                                            : 2;
        for (std::size_t i = 0; i < controls; ++i) {
            ring.from = std::min(ring.from, piece.control[i].h);
            ring.to = std::max(ring.to, piece.control[i].h);
            ring.radius = std::max(ring.radius, piece.control[i].r);
        }
        rings_.push_back({scale_ * ring.from, scale_ * ring.to, scale_ * ring.radius});
        start = piece.end;
    }
}

void CellShape::assign(Element element) {
    const Item& item = geometry_->items[element.item];
    switch (item.kind) {
    case ItemKind::sphere:
        kind_ = Kind::sphere;
        center_ = local(geometry_->spheres[item.index].center);
        radius_ = scale_ * geometry_->spheres[item.index].radius;
        return;
    case ItemKind::triangle:
        return assign_triangle(0, geometry_->triangles[item.index].corners);
    case ItemKind::patch:
        return assign_triangle(0, geometry_->patches[item.index].corners);
    case ItemKind::polygon:
        return assign_polygon(geometry_->polygons[item.index]);
    case ItemKind::rotational_shape:
        return assign_rings(geometry_->rotational_shapes[item.index]);
    case ItemKind::mesh: {
        const Mesh& mesh = geometry_->meshes[item.index];
        const std::uint32_t* corners =
            mesh.position_indices.data() + std::size_t{3} * element.triangle;
        return assign_triangle(
            0,
            {mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]]});
    }
    case ItemKind::subscene_call:
        VERA_CHECK(item.kind != ItemKind::subscene_call);
    }
}

bool CellShape::sphere_touches(const Block& block) const {
    const Vec3 apart = abs(center_ - block.center);
    const Vec3 nearest = max(apart - block.half, {});
    const Vec3 farthest = apart + block.half;
    const double outer = radius_ + 0x1p-46;
    const double inner = std::max(radius_ - 0x1p-46, 0.0);
    return dot(nearest, nearest) <= outer * outer && dot(farthest, farthest) >= inner * inner;
}

bool CellShape::rings_touch(const Block& block) const {
    const Vec3 to_block = block.center - center_;
    const double height = dot(to_block, axis_);
    const double rounding = 0x1p-44 * (4 + max_component(abs(center_)));
    const double height_reach = reach(block, axis_) + rounding;
    // The block lies beyond a plane along the axis, at this distance from it.
    const Vec3 across = to_block - height * axis_;
    const double distance = std::sqrt(dot(across, across));
    const double clear = distance > 0 ? distance - reach(block, across) / distance - rounding : 0;
    return std::any_of(rings_.begin(), rings_.end(), [&](const Ring& ring) {
        return ring.radius >= clear && ring.from <= height + height_reach
            && ring.to >= height - height_reach;
    });
}

bool CellShape::touches(const Block& block) const {
    switch (kind_) {
    case Kind::sphere:
        return sphere_touches(block);
    case Kind::triangles:
        return triangle_touches(triangles_[0], block)
            || (triangle_count_ == 2 && triangle_touches(triangles_[1], block));
    case Kind::polygon:
        return polygon_touches(corners_, block);
    case Kind::rotational:
        return rings_touch(block);
    }
    return true;
}

} // namespace vera::detail
