// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/facets.h"

#include "vera/base/available_memory.h"
#include "vera/base/check.h"
#include "vera/base/diagnostic.h"
#include "vera/base/long_loop.h"
#include "vera/scene/crossings.h"
#include "vera/scene/curved_facets.h"
#include "vera/scene/polygon_triangles.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace vera {

namespace {

constexpr std::size_t too_many = std::size_t{1} << 31U;

[[noreturn]] void refuse(const Scene& scene) {
    Diagnostic diagnostic;
    if (!scene.files.empty())
        diagnostic.place = {scene.files.front(), 0, 0};
    diagnostic.problem = "2147483648 plane faces or corners, or more, with subscenes counted at "
                         "each call and curved surfaces in many faces";
    diagnostic.remedy = "call the subscenes less often, or draw a part of the scene";
    throw InputError({diagnostic});
}

/// At most how many times as long the map makes a vector; a little more than that.
double largest_stretch(const Matrix3& m) {
    // The square of it is an eigenvalue of the matrix times its transposed one, and those are not
    // larger than the sum of any row's absolute values. Of turned and scaled maps it is just that.
    double largest = 0;
    for (const Vec3& row : m.rows) {
        const Vec3 products = abs(m * row);
        largest = std::max(largest, products.x + products.y + products.z);
    }
    return (1 + 0x1p-40) * std::sqrt(largest);
}

/// Whether the map makes a left hand of a right one.
bool mirrors(const Matrix3& m) {
    return determinant({{normalized(m.rows[0]), normalized(m.rows[1]), normalized(m.rows[2])}}) < 0;
}

/// A geometry of the scene, where a call puts it, and how much of it is done.
struct Visit {
    const Geometry* geometry = nullptr;
    Affine3 to_world;
    bool in_main_scene = true;
    bool mirrored = false;
    MaterialId material = inherited_material;
    std::size_t next_item = 0;
};

/// Whether a face whose normal is that of its corners' order is to be turned over.
bool against_order(Vec3 normal, Vec3 by_normal, Outside outside) {
    if (outside == Outside::by_normal)
        return dot(normal, by_normal) < 0;
    return outside == Outside::against_normal;
}

class FacetBuilder {
public:
    FacetBuilder(const Scene& scene, const Deviation& deviation, const CancelFlag* cancel)
        : scene_(scene)
        , deviation_(deviation)
        , cancel_(cancel) {}

    /// Adds the facets of all items that are not subscene calls.
    void add(const Visit& visit, const Item& item) {
        visit_ = &visit;
        material_ = item.material == inherited_material ? visit.material : item.material;
        const Geometry& geometry = *visit.geometry;
        switch (item.kind) {
        case ItemKind::sphere:
            add_curved(geometry.spheres[item.index]);
            break;
        case ItemKind::rotational_shape:
            add_curved(geometry.rotational_shapes[item.index]);
            break;
        case ItemKind::triangle:
            add_plane(
                geometry.triangles[item.index].corners, item.outside == Outside::against_normal);
            break;
        case ItemKind::polygon:
            add_polygon(geometry, geometry.polygons[item.index], item.outside);
            break;
        case ItemKind::patch: {
            const Patch& patch = geometry.patches[item.index];
            add_plane(patch.corners, patch_is_turned(patch.corners, patch.normals, item.outside));
            break;
        }
        case ItemKind::mesh:
            add_mesh(geometry.meshes[item.index], item.outside);
            return; // has counted its primitives
        case ItemKind::subscene_call:
            VERA_CHECK(item.kind != ItemKind::subscene_call);
        }
        ++primitive_;
    }

    /// Of a mesh that is all there is.
    void share_corners(const Mesh& mesh) {
        shares_corners_ = true;
        facets_.corners.share(mesh.positions);
    }

    Facets take() { return std::move(facets_); }

private:
    static constexpr std::uint32_t no_corner = 0xffffffff;

    std::uint32_t add_corner(Vec3 local) {
        if (facets_.corners.size() + 1 >= too_many)
            refuse(scene_);
        facets_.corners.push_back(to_world(local));
        return static_cast<std::uint32_t>(facets_.corners.size() - 1);
    }

