// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/element_records.h"

#include "vera/base/check.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vera::detail {

namespace {

// Coordinates are rounded to the nearest float, which the slack of a query allows for. What says
// how large something is must not shrink.
constexpr double enlarged = 1 + 0x1p-22;

ElementRecord record_of(ElementRecord::Kind kind, Vec3 a, Vec3 b, Vec3 c) {
    ElementRecord record;
    record.kind = kind;
    const Vec3 rows[] = {a, b, c};
    for (std::size_t i = 0; i < 9; ++i)
        record.values[i] = static_cast<float>(rows[i / 3][i % 3]);
    return record;
}

ElementRecord triangle_record(const LocalGeometry& local, Vec3 a, Vec3 b, Vec3 c) {
    return record_of(
        ElementRecord::Kind::triangle,
        local_point(local, a),
        local.scale * (b - a),
        local.scale * (c - a));
}

/// Nothing where the corners are not well placed for it: then the box has to do.
std::optional<ElementRecord> quadrangle_record(const LocalGeometry& local, const Vec3* corners) {
    const Vec3 e = corners[1] - corners[0];
    const Vec3 f = corners[3] - corners[0];
    const Vec3 opposite = corners[2] - corners[0];
    const Vec3 normal = cross(e, f);
    const double normal_squared = dot(normal, normal);
    // Where the edges at the corner make a sharp angle, x and y are large or badly known.
    if (!(normal_squared > 0.01 * dot(e, e) * dot(f, f)))
        return std::nullopt;
    const double x = dot(cross(opposite, f), normal) / normal_squared;
    const double y = dot(cross(e, opposite), normal) / normal_squared;
    const Vec3 off = local.scale * (opposite - x * e - y * f);
    if (!(std::abs(x) < 4) || !(std::abs(y) < 4) || !(max_component(abs(off)) < 0x1p-22))
        return std::nullopt;
    ElementRecord record = triangle_record(local, corners[0], corners[1], corners[3]);
    record.kind = ElementRecord::Kind::quadrangle;
    record.values[9] = static_cast<float>(x);
    record.values[10] = static_cast<float>(y);
    return record;
}

ElementRecord
polygon_record(const LocalGeometry& local, const Polygon& polygon, const Box3& local_box) {
    if (polygon.shape == Polygon::Shape::convex && polygon.corner_count == 4)
        if (const auto record =
                quadrangle_record(local, local.geometry->corners.data() + polygon.first_corner))
            return *record;
    return record_of(ElementRecord::Kind::box, local_box.lower, local_box.upper, {});
}

/// Of a shape that is nothing but the mantle of a cylinder, or of a cone that is not flat.
std::optional<ElementRecord>
mantle_record(const LocalGeometry& local, const RotationalShape& shape) {
    const ContourPiece& piece = shape.contour.front();
    const ContourPiece::Point length = {piece.end.r - shape.start.r, piece.end.h - shape.start.h};
    if (shape.contour.size() != 1 || piece.kind != ContourPiece::Kind::line
        || !(std::abs(length.r) < std::abs(length.h)))
        return std::nullopt;
    const Vec3 middle = shape.base + (0.5 * shape.start.h + 0.5 * piece.end.h) * shape.axis;
    const double radius = 0.5 * shape.start.r + 0.5 * piece.end.r;
    return record_of(
        ElementRecord::Kind::mantle,
        local_point(local, middle),
        shape.axis,
        {local.scale * radius, 0.5 * local.scale * std::abs(length.h), length.r / length.h});
}

ElementRecord cylinder_record(const LocalGeometry& local, const RotationalShape& shape) {
    if (const auto mantle = mantle_record(local, shape))
        return *mantle;
    double lowest = shape.start.h;
    double highest = shape.start.h;
    double radius = shape.start.r;
    const auto include = [&](ContourPiece::Point point) {
        lowest = std::min(lowest, point.h);
        highest = std::max(highest, point.h);
        radius = std::max(radius, point.r);
    };
    for (const ContourPiece& piece : shape.contour) {
        if (piece.kind != ContourPiece::Kind::line)
            include(piece.control[0]);
        if (piece.kind == ContourPiece::Kind::cubic)
            include(piece.control[1]);
        include(piece.end);
    }
    const Vec3 middle = shape.base + (0.5 * lowest + 0.5 * highest) * shape.axis;
    const double half_length = 0.5 * (highest - lowest);
    return record_of(
        ElementRecord::Kind::cylinder,
        local_point(local, middle),
        shape.axis,
        enlarged * local.scale * Vec3{radius, half_length, 0});
}

} // namespace

ElementRecord element_record(const LocalGeometry& local, Element element, const Box3& local_box) {
    const Geometry& geometry = *local.geometry;
    const Item& item = geometry.items[element.item];
    switch (item.kind) {
    case ItemKind::sphere: {
        const Sphere& sphere = geometry.spheres[item.index];
        return record_of(
            ElementRecord::Kind::sphere,
            local_point(local, sphere.center),
            {enlarged * local.scale * sphere.radius, 0, 0},
            {});
    }
    case ItemKind::triangle: {
        const auto& corners = geometry.triangles[item.index].corners;
        return triangle_record(local, corners[0], corners[1], corners[2]);
    }
    case ItemKind::patch: {
        const auto& corners = geometry.patches[item.index].corners;
        return triangle_record(local, corners[0], corners[1], corners[2]);
    }
    case ItemKind::mesh: {
        const Mesh& mesh = geometry.meshes[item.index];
        const std::uint32_t* corners =
            mesh.position_indices.data() + std::size_t{3} * element.triangle;
        return triangle_record(
            local,
            mesh.positions[corners[0]],
            mesh.positions[corners[1]],
            mesh.positions[corners[2]]);
    }
    case ItemKind::rotational_shape:
        return cylinder_record(local, geometry.rotational_shapes[item.index]);
    case ItemKind::polygon:
        return polygon_record(local, geometry.polygons[item.index], local_box);
    case ItemKind::subscene_call:
        return record_of(ElementRecord::Kind::call, local_box.lower, local_box.upper, {});
    }
    VERA_CHECK(false);
}

} // namespace vera::detail
