// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/bounds.h"

#include "vera/base/check.h"
#include "vera/scene/contour.h"
#include "vera/scene/crossings.h"

#include <algorithm>
#include <span>

namespace vera {

namespace {

Box3 bounds(std::span<const Vec3> points) {
    Box3 box;
    for (const Vec3& point : points)
        box = grown(box, point);
    return box;
}

} // namespace

Box3 bounds(const Sphere& sphere) {
    const Vec3 reach = {sphere.radius, sphere.radius, sphere.radius};
    return {sphere.center - reach, sphere.center + reach};
}

Box3 bounds(const RotationalShape& shape) {
    Box3 box;
    for (std::size_t i = 0; i < 3; ++i) {
        // A circle about the axis reaches as far along coordinate i as its radius times the sine
        // of the angle between them.
        const double along = shape.axis[i];
        const double across =
            std::sqrt(dot(shape.axis, shape.axis) - shape.axis[i] * shape.axis[i]);
        const auto reach = [&](double side) {
            const ContourPiece::Point direction = {across, side * along};
            const auto extent_of = [&](ContourPiece::Point p) {
                return p.r * direction.r + p.h * direction.h;
            };
            double farthest = extent_of(shape.start);
            ContourPiece::Point from = shape.start;
            for (const ContourPiece& piece : shape.contour) {
                farthest = std::max(farthest, extent_of(piece.end));
                if (piece.kind != ContourPiece::Kind::line) {
                    const double v = farthest_parameter(piece, from, direction);
                    farthest = std::max(farthest, extent_of(point_at(piece, from, v)));
                }
                from = piece.end;
            }
            return farthest;
        };
        const double up = reach(1);
        const double down = reach(-1);
        // The axis is a unit vector to a few units of 2^-53, and the points round like that.
        const double size =
            std::abs(shape.base[i]) + std::max(std::abs(up), std::abs(down)) + (up + down);
        box.lower[i] = shape.base[i] - down - 0x1p-50 * size;
        box.upper[i] = shape.base[i] + up + 0x1p-50 * size;
    }
    return box;
}

Box3 bounds(const Geometry& geometry, Element element) {
    const Item& item = geometry.items[element.item];
    switch (item.kind) {
    case ItemKind::sphere:
        return bounds(geometry.spheres[item.index]);
    case ItemKind::triangle:
        return bounds(geometry.triangles[item.index].corners);
    case ItemKind::polygon:
        return bounds(corners_of(geometry, geometry.polygons[item.index]));
    case ItemKind::patch:
        return bounds(geometry.patches[item.index].corners);
    case ItemKind::rotational_shape:
        return bounds(geometry.rotational_shapes[item.index]);
    case ItemKind::mesh:
        return bounds(corners_of(geometry.meshes[item.index], element.triangle));
    case ItemKind::subscene_call:
        break;
    }
    VERA_CHECK(item.kind != ItemKind::subscene_call);
    return {};
}

Box3 bounds(const Geometry& geometry, std::size_t number, const std::vector<Box3>& subscenes) {
    const Item& item = geometry.items[number];
    if (item.kind == ItemKind::subscene_call) {
        const SubsceneCall& call = geometry.calls[item.index];
        return transformed_box(call.to_parent, subscenes[static_cast<std::size_t>(call.subscene)]);
    }
    if (item.kind == ItemKind::mesh) {
        // Not all positions: some may belong to no triangle.
        const Mesh& mesh = geometry.meshes[item.index];
        Box3 box;
        for (const std::uint32_t corner : mesh.position_indices)
            box = grown(box, mesh.positions[corner]);
        return box;
    }
    return bounds(geometry, {static_cast<std::uint32_t>(number), 0});
}

Box3 bounds(const Geometry& geometry, const std::vector<Box3>& subscenes) {
    Box3 box;
    for (std::size_t i = 0; i < geometry.items.size(); ++i)
        box = united(box, bounds(geometry, i, subscenes));
    return box;
}

std::vector<Box3> subscene_bounds(const Scene& scene) {
    std::vector<Box3> boxes(scene.subscenes.size());
    for (const std::size_t i : callees_first(scene))
        boxes[i] = bounds(scene.subscenes[i], boxes);
    return boxes;
}

Box3 bounds(const Scene& scene) {
    return bounds(scene.geometry, subscene_bounds(scene));
}

} // namespace vera
