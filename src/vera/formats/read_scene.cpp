// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/read_scene.h"

#include "vera/formats/mesh_file.h"
#include "vera/formats/nff.h"
#include "vera/formats/obj_parts.h"
#include "vera/formats/source_text.h"
#include "vera/formats/vera_scene.h"

#include <array>
#include <string>
#include <utility>

namespace vera {

namespace {

constexpr std::array<std::pair<std::string_view, SceneFormat>, 5> formats = {{
    {"vera", SceneFormat::vera},
    {"nff", SceneFormat::nff},
    {"obj", SceneFormat::obj},
    {"ply", SceneFormat::ply},
    {"stl", SceneFormat::stl},
}};

SceneFile mesh_scene(const SourceText& text, SceneFormat format) {
    SceneFile file;
    file.scene.files.push_back(text.name());
    // A mesh brings neither light nor surroundings: it is shown in soft light before a pale sky.
    file.scene.defaults.ambient = {0.25, 0.25, 0.25};
    file.scene.defaults.firmament = Firmament{
        .sky = {0.62, 0.72, 0.86}, .horizon = {0.93, 0.95, 0.97}, .earth = {0.86, 0.86, 0.85}};
    if (format == SceneFormat::obj) {
        Scene parts = read_obj_parts(text, file.warnings);
        file.scene.geometry = std::move(parts.geometry);
        file.scene.materials = std::move(parts.materials);
        file.scene.files.insert(file.scene.files.end(), parts.files.begin(), parts.files.end());
        return file;
    }
    Geometry& geometry = file.scene.geometry;
    geometry.meshes.push_back(
        format == SceneFormat::ply ? read_ply(text, file.warnings) : read_stl(text, file.warnings));
    geometry.items.push_back({.kind = ItemKind::mesh, .line = 1});
    return file;
}

} // namespace

std::optional<SceneFormat> scene_format_named(std::string_view name) {
    for (const auto& [format_name, format] : formats)
        if (format_name == name)
            return format;
    return std::nullopt;
}

SceneFormat scene_format_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& letter : extension)
        if (letter >= 'A' && letter <= 'Z')
            letter = static_cast<char>(letter - 'A' + 'a');
    if (extension.empty())
        return SceneFormat::vera;
    return scene_format_named(std::string_view(extension).substr(1)).value_or(SceneFormat::vera);
}

SceneFile read_scene(const std::filesystem::path& path, const ReadSettings& settings) {
    const SourceText text(path);
    const SceneFormat format = settings.format.value_or(scene_format_of(path));
    SceneFile file = format == SceneFormat::vera ? read_vera_scene(text)
        : format == SceneFormat::nff             ? read_nff(text)
                                                 : mesh_scene(text, format);
    number_primitives(file.scene);
    check_reach(file.scene);
    return file;
}

} // namespace vera
