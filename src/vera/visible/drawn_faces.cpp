// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/drawn_faces.h"

#include "vera/base/long_loop.h"
#include "vera/scene/named_parts.h"
#include "vera/scene/surface.h"
#include "vera/visible/convex_piece.h"
#include "vera/visible/coplanar_patches.h"

#include <array>
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vera {

namespace {

/// Whether all facets of that piece of the primitive lie in one plane.
bool is_plane(const PrimitivePath& path, std::uint32_t piece) {
    const Item& item = path.geometry->items[path.element.item];
    switch (item.kind) {
    case ItemKind::triangle:
    case ItemKind::mesh:
    case ItemKind::polygon:
        return true;
    case ItemKind::rotational_shape: {
        const RotationalShape& shape = path.geometry->rotational_shapes[item.index];
        const ContourPiece& contour = shape.contour[piece];
        const double begin = piece == 0 ? shape.start.h : shape.contour[piece - 1].end.h;
        return contour.kind == ContourPiece::Kind::line && contour.end.h == begin;
    }
    case ItemKind::sphere:
    case ItemKind::patch:
    case ItemKind::subscene_call:
        break;
    }
    return false;
}

/// How the facets of a piece make faces.
enum class Parts : std::uint8_t { one, each, by_side };

Parts parts_of(const PrimitivePath& path, std::uint32_t piece, FaceUnit unit) {
    if (is_plane(path, piece))
        return Parts::one;
    const bool sides = unit == FaceUnit::smooth && convexity(path, piece) != Convexity::none;
    return sides ? Parts::by_side : Parts::each;
}

} // namespace

bool shows_outside(const Facets& facets, const Facets::Triangle& facet, const Camera& camera) {
    const Vec3 a = facets.corners[facet.corners[0]];
    const Vec3 ray =
        camera.projection == Camera::Projection::parallel ? camera.direction : a - camera.viewpoint;
    const Vec3 normal =
        cross(facets.corners[facet.corners[1]] - a, facets.corners[facet.corners[2]] - a);
    return dot(normal, ray) < 0;
}

namespace {

/// Makes faces facet by facet.
class FaceMaker {
public:
    FaceMaker(
        const Scene& scene,
        const Facets& facets,
        FaceUnit unit,
        const Camera& camera,
        const CancelFlag* cancel)
        : scene_(scene)
        , facets_(facets)
        , unit_(unit)
        , camera_(camera)
        , cancel_(cancel) {
        faces_.of_facet.reserve(facets.triangles.size());
    }

    DrawnFaces make() {
        const LongLoop loop(facets_.triangles.size(), {}, cancel_);
        for (std::uint32_t i = 0; i < facets_.triangles.size(); ++i) {
            loop.turn(i);
            faces_.of_facet.push_back(face_of(i));
        }
        return std::move(faces_);
    }

private:
    static constexpr std::uint32_t none = 0xffffffff;

    /// That facets before this one have begun, or a new one.
    std::uint32_t face_of(std::uint32_t i) {
        const Facets::Triangle& facet = facets_.triangles[i];
        const bool next_primitive = i == 0 || facet.primitive != facets_.triangles[i - 1].primitive;
        const bool next_piece = next_primitive || facet.piece != facets_.triangles[i - 1].piece;
        const bool next_unit = unit_ == FaceUnit::primitive ? next_primitive : next_piece;
        // Triangles of a mesh are all alike.
        if (next_unit && unit_ != FaceUnit::primitive && i >= end_of_mesh_)
            begin_piece(i);
        if (i < end_of_mesh_ && !patches_->empty())
            if (const std::uint32_t first = first_of_mesh_ + (*patches_)[i - first_of_mesh_];
                first < i)
                return faces_.of_facet[first];
        if (next_unit || parts_ == Parts::each)
            open_ = {none, none};
        const bool other_side = parts_ == Parts::by_side && !shows_outside(facets_, facet, camera_);
        std::uint32_t& face = open_[other_side ? 1 : 0];
        if (face == none) {
            face = static_cast<std::uint32_t>(faces_.first_facet.size());
            faces_.first_facet.push_back(i);
        }
        return face;
    }

    void begin_piece(std::uint32_t i) {
        const PrimitivePath path = path_to(scene_, facets_.triangles[i].primitive);
        parts_ = parts_of(path, facets_.triangles[i].piece, unit_);
        const Item& item = path.geometry->items[path.element.item];
        if (item.kind != ItemKind::mesh)
            return;
        const Mesh& mesh = path.geometry->meshes[item.index];
        first_of_mesh_ = i;
        end_of_mesh_ = i + static_cast<std::uint32_t>(mesh.triangle_count());
        const auto [patches, is_new] = patches_of_meshes_.try_emplace(&mesh);
        if (is_new && unit_ != FaceUnit::plane)
            patches->second =
                coplanar_patches(mesh, stretch_ends(*path.geometry, path.element.item), cancel_);
        patches_ = &patches->second;
    }

    const Scene& scene_;
    const Facets& facets_;
    FaceUnit unit_;
    const Camera& camera_;
    const CancelFlag* cancel_;
    DrawnFaces faces_;
    Parts parts_ = Parts::one;
    /// The faces that further facets of the piece belong to.
    std::array<std::uint32_t, 2> open_ = {none, none};
    std::uint32_t first_of_mesh_ = 0;                     ///< of the facets of the last mesh
    std::uint32_t end_of_mesh_ = 0;                       ///< behind the last of them
    const std::vector<std::uint32_t>* patches_ = nullptr; ///< of that mesh
    /// A mesh that subscenes bring many times is looked at once.
    std::unordered_map<const Mesh*, std::vector<std::uint32_t>> patches_of_meshes_;
};

} // namespace

DrawnFaces drawn_faces(
    const Scene& scene,
    const Facets& facets,
    FaceUnit unit,
    const Camera& camera,
    const CancelFlag* cancel) {
    return FaceMaker(scene, facets, unit, camera, cancel).make();
}

void join_sources(ScreenScene& screen, const DrawnFaces& before, const DrawnFaces& after) {
    for (ScreenTriangle& triangle : screen.triangles)
        triangle.source = after.of_facet[before.first_facet[triangle.source]];
}

void join_sources(
    ScreenScene& screen, VisiblePieces& pieces, const DrawnFaces& before, const DrawnFaces& after) {
    join_sources(screen, before, after);
    const auto source = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? no_source : screen.triangles[triangle].source;
    };
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        const VisiblePiece& piece = pieces.pieces[i];
        const UnlitBeside unlit = pieces.unlit_beside(i);
        if (source(piece.left) == source(piece.right) && unlit.left == unlit.right)
            continue;
        pieces.pieces[kept] = piece;
        if (!pieces.unlit.empty())
            pieces.unlit[kept] = unlit;
        ++kept;
    }
    pieces.pieces.resize(kept);
    pieces.unlit.resize(pieces.unlit.empty() ? 0 : kept);
}

} // namespace vera
