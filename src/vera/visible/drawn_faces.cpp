// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/drawn_faces.h"

#include "vera/scene/surface.h"

#include <cstddef>

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

} // namespace

DrawnFaces drawn_faces(const Scene& scene, const Facets& facets, FaceUnit unit) {
    DrawnFaces faces;
    faces.of_facet.reserve(facets.triangles.size());
    bool in_one_piece = true;
    for (std::size_t i = 0; i < facets.triangles.size(); ++i) {
        const Facets::Triangle& facet = facets.triangles[i];
        const bool next_primitive = i == 0 || facet.primitive != facets.triangles[i - 1].primitive;
        const bool next_piece = next_primitive || facet.piece != facets.triangles[i - 1].piece;
        if (next_piece && unit == FaceUnit::plane)
            in_one_piece = is_plane(path_to(scene, facet.primitive), facet.piece);
        const bool begins =
            next_primitive || (unit == FaceUnit::plane && (next_piece || !in_one_piece));
        if (begins)
            faces.first_facet.push_back(static_cast<std::uint32_t>(i));
        faces.of_facet.push_back(static_cast<std::uint32_t>(faces.first_facet.size() - 1));
    }
    return faces;
}

} // namespace vera
