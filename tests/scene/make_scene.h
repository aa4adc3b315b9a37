// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/crossings.h"
#include "vera/scene/scene.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace vera::test {

template <typename Primitive>
void add(
    Geometry& geometry, std::vector<Primitive>& primitives, ItemKind kind, Primitive primitive) {
    Item item;
    item.kind = kind;
    item.index = static_cast<std::uint32_t>(primitives.size());
    primitives.push_back(std::move(primitive));
    geometry.items.push_back(item);
}

inline void add(Geometry& geometry, const Sphere& sphere) {
    add(geometry, geometry.spheres, ItemKind::sphere, sphere);
}

inline void add(Geometry& geometry, const Triangle& triangle) {
    add(geometry, geometry.triangles, ItemKind::triangle, triangle);
}

inline void add(Geometry& geometry, const Patch& patch) {
    add(geometry, geometry.patches, ItemKind::patch, patch);
}

inline void add(Geometry& geometry, RotationalShape shape) {
    add(geometry, geometry.rotational_shapes, ItemKind::rotational_shape, std::move(shape));
}

inline void add(Geometry& geometry, Mesh mesh) {
    add(geometry, geometry.meshes, ItemKind::mesh, std::move(mesh));
}

inline void add(Geometry& geometry, const SubsceneCall& call) {
    add(geometry, geometry.calls, ItemKind::subscene_call, call);
}

/// A plane polygon, or a split quadrangle.
inline void add_polygon(
    Geometry& geometry,
    const std::vector<Vec3>& corners,
    Polygon::Shape shape = Polygon::Shape::convex) {
    Polygon polygon;
    polygon.first_corner = static_cast<std::uint32_t>(geometry.corners.size());
    polygon.corner_count = static_cast<std::uint32_t>(corners.size());
    polygon.shape = shape;
    Vec3 area;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        area = area + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    polygon.normal = normalized(area);
    geometry.corners.insert(geometry.corners.end(), corners.begin(), corners.end());
    add(geometry, geometry.polygons, ItemKind::polygon, polygon);
}

struct Crossing {
    double t = 0;
    std::uint32_t piece = 0;

    friend bool operator==(const Crossing&, const Crossing&) = default;
};

/// The crossings with item number `item` (of a mesh, with its triangle number `triangle`), sorted.
inline std::vector<Crossing> crossings(
    const Geometry& geometry,
    const Ray& ray,
    std::uint32_t item = 0,
    std::uint32_t start_piece = no_piece,
    std::uint32_t triangle = 0) {
    std::vector<Crossing> result;
    for_each_crossing(
        geometry, {item, triangle}, ray, start_piece, [&](double t, std::uint32_t piece) {
            result.push_back({t, piece});
        });
    std::sort(result.begin(), result.end(), [](const Crossing& a, const Crossing& b) {
        return std::pair(a.t, a.piece) < std::pair(b.t, b.piece);
    });
    return result;
}

} // namespace vera::test
