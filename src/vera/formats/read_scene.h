// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/scene_file.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace vera {

/// The formats that scenes are read from. A mesh is a scene of one item, without camera and lights.
enum class SceneFormat : std::uint8_t { vera, nff, obj, ply, stl };

/// The format of that name ("vera", "nff", "obj", "ply", "stl"), or nothing.
std::optional<SceneFormat> scene_format_named(std::string_view name);

/// The format that a path is read in when none is given: by its extension, VERA where that says
/// nothing.
SceneFormat scene_format_of(const std::filesystem::path& path);

/// How to read a scene.
struct ReadSettings {
    std::optional<SceneFormat> format; ///< nothing: by the file name's extension, else VERA
};

/// The scene that a file describes; "-" is standard input. Every material, subscene and file that
/// it names exists, no subscene calls itself, and number_primitives has been called. Throws
/// InputError with all that is wrong, and std::system_error when the file cannot be read.
SceneFile read_scene(const std::filesystem::path& path, const ReadSettings& settings = {});

} // namespace vera
