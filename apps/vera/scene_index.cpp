// SPDX-License-Identifier: Apache-2.0
#include "scene_index.h"

#include "vera/accel/brute_force.h"
#include "vera/accel/grid_tree.h"
#include "vera/accel/wide_bvh.h"

#include <CLI/CLI.hpp>

namespace vera {

void add_index_options(CLI::App& command, IndexRequest& request) {
    command.add_option("--index", request.kind, "what finds the hits; never changes the picture")
        ->type_name("auto|bvh|grid|brute")
        ->check(CLI::IsMember({"auto", "bvh", "grid", "brute"}).description(""))
        ->capture_default_str();
}

std::unique_ptr<RayIndex> scene_index(
    const Scene& scene,
    const IndexRequest& request,
    const Progress& progress,
    const CancelFlag& cancel) {
    if (request.kind == "brute")
        return make_brute_force(scene);
    if (request.kind == "grid")
        return make_grid_tree(scene, GridSettings{}, progress, &cancel);
    return make_wide_bvh(scene, progress, &cancel);
}

} // namespace vera
