// SPDX-License-Identifier: Apache-2.0
#include "picture_metadata.h"

#include "vera/base/version.h"
#include "vera/formats/source_text.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>

namespace vera {

namespace {

/// FNV-1a over all files that the scene was read from: tells two versions of a scene apart.
std::string scene_hash(const Scene& scene) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const std::string& path : scene.files) {
        if (path == "-" || !std::filesystem::is_regular_file(path))
            continue;
        const SourceText file(path);
        for (const char letter : file.text()) {
            hash ^= static_cast<unsigned char>(letter);
            hash *= 0x100000001b3;
        }
    }
    return fmt::format("{:016x}", hash);
}

} // namespace

PictureMetadata picture_metadata(const PreparedScene& prepared) {
    const auto point = [](Vec3 p) { return fmt::format("{} {} {}", p.x, p.y, p.z); };
    const Camera& camera = prepared.camera;
    const bool parallel = camera.projection == Camera::Projection::parallel;
    return {
        {"Software", fmt::format("vera {}", version)},
        {"Scene hash", scene_hash(prepared.scene)},
        {"Settings", control_text(prepared.settings)},
        {"Camera",
         fmt::format(
             "{} {} {} {} {}",
             parallel ? "PARALLEL" : "PROJECTION",
             point(parallel ? camera.direction : camera.viewpoint),
             point(camera.lower_left),
             point(camera.lower_right),
             point(camera.upper_left))}};
}

} // namespace vera
