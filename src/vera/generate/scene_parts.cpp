// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/scene_parts.h"

#include "vera/base/check.h"
#include "vera/scene/polygon_triangles.h"

#include <cmath>
#include <utility>

namespace vera {

namespace {

void add_item(Geometry& geometry, ItemKind kind, std::size_t index, MaterialId material) {
    geometry.items.push_back(
        {.kind = kind, .index = static_cast<std::uint32_t>(index), .material = material});
}

} // namespace

MaterialId add_material(Scene& scene, std::string name, Color diffuse) {
    Material material;
    material.name = std::move(name);
    material.drf = diffuse;
    scene.materials.push_back(std::move(material));
    return MaterialId{static_cast<std::uint32_t>(scene.materials.size() - 1)};
}

SubsceneId add_subscene(Scene& scene, std::string name) {
    scene.subscenes.emplace_back().name = std::move(name);
    return SubsceneId{static_cast<std::uint32_t>(scene.subscenes.size() - 1)};
}

Geometry& geometry_of(Scene& scene, SubsceneId subscene) {
    return scene.subscenes[static_cast<std::size_t>(subscene)];
}

void add(Geometry& geometry, const Sphere& sphere, MaterialId material) {
    add_item(geometry, ItemKind::sphere, geometry.spheres.size(), material);
    geometry.spheres.push_back(sphere);
}

void add(Geometry& geometry, const Triangle& triangle, MaterialId material) {
    add_item(geometry, ItemKind::triangle, geometry.triangles.size(), material);
    geometry.triangles.push_back(triangle);
}

void add(Geometry& geometry, RotationalShape shape, MaterialId material) {
    add_item(geometry, ItemKind::rotational_shape, geometry.rotational_shapes.size(), material);
    geometry.rotational_shapes.push_back(std::move(shape));
}

void add(Geometry& geometry, Mesh mesh, MaterialId material) {
    add_item(geometry, ItemKind::mesh, geometry.meshes.size(), material);
    geometry.meshes.push_back(std::move(mesh));
}

void add_convex_polygon(Geometry& geometry, const std::vector<Vec3>& corners, MaterialId material) {
    Vec3 area;
    for (std::size_t i = 2; i < corners.size(); ++i)
        area = area + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    add_item(geometry, ItemKind::polygon, geometry.polygons.size(), material);
    geometry.polygons.push_back(
        {static_cast<std::uint32_t>(geometry.corners.size()),
         static_cast<std::uint32_t>(corners.size()),
         Polygon::Shape::convex,
         normalized(area)});
    geometry.corners.insert(geometry.corners.end(), corners.begin(), corners.end());
}

void add_call(
    Geometry& geometry, SubsceneId subscene, const Affine3& to_parent, MaterialId material) {
    const auto back = inverse(to_parent);
    VERA_CHECK(back.has_value());
    add_item(geometry, ItemKind::subscene_call, geometry.calls.size(), material);
    geometry.calls.push_back({subscene, to_parent, *back});
}

RotationalShape cone_between(Vec3 base, double base_radius, Vec3 tip, double tip_radius) {
    RotationalShape shape;
    shape.base = base;
    shape.axis = normalized(tip - base);
    shape.start = {base_radius, 0};
    shape.contour.push_back({.end = {tip_radius, length(tip - base)}});
    return shape;
}

Affine3 turned_from_y(Vec3 direction) {
    // A half turn about y and then one about what halves the angle.
    Affine3 map;
    const Vec3 half = normalized(Vec3{0, 1, 0} + direction);
    if (length(half) == 0)
        return rotation({180, 0, 0});
    const Matrix3 identity;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) {
            // (2 h h^T - 1)(2 y y^T - 1), half turns about h and about y.
            const double reflected = 2 * half[row] * half[column] - identity.rows[row][column];
            map.linear.rows[row][column] = column == 1 ? reflected : -reflected;
        }
    return map;
}

void remove_unused_subscenes(Scene& scene) {
    std::vector<bool> used(scene.subscenes.size(), false);
    std::vector<const Geometry*> callers = {&scene.geometry};
    while (!callers.empty()) {
        const Geometry& caller = *callers.back();
        callers.pop_back();
        for (const SubsceneCall& call : caller.calls) {
            const auto callee = static_cast<std::size_t>(call.subscene);
            if (used[callee])
                continue;
            used[callee] = true;
            callers.push_back(&scene.subscenes[callee]);
        }
    }
    std::vector<SubsceneId> numbers(used.size());
    std::vector<Geometry> kept;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) {
            numbers[i] = SubsceneId{static_cast<std::uint32_t>(kept.size())};
            kept.push_back(std::move(scene.subscenes[i]));
        }
    scene.subscenes = std::move(kept);
    const auto renumber = [&](Geometry& geometry) {
        for (SubsceneCall& call : geometry.calls)
            call.subscene = numbers[static_cast<std::size_t>(call.subscene)];
    };
    renumber(scene.geometry);
    for (Geometry& subscene : scene.subscenes)
        renumber(subscene);
}

Vec3 short_decimals(Vec3 a) {
    constexpr double million = 1e6;
    // A quotient of whole numbers is the double nearest to the decimal, and so is printed as that.
    const auto rounded = [](double x) { return std::floor(x * million + 0.5) / million + 0.0; };
    return {rounded(a.x), rounded(a.y), rounded(a.z)};
}

Affine3 short_decimals(const Affine3& map) {
    Affine3 rounded;
    for (std::size_t row = 0; row < 3; ++row)
        rounded.linear.rows[row] = short_decimals(map.linear.rows[row]);
    rounded.translation = short_decimals(map.translation);
    return rounded;
}

} // namespace vera
