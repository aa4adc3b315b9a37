// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/support.h"

#include "vera/base/check.h"
#include "vera/scene/bounds.h"
#include "vera/scene/contour.h"
#include "vera/scene/crossings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace vera {

namespace {

Vec3 farthest_of(std::span<const Vec3> points, Vec3 direction) {
    Vec3 farthest = points[0];
    for (const Vec3& point : points)
        if (dot(point, direction) > dot(farthest, direction))
            farthest = point;
    return farthest;
}

Vec3 farthest_of(const Mesh& mesh, Vec3 direction) {
    // Not all positions: some may belong to no triangle.
    double reach = -Box3::infinity;
    Vec3 farthest;
    for (const std::uint32_t corner : mesh.position_indices) {
        const double here = dot(mesh.positions[corner], direction);
        if (here > reach) {
            reach = here;
            farthest = mesh.positions[corner];
        }
    }
    return farthest;
}

Vec3 farthest_of(const RotationalShape& shape, Vec3 direction) {
    const double along = dot(direction, shape.axis);
    const Vec3 across = direction - along * shape.axis;
    // Where the direction is the axis', all points of a circle are equally far.
    const std::size_t other = longest_axis(shape.axis) == 0 ? 1 : 0;
    Vec3 coordinate_axis;
    coordinate_axis[other] = 1;
    const Vec3 outwards =
        normalized(across == Vec3{} ? cross(shape.axis, coordinate_axis) : across);

    const ContourPiece::Point in_half_plane = {length(across), along};
    const auto reach = [&](ContourPiece::Point p) {
        return p.r * in_half_plane.r + p.h * in_half_plane.h;
    };
    ContourPiece::Point farthest = shape.start;
    ContourPiece::Point from = shape.start;
    for (const ContourPiece& piece : shape.contour) {
        const auto candidate =
            point_at(piece, from, farthest_parameter(piece, from, in_half_plane));
        if (reach(candidate) > reach(farthest))
            farthest = candidate;
        from = piece.end;
    }
    return shape.base + farthest.h * shape.axis + farthest.r * outwards;
}

/// How far a box reaches in a direction.
double reach_of(const Box3& box, Vec3 direction) {
    double reach = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        reach += direction[axis] * (direction[axis] > 0 ? box.upper[axis] : box.lower[axis]);
    return reach;
}

/// A subscene that has still to be looked into.
struct Prospect {
    double reach = 0; ///< at most, in the main scene's coordinates
    const Geometry* geometry = nullptr;
    Affine3 to_world;
};

bool is_empty(const Geometry& geometry, const Item& item) {
    return item.kind == ItemKind::mesh && geometry.meshes[item.index].triangle_count() == 0;
}

} // namespace

Vec3 farthest_point(const Geometry& geometry, const Item& item, Vec3 direction) {
    switch (item.kind) {
    case ItemKind::sphere: {
        const Sphere& sphere = geometry.spheres[item.index];
        return sphere.center + sphere.radius * normalized(direction);
    }
    case ItemKind::triangle:
        return farthest_of(geometry.triangles[item.index].corners, direction);
    case ItemKind::polygon:
        return farthest_of(corners_of(geometry, geometry.polygons[item.index]), direction);
    case ItemKind::patch:
        return farthest_of(geometry.patches[item.index].corners, direction);
    case ItemKind::rotational_shape:
        return farthest_of(geometry.rotational_shapes[item.index], direction);
    case ItemKind::mesh:
        return farthest_of(geometry.meshes[item.index], direction);
    case ItemKind::subscene_call:
        break;
    }
    VERA_CHECK(item.kind != ItemKind::subscene_call);
    return {};
}

SceneSupport::SceneSupport(const Scene& scene)
    : scene_(scene)
    , subscene_bounds_(subscene_bounds(scene))
    , bounds_(vera::bounds(scene.geometry, subscene_bounds_)) {}

std::optional<Vec3> SceneSupport::farthest_point(Vec3 direction) const {
    if (bounds_.empty())
        return std::nullopt;
    // Boxes are rounded outward, by some units in the last place for each subscene within another:
    // what is farther by that alone is as far. Else each of a million copies that end at one plane
    // would be looked into.
    const double rounding = 0x1p-40
        * std::max(std::abs(reach_of(bounds_, direction)), std::abs(reach_of(bounds_, -direction)));
    Vec3 farthest;
    double reach = -Box3::infinity;
    // Of the subscenes of one the most promising first, down to its primitives: what cannot reach
    // farther than these is never opened. Not the most promising of all: of copies that reach as
    // far, all would be opened before any primitive is seen.
    std::vector<Prospect> prospects = {{Box3::infinity, &scene_.geometry, {}}};
    while (!prospects.empty()) {
        const Prospect prospect = prospects.back();
        prospects.pop_back();
        if (!(prospect.reach > reach + rounding))
            continue;
        const auto first = static_cast<std::ptrdiff_t>(prospects.size());
        const Vec3 local_direction = transposed_times(prospect.to_world.linear, direction);
        for (const Item& item : prospect.geometry->items) {
            if (item.kind == ItemKind::subscene_call) {
                const SubsceneCall& call = prospect.geometry->calls[item.index];
                const auto callee = static_cast<std::size_t>(call.subscene);
                if (subscene_bounds_[callee].empty())
                    continue;
                const Affine3 to_world = composed(prospect.to_world, call.to_parent);
                const double callee_reach =
                    reach_of(subscene_bounds_[callee], transposed_times(to_world.linear, direction))
                    + dot(to_world.translation, direction);
                if (callee_reach > reach + rounding)
                    prospects.push_back({callee_reach, &scene_.subscenes[callee], to_world});
            } else if (!is_empty(*prospect.geometry, item)) {
                const Vec3 point = transformed_point(
                    prospect.to_world,
                    vera::farthest_point(*prospect.geometry, item, local_direction));
                if (dot(point, direction) > reach) {
                    reach = dot(point, direction);
                    farthest = point;
                }
            }
        }
        const auto nearer = [](const Prospect& a, const Prospect& b) { return a.reach < b.reach; };
        const auto best = std::max_element(prospects.begin() + first, prospects.end(), nearer);
        if (best != prospects.end())
            std::iter_swap(best, prospects.end() - 1);
    }
    return farthest;
}

} // namespace vera
