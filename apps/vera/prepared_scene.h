// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/read_scene.h"
#include "vera/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "picture_options.h"

namespace CLI {
class App;
} // namespace CLI

namespace vera {

/// Which scene, and how its picture is to be.
struct SceneRequest {
    std::string path;
    std::string format; ///< of the scene; empty: by the path
    PictureOptions picture;
};

/// The format in which the scene is read.
SceneFormat format_of(const SceneRequest& request);

/// SCENE, --scene-format and the picture's options.
void add_scene_options(CLI::App& command, SceneRequest& request);

/// A scene with everything that a picture of it needs.
struct PreparedScene {
    Scene scene;
    PictureSettings settings;
    Camera camera;
    std::vector<Diagnostic> warnings; ///< of the readers and of a look at the whole scene
};

/// Reads the scene and the settings, frames a scene that has no camera or is to be framed, and
/// lights one that came without camera and lights. Throws as the readers do.
PreparedScene prepared_scene(const SceneRequest& request);

/// Throws CommandLineError where what the option is to write is a file that was read. The output
/// may be empty: nothing is written.
void keep_what_was_read(
    const SceneRequest& request, const Scene& scene, const char* option, const std::string& output);

/// A diagnostic at an item of the scene, with its line where its file can be read again; of the
/// scene as a whole without one.
Diagnostic diagnostic_of(
    Severity severity,
    const Scene& scene,
    const std::optional<Item>& item,
    std::string problem,
    std::string remedy);

} // namespace vera
