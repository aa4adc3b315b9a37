// SPDX-License-Identifier: Apache-2.0
#include "item_places.h"

#include "vera/formats/item_place.h"
#include "vera/formats/mesh_file.h"
#include "vera/formats/read_scene.h"

#include <system_error>
#include <utility>

namespace vera {

const ItemPlaces::File& ItemPlaces::file(const Item& item) {
    const auto [found, is_new] = files_.try_emplace(item.file);
    File& file = found->second;
    const std::string& path = scene_.files[item.file];
    if (!is_new || path == "-")
        return file;
    try {
        file.text = std::make_unique<SourceText>(path);
        if (item.kind == ItemKind::mesh && scene_format_of(path) == SceneFormat::obj)
            file.triangle_lines = obj_triangle_lines(*file.text);
    } catch (const std::system_error&) {
        // Gone since it was read; the line is known all the same.
    }
    return file;
}

std::optional<WordPlace> ItemPlaces::word(
    const Geometry& geometry, std::uint32_t number, std::optional<std::uint64_t> triangle) {
    const Item& item = geometry.items[number];
    if (item.file >= scene_.files.size())
        return std::nullopt;
    const auto& [text, triangle_lines] = file(item);
    if (!text)
        return std::nullopt;
    if (!triangle || triangle_lines.empty())
        return item_place(geometry, number, *text);
    // The meshes of a file are its triangles in their order.
    for (std::uint32_t before = 0; before < item.index; ++before)
        *triangle += geometry.meshes[before].triangle_count();
    if (*triangle >= triangle_lines.size())
        return item_place(geometry, number, *text);
    Item face = item;
    face.line = triangle_lines[*triangle];
    return item_place(face, *text);
}

SourcePlace ItemPlaces::line(const Item& item) const {
    if (item.file >= scene_.files.size())
        return {};
    return {scene_.files[item.file], item.line, 1};
}

SourcePlace ItemPlaces::place(
    const Geometry& geometry, std::uint32_t item, std::optional<std::uint64_t> triangle) {
    const auto found = word(geometry, item, triangle);
    return found ? source_place(*found) : line(geometry.items[item]);
}

Diagnostic ItemPlaces::diagnostic(
    Severity severity,
    const Geometry& geometry,
    std::uint32_t item,
    std::optional<std::uint64_t> triangle,
    std::string problem,
    std::string remedy) {
    if (const auto found = word(geometry, item, triangle))
        return diagnostic_at(severity, *found, std::move(problem), std::move(remedy));
    return {
        .severity = severity,
        .place = line(geometry.items[item]),
        .problem = std::move(problem),
        .remedy = std::move(remedy)};
}

} // namespace vera
