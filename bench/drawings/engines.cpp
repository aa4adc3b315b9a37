// SPDX-License-Identifier: Apache-2.0
// Processor seconds and counted steps of an engine that finds what is seen, alone: usage is below.
#include "vera/base/parallel.h"
#include "vera/formats/read_scene.h"
#include "vera/scene/facets.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/projection.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace vera {

namespace {

ScreenScene scene_on_grid(const std::string& path) {
    const Scene scene = read_scene(path, {}).scene;
    if (!scene.camera)
        throw std::runtime_error(path + " has no camera");
    constexpr double deviation = 1e-3; // of the scene's unit; meshes have no curves
    const Facets all = facets(scene, [](Vec3) { return deviation; });
    std::vector<std::uint32_t> sources;
    for (const Facets::Triangle& triangle : all.triangles)
        sources.push_back(static_cast<std::uint32_t>(triangle.primitive));
    ScreenScene screen = screen_scene(all, CameraMap(*scene.camera), sources);
    sort_by_place(screen);
    return screen;
}

nlohmann::ordered_json as_json(const CellCounts& counts) {
    return {
        {"cells", counts.cells},
        {"touched", counts.touched},
        {"entries", counts.entries},
        {"edges", counts.edges},
        {"edge_cells", counts.edge_cells},
        {"followed", counts.followed},
        {"followed_cells", counts.followed_cells},
        {"looked_at", counts.looked_at},
        {"candidates", counts.candidates},
        {"events", counts.events},
        {"active", counts.active},
        {"depth_orders", counts.depth_orders}};
}

nlohmann::ordered_json as_json(const PlaneSweepCounts& counts) {
    return {
        {"segments", counts.segments},
        {"corners", counts.corners},
        {"crossings", counts.crossings},
        {"edges", counts.edges},
        {"drains", counts.drains},
        {"queued", counts.queued},
        {"orientations", counts.orientations},
        {"exact_orientations", counts.exact_orientations},
        {"comparisons", counts.comparisons},
        {"exact_comparisons", counts.exact_comparisons},
        {"insertions", counts.insertions},
        {"moved", counts.moved},
        {"depth_orders", counts.depth_orders},
        {"largest_set", counts.largest_set},
        {"looked_at", counts.looked_at},
        {"candidates", counts.candidates},
        {"visible_edges", counts.visible_edges}};
}

/// By cells or by sweep; the steps are counted where json is given.
VisiblePieces found(const ScreenScene& scene, bool by_sweep, nlohmann::ordered_json* json) {
    if (by_sweep) {
        PlaneSweepCounts counts;
        PlaneSweepSettings settings;
        settings.counts = &counts;
        VisiblePieces pieces = plane_sweep(scene, settings);
        if (json != nullptr)
            (*json)["counts"] = as_json(counts);
        return pieces;
    }
    CellCounts counts;
    VisiblePieces pieces = cell_raster(scene, {}, nullptr, {}, json != nullptr ? &counts : nullptr);
    if (json != nullptr)
        (*json)["counts"] = as_json(counts);
    return pieces;
}

void measure(const std::string& path, bool by_sweep, int runs) {
    const ThreadLimit one(1);
    const ScreenScene scene = scene_on_grid(path);
    nlohmann::ordered_json json = {{"triangles", scene.triangles.size()}};
    const VisiblePieces pieces = found(scene, by_sweep, &json);
    json["pieces"] = pieces.pieces.size();
    json["corners"] = visible_map(scene, pieces).vertices.size();
    for (int i = 0; i < runs; ++i) {
        // Of the processor: other work on the machine counts less.
        const std::clock_t start = std::clock();
        found(scene, by_sweep, nullptr);
        json["seconds"].push_back(
            static_cast<double>(std::clock() - start) / static_cast<double>(CLOCKS_PER_SEC));
    }
    std::printf("%s\n", json.dump().c_str());
}

} // namespace

} // namespace vera

int main(int count, char** words) {
    const std::string engine = count > 2 ? words[2] : "";
    const int runs = count > 3 ? std::atoi(words[3]) : 0;
    if (count != 4 || (engine != "cells" && engine != "sweep") || runs < 1) {
        std::fprintf(stderr, "usage: engines_bench SCENE.vera cells|sweep RUNS\n");
        return 2;
    }
    try {
        vera::measure(words[1], engine == "sweep", runs);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "engines_bench: %s\n", error.what());
        return 3;
    }
    return 0;
}
