// SPDX-License-Identifier: Apache-2.0
#include "scene_objects.h"

#include "vera/scene/item_names.h"
#include "vera/scene/named_parts.h"
#include "vera/scene/primitive_location.h"

#include <optional>

#include <fmt/format.h>

namespace vera {

SceneObject SceneObjects::object(FaceId face) {
    SceneObject object;
    object.number = face.primitive + 1;
    const Geometry* geometry = &scene_.geometry;
    PrimitiveLocation location = location_of(*geometry, face.primitive);
    while (geometry->items[location.item].kind == ItemKind::subscene_call) {
        const Item& item = geometry->items[location.item];
        const SourcePlace place = places_.place(*geometry, location.item);
        geometry =
            &scene_.subscenes[static_cast<std::size_t>(geometry->calls[item.index].subscene)];
        object.calls.push_back({geometry->name, place});
        location = location_of(*geometry, location.within);
    }
    const Item& item = geometry->items[location.item];
    object.kind = name_of(item.kind);
    std::optional<std::uint64_t> triangle;
    if (item.kind == ItemKind::mesh) {
        object.kind = "triangle of a mesh";
        object.triangle = location.within + 1;
        triangle = location.within;
        const Element element = {location.item, static_cast<std::uint32_t>(location.within)};
        for (const auto part : parts_around(*geometry, stretch_of(*geometry, element).part))
            object.parts.push_back(geometry->named_parts[part].name);
    }
    object.place = places_.place(*geometry, location.item, triangle);
    return object;
}

std::string to_text(const SourcePlace& place) {
    if (place.line == 0)
        return place.file;
    return fmt::format("{}:{}:{}", place.file, place.line, place.column);
}

std::string short_name(const SceneObject& object) {
    return fmt::format("{} {} ({})", object.kind, object.number, to_text(object.place));
}

std::string material_name(const Scene& scene, MaterialId material) {
    const auto number = static_cast<std::size_t>(material);
    return number < scene.materials.size() ? scene.materials[number].name : "none";
}

} // namespace vera
