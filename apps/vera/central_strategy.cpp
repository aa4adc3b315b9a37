// SPDX-License-Identifier: Apache-2.0
#include "central_strategy.h"

#include "vera/formats/word_reader.h"
#include "vera/scene/facets.h"
#include "vera/visible/projection.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "command.h"
#include <fmt/format.h>

namespace vera {

namespace {

/// How far facets may lie off a curved surface, in pixels, as those of other strategies.
constexpr double largest_deviation = 1.0 / 64;

/// As seen from the view point, on all sides: what lies behind the viewer throws shadows as well.
Facets all_facets(const PreparedScene& prepared, const CancelFlag& cancel) {
    constexpr double least_distance = 0x1p-16; // of the image plane's, as where pictures begin
    const Camera& camera = prepared.camera;
    const CameraMap camera_map(camera);
    const Vec3 middle = 0.5 * (camera.lower_right + camera.upper_left);
    const double to_middle = length(middle - camera.viewpoint);
    const double largest = largest_deviation
        * camera_map.size_of_pixel(prepared.settings.width, prepared.settings.height, middle);
    const auto deviation = [&](Vec3 point) {
        return largest * std::max(length(point - camera.viewpoint) / to_middle, least_distance);
    };
    return facets(prepared.scene, deviation, &cancel);
}

[[noreturn]] void throw_sends_on(const Material& material, const char* why, const char* remedy) {
    throw CommandLineError(fmt::format(
        "--strategy central answers rays from the viewer and the lights alone, and material {} "
        "{}: {}",
        shown(material.name),
        why,
        remedy));
}

bool sends_refracted(const PictureSettings& settings, const Material& material) {
    return !is_black(material.tab) && (settings.depth > 1 || settings.shadows);
}

bool sends_mirrored(const PictureSettings& settings, const Material& material) {
    return !is_black(material.rab) && settings.depth > 1;
}

/// The materials that anything has.
std::set<MaterialId> used_materials(const Scene& scene, const CancelFlag& cancel) {
    const Facets coarse = facets(
        scene, [](Vec3) { return std::numeric_limits<double>::infinity(); }, &cancel);
    std::set<MaterialId> used;
    for (const Facets::Triangle& facet : coarse.triangles)
        used.insert(facet.material);
    return used;
}

void check_materials(const PreparedScene& prepared, const CancelFlag& cancel) {
    const Scene& scene = prepared.scene;
    const PictureSettings& settings = prepared.settings;
    const auto sends_on = [&](const Material& material) {
        return sends_refracted(settings, material) || sends_mirrored(settings, material);
    };
    if (std::none_of(scene.materials.begin(), scene.materials.end(), sends_on))
        return;
    for (const MaterialId id : used_materials(scene, cancel)) {
        if (id == inherited_material)
            continue;
        const Material& material = scene.materials[static_cast<std::size_t>(id)];
        if (sends_refracted(settings, material))
            throw_sends_on(
                material,
                "lets light through (TAB)",
                "leave --strategy out, or give --strategy visible or depth");
        if (sends_mirrored(settings, material))
            throw_sends_on(
                material,
                "mirrors (RAB)",
                "give --depth 1, which leaves mirrored rays out, or leave --strategy out");
    }
}

} // namespace

std::unique_ptr<CentralIndex>
central_index(const PreparedScene& prepared, const Progress& progress, const CancelFlag& cancel) {
    if (prepared.camera.projection == Camera::Projection::parallel)
        throw CommandLineError(
            "--strategy central answers rays from one point, and those of PARALLEL have none in "
            "common: give a PROJECTION, or leave --strategy out");
    check_materials(prepared, cancel);
    auto all = std::make_unique<const Facets>(all_facets(prepared, cancel));
    CentralIndexSettings settings;
    settings.viewpoint = prepared.camera.viewpoint;
    settings.shadows = prepared.settings.shadows;
    return std::make_unique<CentralIndex>(
        prepared.scene, std::move(all), settings, progress, &cancel);
}

} // namespace vera
