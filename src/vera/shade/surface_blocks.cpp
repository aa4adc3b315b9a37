// SPDX-License-Identifier: Apache-2.0
#include "vera/shade/surface_blocks.h"

#include "vera/base/check.h"
#include "vera/scene/crossings.h"
#include "vera/scene/primitive_location.h"

#include <cstddef>
#include <cstdint>

#ifndef VERA_SHADE_SURFACE_BLOCKS_ONCE
#define VERA_SHADE_SURFACE_BLOCKS_ONCE

namespace vera::detail {

/// What is to be known of the faces to place points on them. A lane's meaning depends on the kind
/// of its face:
///
///   sphere    center                               radius
///   plane     corner, normal                       1, or -1 where the outside is behind
///   triangle  corner, corner, corner               the same
///   patch     corner, corner, corner,              the same, or 0 where the normals tell
///             normal, normal, normal
///   line      base, axis                           radius and height of its start, then of its end
struct FaceRows {
    enum Kind : std::uint8_t { sphere, plane, triangle, patch, line };

    static constexpr std::size_t kinds = 5;

    std::array<BlockLanes, kinds> lanes = {}; ///< by kind
    std::array<BlockRows, 6> vectors = {};
    std::array<BlockRow, 4> numbers = {};
};

} // namespace vera::detail

#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/shade/surface_blocks.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/shade/block_lanes-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using detail::FaceRows;

// The functions of surface.cpp are written here with the same operations in the same order. Lanes
// of vectors whose length is computed in another way there are counted as unusual, and left to it.

