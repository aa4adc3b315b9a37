// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/included_files.h"

#include "vera/formats/mesh_file.h"
#include "vera/formats/obj_parts.h"
#include "vera/formats/similar_file.h"
#include "vera/formats/word_reader.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <vector>

#include <fmt/format.h>

namespace vera {

namespace {

std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& letter : extension)
        if (letter >= 'A' && letter <= 'Z')
            letter = static_cast<char>(letter - 'A' + 'a');
    return extension;
}

bool is_mesh_extension(std::string_view extension) {
    constexpr std::array<std::string_view, 3> extensions = {".obj", ".ply", ".stl"};
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

} // namespace

std::optional<std::filesystem::path>
IncludedFiles::existing(std::string_view name, const WordPlace& place) {
    const auto folder = std::filesystem::path(place.text->name()).parent_path();
    // "./" so that no file name is taken for standard input.
    const auto path = (folder.empty() ? std::filesystem::path(".") : folder) / name;
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) {
        complaints_.error(
            place,
            fmt::format("there is no file {}{}", shown(name), similar_file(path, "; ")),
            "files are looked for in the folder of the file that names them");
        return std::nullopt;
    }
    if (error) {
        complaints_.error(place, fmt::format("cannot read {}: {}", shown(name), error.message()));
        return std::nullopt;
    }
    if (status.type() != std::filesystem::file_type::regular) {
        complaints_.error(place, fmt::format("{} is not a file", shown(name)));
        return std::nullopt;
    }
    const auto normal = path.lexically_normal();
    return normal == "-" ? path : normal;
}

const SourceText* IncludedFiles::text(std::string_view name, const WordPlace& place) {
    const auto path = existing(name, place);
    if (!path)
        return nullptr;
    const std::string extension = extension_of(*path);
    if (is_mesh_extension(extension) || extension == ".nff") {
        complaints_.error(
            place,
            fmt::format("{} is not a text in the scene language", shown(name)),
            extension == ".nff" ? "scenes in NFF are read only by themselves"
                                : "MESH reads meshes");
        return nullptr;
    }
    std::error_code error;
    auto& text = texts_[std::filesystem::canonical(*path, error)];
    if (text)
        return text.get();
    try {
        text = std::make_unique<SourceText>(*path);
    } catch (const std::system_error& failure) {
        complaints_.error(place, failure.what());
    }
    return text.get();
}

std::optional<std::filesystem::path>
IncludedFiles::mesh_path(std::string_view name, const WordPlace& place) {
    auto path = existing(name, place);
    if (path && !is_mesh_extension(extension_of(*path))) {
        complaints_.error(
            place,
            fmt::format("{} is not a mesh", shown(name)),
            "MESH reads .obj, .ply and .stl files, INCLUDE texts in the scene language");
        return std::nullopt;
    }
    return path;
}

std::optional<Scene> IncludedFiles::mesh(
    const std::filesystem::path& path, ObjMaterials materials, const WordPlace& place) {
    std::vector<Diagnostic> warnings;
    Scene scene;
    try {
        if (extension_of(path) == ".obj") {
            scene = read_obj_parts(SourceText(path), warnings, materials);
        } else {
            scene.geometry.meshes.push_back(read_mesh(path, warnings));
            scene.geometry.items.push_back({.kind = ItemKind::mesh});
        }
    } catch (const InputError& failure) {
        complaints_.add(failure.diagnostics());
        return std::nullopt;
    } catch (const std::system_error& failure) {
        complaints_.error(place, failure.what());
        return std::nullopt;
    }
    complaints_.add(warnings);
    mesh_files_.insert(path.string());
    mesh_files_.insert(scene.files.begin(), scene.files.end());
    return scene;
}

} // namespace vera
