// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/surface.h"

#include "vera/base/check.h"
#include "vera/scene/contour.h"
#include "vera/scene/crossings.h"
#include "vera/scene/primitive_location.h"

#include <algorithm>
#include <cmath>

namespace vera {

namespace {

/// A place without its material and face.
SurfacePoint on_face(Vec3 point, double point_error, Vec3 geometric_normal, Vec3 shading_normal) {
    SurfacePoint at;
    at.point = point;
    at.point_error = point_error;
    at.geometric_normal = geometric_normal;
    at.shading_normal = shading_normal;
    return at;
}

/// A point moved onto a surface through places of this size is off it by at most this: the
/// difference, the product with the normal and the step are each rounded.
double rounding_of(double size) {
    return 0x1p-50 * size;
}

Vec3 towards_outside(Vec3 normal, Vec3 by_normal, Outside outside) {
    switch (outside) {
    case Outside::along_normal:
        return normal;
    case Outside::against_normal:
        return -normal;
    case Outside::by_normal:
        break;
    }
    return dot(normal, by_normal) < 0 ? -normal : normal;
}

/// What is to be known of a plane face to place a point on it: a corner, its own normal and the
/// normal that it is shaded by, all unit.
struct PlaneFace {
    Vec3 corner;
    Vec3 normal;
    Vec3 shading_normal;
    bool is_patch = false; ///< otherwise it is shaded by its own normal, turned to the outside
};

SurfacePoint plane_surface(Vec3 point, const PlaneFace& face, Outside outside) {
    const Vec3 moved = point - dot(point - face.corner, face.normal) * face.normal;
    const double size = std::max(max_component(abs(moved)), max_component(abs(face.corner)));
    const Vec3 out = towards_outside(face.normal, face.shading_normal, outside);
    return on_face(moved, rounding_of(size), out, face.is_patch ? face.shading_normal : out);
}

Vec3 normal_of(const std::array<Vec3, 3>& corners) {
    return normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
}

PlaneFace triangle_face(const std::array<Vec3, 3>& corners) {
    const Vec3 normal = normal_of(corners);
    return {corners[0], normal, normal};
}

PlaneFace
patch_face(Vec3 point, const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals) {
    const Vec3 normal = normal_of(corners);
    // Weights of the corners: the areas of the triangles opposite to them.
    const auto area = [&](std::size_t from, std::size_t to) {
        return dot(normal, cross(corners[from] - point, corners[to] - point));
    };
    const std::array<double, 3> weights = {area(1, 2), area(2, 0), area(0, 1)};
    const Vec3 interpolated =
        weights[0] * normals[0] + weights[1] * normals[1] + weights[2] * normals[2];
    const Vec3 shading = interpolated == Vec3{} ? normal : normalized(interpolated);
    return {corners[0], normal, shading, true};
}

PlaneFace polygon_face(const Geometry& geometry, const Polygon& polygon, std::uint32_t piece) {
    const auto corners = corners_of(geometry, polygon);
    if (polygon.shape == Polygon::Shape::split_quadrangle)
        return triangle_face(corners_of_half(corners, piece));
    return {corners[0], polygon.normal, polygon.normal};
}

PlaneFace mesh_face(Vec3 point, const Mesh& mesh, std::uint32_t triangle) {
    const auto corners = corners_of(mesh, triangle);
    if (mesh.normals.empty())
        return triangle_face(corners);
    const auto& indices = mesh.normal_indices.empty() ? mesh.position_indices : mesh.normal_indices;
    const std::size_t first = 3 * std::size_t{triangle};
    return patch_face(
        point,
        corners,
        {mesh.normals[indices[first]],
         mesh.normals[indices[first + 1]],
         mesh.normals[indices[first + 2]]});
}

SurfacePoint sphere_surface(Vec3 point, const Sphere& sphere) {
    const Vec3 normal = normalized(point - sphere.center);
    const double size = max_component(abs(sphere.center)) + sphere.radius;
    return on_face(sphere.center + sphere.radius * normal, rounding_of(size), normal, normal);
}

SurfacePoint rotational_surface(Vec3 point, const RotationalShape& shape, std::uint32_t piece) {
    const Vec3 from_base = point - shape.base;
    const double h = dot(from_base, shape.axis);
    const Vec3 from_axis = from_base - h * shape.axis;
    const double r = length(from_axis);
    const Vec3 outwards = r > 0 ? from_axis / r : Vec3{};

    const ContourPiece::Point start = piece == 0 ? shape.start : shape.contour[piece - 1].end;
    const ContourPiece& contour = shape.contour[piece];
    const auto [at, along] = nearest_place(contour, start, {r, h});
    const double size = std::sqrt(along.r * along.r + along.h * along.h);
    const ContourPiece::Point out = {along.h / size, -along.r / size};

    // Along the normal onto the tangent: the way along the contour stays as the ray said.
    const double off = (r - at.r) * out.r + (h - at.h) * out.h;
    const Vec3 normal = normalized(out.r * outwards + out.h * shape.axis);
    const double reach = max_component(abs(shape.base)) + std::abs(at.h) + at.r;
    return on_face(point - off * normal, 4 * rounding_of(reach), normal, normal);
}

/// The place on the element's face in the coordinates of its own geometry, without material and
/// face.
SurfacePoint
local_surface(const Geometry& geometry, Element element, std::uint32_t piece, Vec3 point) {
    const Item& item = geometry.items[element.item];
    const auto on_plane = [&](const PlaneFace& face) {
        return plane_surface(point, face, item.outside);
    };
    switch (item.kind) {
    case ItemKind::sphere:
        return sphere_surface(point, geometry.spheres[item.index]);
    case ItemKind::rotational_shape:
        return rotational_surface(point, geometry.rotational_shapes[item.index], piece);
    case ItemKind::triangle:
        return on_plane(triangle_face(geometry.triangles[item.index].corners));
    case ItemKind::polygon:
        return on_plane(polygon_face(geometry, geometry.polygons[item.index], piece));
    case ItemKind::patch: {
        const Patch& patch = geometry.patches[item.index];
        return on_plane(patch_face(point, patch.corners, patch.normals));
    }
    case ItemKind::mesh:
        return on_plane(mesh_face(point, geometry.meshes[item.index], element.triangle));
    case ItemKind::subscene_call:
        break;
    }
    VERA_CHECK(item.kind != ItemKind::subscene_call);
    return {};
}

} // namespace

PrimitivePath path_to(const Scene& scene, std::uint64_t primitive) {
    PrimitivePath path;
    path.geometry = &scene.geometry;
    std::uint64_t number = primitive;
    while (true) {
        VERA_CHECK(number < path.geometry->primitive_count);
        const PrimitiveLocation location = location_of(*path.geometry, number);
        const Item& item = path.geometry->items[location.item];
        if (item.material != inherited_material)
            path.material = item.material;
        if (item.kind != ItemKind::subscene_call) {
            path.element = {location.item, static_cast<std::uint32_t>(location.within)};
            return path;
        }
        const SubsceneCall& call = path.geometry->calls[item.index];
        path.to_world = composed(path.to_world, call.to_parent);
        path.from_world = composed(call.from_parent, path.from_world);
        path.in_main_scene = false;
        ++path.depth;
        path.geometry = &scene.subscenes[static_cast<std::size_t>(call.subscene)];
        number = location.within;
    }
}

SurfacePoint surface_within(const PrimitivePath& path, std::uint32_t piece, Vec3 local_point) {
    return local_surface(*path.geometry, path.element, piece, local_point);
}

SurfacePoint carried_to_main_scene(const PrimitivePath& path, const SurfacePoint& local) {
    if (path.in_main_scene)
        return local;
    SurfacePoint world;
    world.point = transformed_point(path.to_world, local.point);
    const Vec3 size = abs(local.point);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Vec3 row = abs(path.to_world.linear.rows[axis]);
        // Each level's map and its inverse add their rounding to those of the composed ones.
        const double rounding = static_cast<double>(path.depth + 1) * 0x1p-48
            * (dot(row, size) + std::abs(path.to_world.translation[axis]));
        const double carried_error = local.point_error * (row.x + row.y + row.z);
        world.point_error = std::max(world.point_error, rounding + carried_error);
    }
    const Matrix3& inverse = path.from_world.linear;
    world.geometric_normal = normalized(transposed_times(inverse, local.geometric_normal));
    world.shading_normal = normalized(transposed_times(inverse, local.shading_normal));
    return world;
}

