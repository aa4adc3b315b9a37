// SPDX-License-Identifier: Apache-2.0
#include "scene_index.h"

#include "vera/accel/brute_force.h"
#include "vera/accel/grid_tree.h"

#include <CLI/CLI.hpp>

namespace vera {

void add_index_options(CLI::App& command, IndexRequest& request) {
    command.add_option("--index", request.kind, "what finds the hits; never changes the picture")
        ->type_name("auto|grid|brute")
        ->check(CLI::IsMember({"auto", "grid", "brute"}))
        ->capture_default_str();
}

std::unique_ptr<RayIndex> scene_index(
    const Scene& scene,
    const IndexRequest& request,
    const Progress& progress,
    const CancelFlag& cancel) {
    if (request.kind == "brute")
        return make_brute_force(scene);
    return make_grid_tree(scene, GridSettings{}, progress, &cancel);
}

} // namespace vera
