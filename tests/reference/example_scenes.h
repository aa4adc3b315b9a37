// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/control_file.h"
#include "vera/formats/read_scene.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace vera::reference {

/// An example from scenes/, with the settings of its control file for a small raster.
struct Example {
    Scene scene;
    PictureSettings settings;
};

inline std::filesystem::path source_folder() {
    return VERA_SOURCE_DIR;
}

/// The files of all examples, so that a new one is tested without another word.
inline std::vector<std::string> example_files() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "scenes"))
        if (entry.path().extension() == ".vera" || entry.path().extension() == ".nff")
            files.push_back(entry.path().filename().string());
    std::sort(files.begin(), files.end());
    return files;
}

inline std::string example_name(const ::testing::TestParamInfo<std::string>& info) {
    return std::filesystem::path(info.param).stem().string();
}

/// The example in its own proportions, `width` pixels across.
inline Example example(const std::string& file, std::uint32_t width) {
    const std::filesystem::path path = source_folder() / "scenes" / file;
    SceneFile read = read_scene(path);
    Example result = {std::move(read.scene), {}};
    result.settings = result.scene.defaults;
    const std::filesystem::path control = std::filesystem::path(path).replace_extension(".ctl");
    if (std::filesystem::exists(control))
        result.settings = read_control_file(control, result.scene.defaults, read.warnings);
    result.settings.height = width * result.settings.height / result.settings.width;
    result.settings.width = width;
    return result;
}

} // namespace vera::reference
