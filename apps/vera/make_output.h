// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <string>

#include "command.h"

namespace CLI {
class App;
} // namespace CLI

namespace vera {

/// Where a made scene goes, and with how much round it.
struct MakeOutput {
    std::string path;
    bool bare = false; ///< the model alone, for INCLUDE
};

/// -o and --bare, on a subcommand of vera make.
void add_make_output_options(CLI::App& command, MakeOutput& output);

/// Throws CommandLineError where the path is not that of a scene text.
void check_make_output(const MakeOutput& output);

/// Writes the scene, and beside one that is not bare and goes to a file, a control file of the same
/// name.
void write_made_scene(const Scene& scene, const MakeOutput& output, const Console& console);

/// vera make surface X Y Z -o SCENE
void add_make_surface(CLI::App& make, Console& console);

/// vera make turned R H R H ... -o SCENE
void add_make_turned(CLI::App& make, Console& console);

} // namespace vera