    Vec3 to_world(Vec3 local) const {
        return visit_->in_main_scene ? local : transformed_point(visit_->to_world, local);
    }

    void add_triangle(std::array<std::uint32_t, 3> corners, std::uint32_t piece, bool turned) {
        if (facets_.triangles.size() + 1 >= too_many)
            refuse(scene_);
        if (facets_.triangles.size() == facets_.triangles.capacity())
            make_room();
        if (turned != visit_->mirrored)
            std::swap(corners[1], corners[2]);
        facets_.triangles.push_back({corners, piece, primitive_, material_});
    }

    /// By a quarter: after a large mesh, which has room of its own, a floor must not double it.
    void make_room() {
        const std::size_t count = facets_.triangles.size();
        const std::size_t room = count + std::max(count / 4, std::size_t{1024});
        require_room(room);
        facets_.triangles.reserve(room);
    }

    /// For so many facets, for which the list makes room next, with what is made of each at once.
    void require_room(std::size_t count) const {
        constexpr double per_facet = 250;
        require_memory(
            per_facet * static_cast<double>(count),
            "the scene in " + std::to_string(count) + " facets",
            "a larger --deviation makes fewer of curved surfaces, and simpler meshes have fewer");
    }

    void add_plane(const std::array<Vec3, 3>& corners, bool turned) {
        const std::uint32_t first = add_corner(corners[0]);
        add_corner(corners[1]);
        add_corner(corners[2]);
        add_triangle({first, first + 1, first + 2}, 0, turned);
    }

    static bool patch_is_turned(
        const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals, Outside outside) {
        const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        return against_order(
            normalized(normal), normalized(normals[0] + normals[1] + normals[2]), outside);
    }

    void add_polygon(const Geometry& geometry, const Polygon& polygon, Outside outside) {
        const std::span<const Vec3> corners = corners_of(geometry, polygon);
        const bool turned = outside == Outside::against_normal;
        const auto first = static_cast<std::uint32_t>(facets_.corners.size());
        for (const Vec3& corner : corners)
            add_corner(corner);
        if (polygon.shape == Polygon::Shape::split_quadrangle) {
            add_triangle({first, first + 1, first + 2}, 0, turned);
            add_triangle({first, first + 2, first + 3}, 1, turned);
            return;
        }
        split_polygon(corners, triples_);
        for (const CornerTriple& triple : triples_)
            add_triangle({first + triple[0], first + triple[1], first + triple[2]}, 0, turned);
    }

    /// Room for so many more, and for twice as many as there are: many small meshes take no longer.
    template <typename List>
    static std::size_t room_for(const List& list, std::size_t more) {
        return std::max(list.size() + more, 2 * list.size());
    }

    void reserve_for(const Mesh& mesh) {
        const std::size_t count = mesh.triangle_count();
        if (facets_.triangles.size() + count > facets_.triangles.capacity()) {
            const std::size_t room = room_for(facets_.triangles, count);
            require_room(room);
            facets_.triangles.reserve(room);
        }
        if (shares_corners_)
            return;
        const std::size_t corners = std::min(mesh.positions.size(), 3 * count);
        if (facets_.corners.size() + corners > facets_.corners.capacity())
            facets_.corners.reserve(room_for(facets_.corners, corners));
    }

    void add_mesh(const Mesh& mesh, Outside outside) {
        reserve_for(mesh);
        if (!shares_corners_)
            mesh_corners_.assign(mesh.positions.size(), no_corner);
        const auto& normal_indices =
            mesh.normal_indices.empty() ? mesh.position_indices : mesh.normal_indices;
        const LongLoop loop(mesh.triangle_count(), {}, cancel_);
        for (std::uint32_t i = 0; i < mesh.triangle_count(); ++i) {
            loop.turn(i);
            const std::size_t first = 3 * std::size_t{i};
            std::array<std::uint32_t, 3> corners = {};
            std::array<Vec3, 3> normals;
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint32_t position = mesh.position_indices[first + c];
                corners[c] = shares_corners_ ? position : corner_of(mesh, position);
                if (!mesh.normals.empty())
                    normals[c] = mesh.normals[normal_indices[first + c]];
            }
            add_triangle(corners, 0, patch_is_turned(corners_of(mesh, i), normals, outside));
            ++primitive_;
        }
    }

