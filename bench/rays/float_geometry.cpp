// SPDX-License-Identifier: Apache-2.0
#include "float_geometry.h"

#include "vera/scene/contour.h"
#include "vera/scene/crossings.h"

#include <span>
#include <stdexcept>

#include "directions.h"

namespace vera {

namespace {

std::uint32_t add_corner(FloatGeometry& result, Vec3 point) {
    result.corners.push_back(
        {static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)});
    return static_cast<std::uint32_t>(result.corners.size() - 1);
}

void add_fan(FloatGeometry& result, std::span<const Vec3> corners) {
    const std::uint32_t first = add_corner(result, corners[0]);
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const std::uint32_t last = add_corner(result, corners[i]);
        if (i > 1)
            result.triangles.push_back({first, last - 1, last});
    }
}

void add_mesh(FloatGeometry& result, const Mesh& mesh) {
    const auto first = static_cast<std::uint32_t>(result.corners.size());
    for (const Vec3& point : mesh.positions)
        add_corner(result, point);
    const std::vector<std::uint32_t>& corners = mesh.position_indices;
    for (std::size_t i = 0; i < corners.size(); i += 3)
        result.triangles.push_back(
            {first + corners[i], first + corners[i + 1], first + corners[i + 2]});
}

void add_sphere(FloatGeometry& result, const Sphere& sphere) {
    const auto number = [](double value) { return static_cast<float>(value); };
    result.spheres.push_back(
        {number(sphere.center.x),
         number(sphere.center.y),
         number(sphere.center.z),
         number(sphere.radius)});
}

/// Points along the contour, its ends included, so many for each curve.
std::vector<ContourPiece::Point> outline(const RotationalShape& shape, std::size_t pieces) {
    std::vector<ContourPiece::Point> points = {shape.start};
    for (const ContourPiece& piece : shape.contour) {
        const ContourPiece::Point start = points.back();
        const std::size_t parts = piece.kind == ContourPiece::Kind::line ? 1 : pieces;
        for (std::size_t i = 1; i <= parts; ++i)
            points.push_back(
                point_at(piece, start, static_cast<double>(i) / static_cast<double>(parts)));
    }
    return points;
}

void add_rotational_shape(
    FloatGeometry& result, const RotationalShape& shape, const Facets& facets) {
    const auto sides = static_cast<std::uint32_t>(facets.sides);
    const Across plane = across(shape.axis);
    const std::vector<ContourPiece::Point> points = outline(shape, facets.pieces);
    for (std::size_t row = 0; row < points.size(); ++row) {
        const auto [r, h] = points[row];
        const auto first = static_cast<std::uint32_t>(result.corners.size());
        for (std::uint32_t side = 0; side < sides; ++side)
            add_corner(
                result, shape.base + h * shape.axis + r * turned(plane, degrees(side, sides)));
        for (std::uint32_t side = 0; row > 0 && side < sides; ++side) {
            const std::uint32_t a = first + side;
            const std::uint32_t b = first + (side + 1) % sides;
            // On the axis, a ring is a point, and one triangle of each pair is none.
            if (points[row - 1].r > 0)
                result.triangles.push_back({a - sides, b - sides, b});
            if (r > 0)
                result.triangles.push_back({a - sides, b, a});
        }
    }
}

void add_item(
    FloatGeometry& result, const Geometry& geometry, const Item& item, const Facets& facets) {
    switch (item.kind) {
    case ItemKind::mesh:
        add_mesh(result, geometry.meshes[item.index]);
        return;
    case ItemKind::triangle:
        add_fan(result, geometry.triangles[item.index].corners);
        return;
    case ItemKind::patch:
        add_fan(result, geometry.patches[item.index].corners);
        return;
    case ItemKind::polygon: {
        const Polygon& polygon = geometry.polygons[item.index];
        if (polygon.shape == Polygon::Shape::simple)
            break;
        add_fan(result, corners_of(geometry, polygon));
        return;
    }
    case ItemKind::sphere:
        add_sphere(result, geometry.spheres[item.index]);
        return;
    case ItemKind::rotational_shape:
        add_rotational_shape(result, geometry.rotational_shapes[item.index], facets);
        return;
    case ItemKind::subscene_call:
        break;
    }
    throw std::runtime_error("this scene holds what Embree is not asked about");
}

} // namespace

FloatGeometry float_geometry(const Scene& scene, const Facets& facets) {
    FloatGeometry result;
    for (const Item& item : scene.geometry.items)
        add_item(result, scene.geometry, item, facets);
    result.corners.push_back({});
    return result;
}

} // namespace vera
