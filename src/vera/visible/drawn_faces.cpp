// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/drawn_faces.h"

#include "vera/base/long_loop.h"
#include "vera/scene/surface.h"
#include "vera/visible/convex_piece.h"

#include <array>
#include <cstddef>
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

Parts parts_of(const Scene& scene, const Facets::Triangle& facet, FaceUnit unit) {
    if (unit == FaceUnit::primitive)
        return Parts::one;
    const PrimitivePath path = path_to(scene, facet.primitive);
    if (is_plane(path, facet.piece))
        return Parts::one;
    const bool sides = unit == FaceUnit::smooth && convexity(path, facet.piece) != Convexity::none;
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

DrawnFaces drawn_faces(
    const Scene& scene,
    const Facets& facets,
    FaceUnit unit,
    const Camera& camera,
    const CancelFlag* cancel) {
    constexpr std::uint32_t none = 0xffffffff;
    DrawnFaces faces;
    faces.of_facet.reserve(facets.triangles.size());
    Parts parts = Parts::one;
    std::array<std::uint32_t, 2> open = {none, none}; // that further facets of the piece belong to
    const LongLoop loop(facets.triangles.size(), {}, cancel);
    for (std::size_t i = 0; i < facets.triangles.size(); ++i) {
        loop.turn(i);
        const Facets::Triangle& facet = facets.triangles[i];
        const bool next_primitive = i == 0 || facet.primitive != facets.triangles[i - 1].primitive;
        const bool next_piece = next_primitive || facet.piece != facets.triangles[i - 1].piece;
        const bool next_unit = unit == FaceUnit::primitive ? next_primitive : next_piece;
        if (next_unit)
            parts = parts_of(scene, facet, unit);
        if (next_unit || parts == Parts::each)
            open = {none, none};
        const bool other_side = parts == Parts::by_side && !shows_outside(facets, facet, camera);
        std::uint32_t& face = open[other_side ? 1 : 0];
        if (face == none) {
            face = static_cast<std::uint32_t>(faces.first_facet.size());
            faces.first_facet.push_back(static_cast<std::uint32_t>(i));
        }
        faces.of_facet.push_back(face);
    }
    return faces;
}

void join_sources(
    ScreenScene& screen, VisiblePieces& pieces, const DrawnFaces& before, const DrawnFaces& after) {
    for (ScreenTriangle& triangle : screen.triangles)
        triangle.source = after.of_facet[before.first_facet[triangle.source]];
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