    std::uint32_t corner_of(const Mesh& mesh, std::uint32_t position) {
        std::uint32_t& corner = mesh_corners_[position];
        if (corner == no_corner)
            corner = add_corner(mesh.positions[position]);
        return corner;
    }

    template <typename Primitive>
    void add_curved(const Primitive& primitive) {
        const double stretch = visit_->in_main_scene ? 1 : largest_stretch(visit_->to_world.linear);
        const LocalDeviation deviation = [&](Vec3 local) {
            const double asked = deviation_(to_world(local));
            return asked > 0 ? asked / stretch : 0;
        };
        const CurvedFacets curved = curved_facets(primitive, deviation, most_facets_of_a_primitive);
        const auto first = static_cast<std::uint32_t>(facets_.corners.size());
        for (const Vec3& corner : curved.corners)
            add_corner(corner);
        for (const CurvedFacets::Triangle& triangle : curved.triangles) {
            const auto& [a, b, c] = triangle.corners;
            add_triangle({first + a, first + b, first + c}, triangle.piece, false);
        }
    }

    const Scene& scene_;
    const Deviation& deviation_;
    const CancelFlag* cancel_;
    Facets facets_;
    const Visit* visit_ = nullptr;
    MaterialId material_ = inherited_material;
    std::uint64_t primitive_ = 0;
    std::vector<CornerTriple> triples_;
    std::vector<std::uint32_t> mesh_corners_; ///< of a mesh's positions
    bool shares_corners_ = false;
};

/// The mesh that is all there is in the scene, if its faces take its positions in their order, as
/// facets have their corners; or null.
const Mesh* mesh_in_order(const Scene& scene) {
    const Geometry& geometry = scene.geometry;
    if (geometry.items.size() != 1 || geometry.items.front().kind != ItemKind::mesh)
        return nullptr;
    const Mesh& mesh = geometry.meshes[geometry.items.front().index];
    std::size_t next = 0;
    for (const std::uint32_t position : mesh.position_indices) {
        if (position > next)
            return nullptr;
        next += position == next ? 1 : 0;
    }
    return next == mesh.positions.size() && next < too_many ? &mesh : nullptr;
}

/// The subscene as the call of the geometry that is being visited puts it.
Visit called(const Scene& scene, const Visit& caller, const Item& item) {
    const SubsceneCall& call = caller.geometry->calls[item.index];
    Visit visit;
    visit.geometry = &scene.subscenes[static_cast<std::size_t>(call.subscene)];
    // As path_to() does, to the bit.
    visit.to_world = composed(caller.to_world, call.to_parent);
    visit.in_main_scene = false;
    visit.mirrored = caller.mirrored != mirrors(call.to_parent.linear);
    visit.material = item.material == inherited_material ? caller.material : item.material;
    return visit;
}

} // namespace

Facets facets(
    const Scene& scene,
    const Deviation& deviation,
    const CancelFlag* cancel,
    MeshCorners mesh_corners) {
    // Almost every primitive has a facet: what is hopeless is told before it takes all memory.
    if (scene.geometry.primitive_count >= too_many)
        refuse(scene);
    FacetBuilder builder(scene, deviation, cancel);
    if (mesh_corners == MeshCorners::shared)
        if (const Mesh* mesh = mesh_in_order(scene))
            builder.share_corners(*mesh);

    // A stack of our own: subscenes may nest to any depth.
    std::vector<Visit> stack(1);
    stack.back().geometry = &scene.geometry;
    while (!stack.empty()) {
        Visit& visit = stack.back();
        if (visit.next_item == visit.geometry->items.size()) {
            stack.pop_back();
            continue;
        }
        stop_if_raised(cancel);
        const Item& item = visit.geometry->items[visit.next_item++];
        if (item.kind != ItemKind::subscene_call) {
            builder.add(visit, item);
            continue;
        }
        const Visit next = called(scene, visit, item);
        // Empty subscenes may be called any number of times.
        if (next.geometry->primitive_count > 0)
            stack.push_back(next);
    }
    return builder.take();
}

} // namespace vera