namespace {

SurfacePoint
surface_in_main_scene(const Scene& scene, PrimitiveLocation location, Vec3 point, FaceId face) {
    const Element element = {location.item, static_cast<std::uint32_t>(location.within)};
    SurfacePoint at = local_surface(scene.geometry, element, face.piece, point);
    at.material = scene.geometry.items[element.item].material;
    at.face = face;
    return at;
}

// Apart, so that the usual way is not burdened with its matrices.
[[gnu::noinline]] SurfacePoint surface_in_subscene(const Scene& scene, Vec3 point, FaceId face) {
    const PrimitivePath path = path_to(scene, face.primitive);
    const Vec3 local_point = transformed_point(path.from_world, point);
    SurfacePoint at = carried_to_main_scene(path, surface_within(path, face.piece, local_point));
    at.material = path.material;
    at.face = face;
    return at;
}

} // namespace

SurfacePoint surface_at(const Scene& scene, const Ray& ray, const Hit& hit) {
    VERA_CHECK(hit.face.primitive < scene.geometry.primitive_count);
    const PrimitiveLocation location = location_of(scene.geometry, hit.face.primitive);
    const Vec3 point = point_at(ray, hit.t);
    if (scene.geometry.items[location.item].kind == ItemKind::subscene_call)
        return surface_in_subscene(scene, point, hit.face);
    return surface_in_main_scene(scene, location, point, hit.face);
}

} // namespace vera