HWY_INLINE Vec3s operator+(const Vec3s& a, const Vec3s& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

HWY_INLINE Vec3s cross(const Vec3s& a, const Vec3s& b) {
    return {
        hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
        hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
        hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// Lanes of which something is not known here.
struct Unusual {
    Mask lanes;

    HWY_INLINE Vec length(const Vec3s& a) {
        lanes = hn::Or(lanes, hn::Not(has_usual_length(largest_component(a))));
        return hn::Sqrt(dot(a, a));
    }

    HWY_INLINE Vec3s normalized(const Vec3s& a) { return a / length(a); }
};

struct Placed {
    Vec3s point;
    Vec error;
    Vec3s normal;
    Vec3s shading_normal;
};

HWY_INLINE void put_placed(
    PlaceBlock& block,
    std::size_t lane,
    const Placed& placed,
    const Unusual& unusual,
    Mask of_kind) {
    const Mask known = hn::AndNot(unusual.lanes, of_kind);
    store(chosen(known, placed.point, rows(block.point, lane)), block.point, lane);
    store(
        hn::IfThenElse(known, placed.error, row(block.point_error, lane)), block.point_error, lane);
    store(
        chosen(known, placed.normal, rows(block.geometric_normal, lane)),
        block.geometric_normal,
        lane);
    store(chosen(known, placed.shading_normal, rows(block.normal, lane)), block.normal, lane);
}

HWY_INLINE Vec rounding_of(Vec size) {
    return hn::Mul(all(0x1p-50), size);
}

HWY_INLINE Placed
on_spheres(const Vec3s& point, const FaceRows& faces, std::size_t lane, Unusual& unusual) {
    const Vec3s center = rows(faces.vectors[0], lane);
    const Vec radius = row(faces.numbers[0], lane);
    const Vec3s normal = unusual.normalized(point - center);
    const Vec size = hn::Add(largest_component(center), radius);
    return {center + radius * normal, rounding_of(size), normal, normal};
}

HWY_INLINE Placed
on_planes(const Vec3s& point, const Vec3s& corner, const Vec3s& normal, Vec turn) {
    const Vec3s moved = point - dot(point - corner, normal) * normal;
    const Vec size = hn::Max(largest_component(moved), largest_component(corner));
    const Vec3s out = turn * normal;
    return {moved, rounding_of(size), out, out};
}

struct Triangles {
    Vec3s corner[3];
    Vec3s normal;
};

HWY_INLINE Triangles triangles(const FaceRows& faces, std::size_t lane, Unusual& unusual) {
    Triangles result = {
        {rows(faces.vectors[0], lane), rows(faces.vectors[1], lane), rows(faces.vectors[2], lane)},
        {all(0), all(0), all(0)}};
    const auto& corner = result.corner;
    result.normal = unusual.normalized(cross(corner[1] - corner[0], corner[2] - corner[0]));
    return result;
}

HWY_INLINE Placed
on_triangles(const Vec3s& point, const FaceRows& faces, std::size_t lane, Unusual& unusual) {
    const Triangles t = triangles(faces, lane, unusual);
    return on_planes(point, t.corner[0], t.normal, row(faces.numbers[0], lane));
}

HWY_INLINE Placed
on_patches(const Vec3s& point, const FaceRows& faces, std::size_t lane, Unusual& unusual) {
    const Triangles t = triangles(faces, lane, unusual);
    const auto weighed = [&](std::size_t from, std::size_t to, std::size_t opposite) HWY_ATTR {
        const Vec area = dot(t.normal, cross(t.corner[from] - point, t.corner[to] - point));
        return area * rows(faces.vectors[3 + opposite], lane);
    };
    const Vec3s sum = weighed(1, 2, 0) + weighed(2, 0, 1) + weighed(0, 1, 2);
    const Vec3s shading = unusual.normalized(sum);
    const Vec by_normals = hn::IfThenElse(hn::Lt(dot(t.normal, shading), all(0)), all(-1), all(1));
    const Vec turn = row(faces.numbers[0], lane);
    Placed placed = on_planes(
        point, t.corner[0], t.normal, hn::IfThenElse(hn::Eq(turn, all(0)), by_normals, turn));
    placed.shading_normal = shading;
    return placed;
}

/// Of a contour: radius and height.
struct Places {
    Vec r;
    Vec h;
};

HWY_INLINE Vec dot(const Places& a, const Places& b) {
    return hn::Add(hn::Mul(a.r, b.r), hn::Mul(a.h, b.h));
}

HWY_INLINE Places operator-(const Places& a, const Places& b) {
    return {hn::Sub(a.r, b.r), hn::Sub(a.h, b.h)};
}

HWY_INLINE Places mix(const Places& a, const Places& b, Vec v) {
    const Vec rest = hn::Sub(all(1), v);
    return {
        hn::Add(hn::Mul(rest, a.r), hn::Mul(v, b.r)), hn::Add(hn::Mul(rest, a.h), hn::Mul(v, b.h))};
}

HWY_INLINE Places chosen(Mask mask, const Places& a, const Places& b) {
    return {hn::IfThenElse(mask, a.r, b.r), hn::IfThenElse(mask, a.h, b.h)};
}

HWY_INLINE Placed
on_lines(const Vec3s& point, const FaceRows& faces, std::size_t lane, Unusual& unusual) {
    const Vec3s base = rows(faces.vectors[0], lane);
    const Vec3s axis = rows(faces.vectors[1], lane);
    const Places start = {row(faces.numbers[0], lane), row(faces.numbers[1], lane)};
    const Places end = {row(faces.numbers[2], lane), row(faces.numbers[3], lane)};
    const Vec3s from_base = point - base;
    const Vec h = dot(from_base, axis);
    const Vec3s from_axis = from_base - h * axis;
    const Vec r = unusual.length(from_axis);
    const Vec3s outwards = from_axis / r;

    // nearest_place()
    const Places whole = end - start;
    const Vec along_line = hn::Div(dot(Places{r, h} - start, whole), dot(whole, whole));
    const Vec v = hn::IfThenElseZero(
        hn::Gt(along_line, all(0)), hn::IfThenElse(hn::Lt(all(1), along_line), all(1), along_line));
    const Places inner = chosen(hn::Ge(v, all(1)), end, mix(start, end, v));
    const Places at = chosen(hn::Le(v, all(0)), start, inner);
    const Places mixed = mix(whole, whole, v);
    const Places along = mix(mixed, mixed, v);
    unusual.lanes =
        hn::Or(unusual.lanes, hn::And(hn::Eq(along.r, all(0)), hn::Eq(along.h, all(0))));

    const Vec size = hn::Sqrt(dot(along, along));
    const Places out = {hn::Div(along.h, size), hn::Div(hn::Neg(along.r), size)};
    const Vec off = dot(Places{r, h} - at, out);
    const Vec3s normal = unusual.normalized(out.r * outwards + out.h * axis);
    const Vec reach = hn::Add(hn::Add(largest_component(base), hn::Abs(at.h)), at.r);
    return {point - off * normal, hn::Mul(all(4), rounding_of(reach)), normal, normal};
}

/// Places the points of the block, as rays meet their faces, on these; returns the lanes of faces
/// that are none of the kinds, or unusual.
BlockLanes place_on_faces(const FaceRows& faces, PlaceBlock& block) {
    BlockLanes done = 0;
    for (std::size_t lane = 0; lane < block_size; lane += hn::Lanes(Doubles())) {
        const Vec3s point = rows(block.point, lane);
        const auto place = [&](FaceRows::Kind kind, const auto& placed_on) HWY_ATTR {
            const Mask of_kind = mask_of(faces.lanes[kind], lane);
            if (hn::AllFalse(Doubles(), of_kind))
                return;
            Unusual unusual = {hn::Lt(all(0), all(0))};
            put_placed(block, lane, placed_on(unusual), unusual, of_kind);
            done |= bits(hn::AndNot(unusual.lanes, of_kind), lane);
        };
        place(FaceRows::sphere, [&](Unusual& unusual) HWY_ATTR {
            return on_spheres(point, faces, lane, unusual);
        });
        place(FaceRows::plane, [&](Unusual&) HWY_ATTR {
            return on_planes(
                point,
                rows(faces.vectors[0], lane),
                rows(faces.vectors[1], lane),
                row(faces.numbers[0], lane));
        });
        place(FaceRows::triangle, [&](Unusual& unusual) HWY_ATTR {
            return on_triangles(point, faces, lane, unusual);
        });
        place(FaceRows::patch, [&](Unusual& unusual) HWY_ATTR {
            return on_patches(point, faces, lane, unusual);
        });
        place(FaceRows::line, [&](Unusual& unusual) HWY_ATTR {
            return on_lines(point, faces, lane, unusual);
        });
    }
    return block.lanes & ~done;
}

} // namespace vera::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera {

HWY_EXPORT(place_on_faces);

namespace {

using detail::FaceRows;

/// Puts what is known of a face into a lane, if it is of one of the kinds.
class FaceLane {
public:
    FaceLane(FaceRows& faces, std::size_t lane)
        : faces_(faces)
        , lane_(lane) {}

    void put(const Geometry& geometry, const Item& item, const Element& element, FaceId face) {
        switch (item.kind) {
        case ItemKind::sphere: {
            const Sphere& sphere = geometry.spheres[item.index];
            is(FaceRows::sphere);
            put(0, sphere.center);
            faces_.numbers[0][lane_] = sphere.radius;
            return;
        }
        case ItemKind::rotational_shape:
            return put_line(geometry.rotational_shapes[item.index], face.piece);
        case ItemKind::triangle:
            return put_triangle(geometry.triangles[item.index].corners, item.outside);
        case ItemKind::polygon: {
            const Polygon& polygon = geometry.polygons[item.index];
            const auto corners = corners_of(geometry, polygon);
            if (polygon.shape == Polygon::Shape::split_quadrangle)
                return put_triangle(corners_of_half(corners, face.piece), item.outside);
            is(FaceRows::plane);
            put(0, corners[0]);
            put(1, polygon.normal);
            put_turn(item.outside);
            return;
        }
        case ItemKind::mesh: {
            const Mesh& mesh = geometry.meshes[item.index];
            const auto corners = corners_of(mesh, element.triangle);
            if (mesh.normals.empty())
                return put_triangle(corners, item.outside);
            const auto& indices =
                mesh.normal_indices.empty() ? mesh.position_indices : mesh.normal_indices;
            const std::uint32_t* const three = &indices[3 * std::size_t{element.triangle}];
            return put_patch(
                corners,
                {mesh.normals[three[0]], mesh.normals[three[1]], mesh.normals[three[2]]},
                item.outside);
        }
        case ItemKind::patch: {
            const Patch& patch = geometry.patches[item.index];
            return put_patch(patch.corners, patch.normals, item.outside);
        }
        case ItemKind::subscene_call:
            return;
        }
    }

private:
    void is(FaceRows::Kind kind) { faces_.lanes[kind] |= BlockLanes{1} << lane_; }

    void put(std::size_t i, Vec3 vector) { vera::put(faces_.vectors[i], lane_, vector); }

    /// A normal is turned to the outside as itself says, where that is asked.
    void put_turn(Outside outside) {
        faces_.numbers[0][lane_] = outside == Outside::against_normal ? -1 : 1;
    }

    void put_triangle(const std::array<Vec3, 3>& corners, Outside outside) {
        is(FaceRows::triangle);
        put_corners(corners, outside);
    }

    void put_corners(const std::array<Vec3, 3>& corners, Outside outside) {
        for (std::size_t i = 0; i < 3; ++i)
            put(i, corners[i]);
        put_turn(outside);
    }

    void put_patch(
        const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals, Outside outside) {
        is(FaceRows::patch);
        put_corners(corners, outside);
        for (std::size_t i = 0; i < 3; ++i)
            put(3 + i, normals[i]);
        if (outside == Outside::by_normal)
            faces_.numbers[0][lane_] = 0;
    }

    void put_line(const RotationalShape& shape, std::uint32_t piece) {
        if (shape.contour[piece].kind != ContourPiece::Kind::line)
            return;
        const ContourPiece::Point start = piece == 0 ? shape.start : shape.contour[piece - 1].end;
        const ContourPiece::Point end = shape.contour[piece].end;
        is(FaceRows::line);
        put(0, shape.base);
        put(1, shape.axis);
        faces_.numbers[0][lane_] = start.r;
        faces_.numbers[1][lane_] = start.h;
        faces_.numbers[2][lane_] = end.r;
        faces_.numbers[3][lane_] = end.h;
    }

    FaceRows& faces_;
    std::size_t lane_;
};

} // namespace

std::array<MaterialId, block_size>
put_surfaces(const Scene& scene, std::span<const MetFace> met, PlaceBlock& block) {
    std::array<MaterialId, block_size> materials = {};
    // Where a lane holds no face of a kind, old numbers are as good as any.
    thread_local constinit FaceRows faces;
    faces.lanes = {};
    const Geometry& geometry = scene.geometry;
    for (std::size_t lane = 0; lane < met.size(); ++lane) {
        const Ray& ray = *met[lane].ray;
        const Hit& hit = *met[lane].hit;
        VERA_CHECK(hit.face.primitive < geometry.primitive_count);
        const PrimitiveLocation location = location_of(geometry, hit.face.primitive);
        const Element element = {location.item, static_cast<std::uint32_t>(location.within)};
        const Item& item = geometry.items[location.item];
        materials[lane] = item.material;
        put(block.point, lane, point_at(ray, hit.t));
        put(block.to_viewer, lane, -ray.direction);
        FaceLane(faces, lane).put(geometry, item, element, hit.face);
    }
    block.lanes = (BlockLanes{1} << met.size()) - 1;
    const BlockLanes others = HWY_DYNAMIC_DISPATCH(place_on_faces)(faces, block);
    for_each_lane(others, [&](std::size_t lane) {
        const SurfacePoint surface = surface_at(scene, *met[lane].ray, *met[lane].hit);
        put_surface(block, lane, surface, met[lane].ray->direction);
        materials[lane] = surface.material;
    });
    return materials;
}

} // namespace vera

#endif
