// SPDX-License-Identifier: Apache-2.0
#include "prepared_scene.h"

#include "vera/formats/control_file.h"
#include "vera/formats/item_place.h"
#include "vera/formats/read_scene.h"
#include "vera/formats/source_text.h"
#include "vera/scene/framing.h"
#include "vera/scene/inspection.h"

#include <filesystem>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

/// Of a scene that is framed without being asked for a margin.
constexpr double default_margin = 0.05;

/// A scene text whose author may have forgotten the camera; a mesh never has one.
Diagnostic no_camera(const Scene& scene) {
    Diagnostic diagnostic;
    diagnostic.severity = Severity::warning;
    if (!scene.files.empty())
        diagnostic.place.file = scene.files.front();
    diagnostic.problem = "there is no PROJECTION or PARALLEL: the whole scene is framed";
    diagnostic.remedy = "add one, or say that this is meant: FRAME in the control file, or --frame";
    return diagnostic;
}

Camera camera_of(const Scene& scene, const PictureSettings& settings) {
    const FrameSettings frame = {
        .width = settings.width,
        .height = settings.height,
        .margin = settings.frame_margin.value_or(default_margin),
        .pixel_aspect = settings.pixel_aspect};
    if (!scene.camera)
        return framed_camera(scene, frame);
    if (!settings.frame_margin)
        return *scene.camera;
    return reframed_camera(scene, *scene.camera, frame);
}

} // namespace

Diagnostic diagnostic_of(
    Severity severity,
    const Scene& scene,
    const std::optional<Item>& item,
    std::string problem,
    std::string remedy) {
    Diagnostic diagnostic;
    diagnostic.severity = severity;
    if (item && item->file < scene.files.size()) {
        const std::string& file = scene.files[item->file];
        try {
            const SourceText text(file);
            return diagnostic_at(
                severity, item_place(*item, text), std::move(problem), std::move(remedy));
        } catch (const std::system_error&) {
            // Standard input cannot be read again.
            diagnostic.place = {file, item->line, 1};
        }
    } else if (!scene.files.empty()) {
        diagnostic.place.file = scene.files.front();
    }
    diagnostic.problem = std::move(problem);
    diagnostic.remedy = std::move(remedy);
    return diagnostic;
}

SceneFormat format_of(const SceneRequest& request) {
    return scene_format_named(request.format).value_or(scene_format_of(request.path));
}

void add_scene_options(CLI::App& command, SceneRequest& request) {
    command
        .add_option(
            "scene",
            request.path,
            "scene text (.vera), NFF scene (.nff) or mesh (.obj, .ply, .stl); - for standard input")
        ->required()
        ->type_name("SCENE");
    command
        .add_option("--scene-format", request.format, "of the scene, where its name does not tell")
        ->type_name("vera|nff|obj|ply|stl")
        ->check(CLI::IsMember({"vera", "nff", "obj", "ply", "stl"}).description(""));
    add_picture_options(command, request.picture);
}

void keep_what_was_read(
    const SceneRequest& request,
    const Scene& scene,
    const char* option,
    const std::string& output) {
    if (output.empty() || output == "-")
        return;
    std::vector<std::string> read = scene.files;
    read.push_back(request.picture.control_file);
    std::error_code none;
    for (const std::string& file : read)
        if (std::filesystem::equivalent(file, output, none)
            && std::filesystem::is_regular_file(output, none))
            throw CommandLineError(fmt::format(
                "{} would write over '{}', which is read; name another file", option, file));
}

PreparedScene prepared_scene(const SceneRequest& request) {
    SceneFile file = read_scene(request.path, {.format = scene_format_named(request.format)});
    PreparedScene prepared;
    prepared.scene = std::move(file.scene);
    prepared.warnings = std::move(file.warnings);
    prepared.settings = picture_settings(request.picture, prepared.scene, prepared.warnings);
    if (!prepared.scene.camera && !prepared.settings.frame_margin
        && format_of(request) == SceneFormat::vera)
        prepared.warnings.push_back(no_camera(prepared.scene));
    prepared.camera = camera_of(prepared.scene, prepared.settings);
    if (!prepared.scene.camera && prepared.scene.lights.empty())
        prepared.scene.lights = default_lights(prepared.scene, prepared.camera);
    scale_lights(prepared.scene, prepared.settings, request.picture.control_file);
    prepared.scene.camera = prepared.camera;
    for (const Finding& finding : inspect(prepared.scene, prepared.settings))
        prepared.warnings.push_back(diagnostic_of(
            Severity::warning, prepared.scene, finding.item, finding.problem, finding.remedy));
    return prepared;
}

} // namespace vera
