// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/scene/scene.h"

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
} // namespace CLI

namespace vera {

/// The control file and the command line's words that override it, as they were given.
struct PictureOptions {
    std::string control_file;
    std::string raster;
    std::string shadows;
    std::string antialias;
    std::vector<double> ambient;
    std::vector<double> sky;
    std::vector<double> horizon;
    std::vector<double> earth;
    std::optional<double> depth;
    std::optional<double> samples;
    std::optional<double> tolerance;
    std::optional<double> exposure;
    std::optional<double> frame_margin;
    std::optional<double> pixel_aspect;
};

/// -c and everything that overrides a control file.
void add_picture_options(CLI::App& command, PictureOptions& options);

/// The settings of the picture: the control file's, else the scene's defaults, with the command
/// line's in their place. Throws InputError for a wrong control file, CommandLineError for a wrong
/// option.
PictureSettings picture_settings(
    const PictureOptions& options, const Scene& scene, std::vector<Diagnostic>& warnings);

/// The settings as a picture's metadata tells them: control file statements in a fixed order.
std::string control_text(const PictureSettings& settings);

} // namespace vera
