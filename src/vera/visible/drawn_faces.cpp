// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/drawn_faces.h"

#include "vera/scene/surface.h"

#include <cstddef>

namespace vera {

namespace {

bool is_plane(const PrimitivePath& path) {
    const Item& item = path.geometry->items[path.element.item];
    switch (item.kind) {
    case ItemKind::triangle:
    case ItemKind::mesh:
        return true;
    case ItemKind::polygon:
        return path.geometry->polygons[item.index].shape != Polygon::Shape::split_quadrangle;
    case ItemKind::sphere:
    case ItemKind::patch:
    case ItemKind::rotational_shape:
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
        const std::uint64_t primitive = facets.triangles[i].primitive;
        const bool begins = i == 0 || primitive != facets.triangles[i - 1].primitive;
        if (begins)
            in_one_piece = unit == FaceUnit::primitive || is_plane(path_to(scene, primitive));
        if (begins || !in_one_piece)
            faces.first_facet.push_back(static_cast<std::uint32_t>(i));
        faces.of_facet.push_back(static_cast<std::uint32_t>(faces.first_facet.size() - 1));
    }
    return faces;
}

} // namespace vera
