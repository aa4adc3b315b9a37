// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/grid_cells.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <string>

#include "command.h"

namespace CLI {
class App;
} // namespace CLI

namespace vera {

/// How the tree of grids is shown.
struct GridPictureRequest {
    std::string path;  ///< of the picture; empty: none
    double from = 1;   ///< the first level that is shown
    double levels = 8; ///< that are looked into
    double cut = 0;    ///< part of the depth that is cut away in front
};

/// --draw-grid, --grid-from, --grid-levels and --grid-cut
void add_grid_picture_options(CLI::App& command, GridPictureRequest& request);

/// Throws CommandLineError where the options cannot be followed.
void check_grid_picture(const GridPictureRequest& request);

/// Each full cell as a block in the colour of its level, darker where its list is long: a scene of
/// its own, with lights and a camera. With the first level it has the frame of the scene's grid.
Scene grid_scene(
    const GridCells& cells, const GridPictureRequest& request, const PictureSettings& settings);

/// Draws or renders the scene's tree of grids, by the path's extension.
void write_grid_picture(
    const Scene& scene,
    const PictureSettings& settings,
    const GridPictureRequest& request,
    const Console& console);

} // namespace vera
