// SPDX-License-Identifier: Apache-2.0
// Counted steps and processor seconds of the three strategies of section 3.4 of the VERA paper, on
// one scene: usage is below. bench/comparison runs it.
#include "vera/base/parallel.h"
#include "vera/formats/read_scene.h"
#include "vera/scene/facets.h"
#include "vera/theory/strategies.h"
#include "vera/visible/projection.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace vera {

namespace {

using Json = nlohmann::ordered_json;

// A sweep of more takes minutes and gigabytes.
constexpr double most_crossings = 2e7;

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

/// Of the processor, the median of some runs: other work on the machine counts less.
template <typename Work>
double seconds_of(int runs, const Work& work) {
    std::vector<double> seconds;
    for (int i = 0; i < runs; ++i) {
        const std::clock_t start = std::clock();
        work();
        seconds.push_back(
            static_cast<double>(std::clock() - start) / static_cast<double>(CLOCKS_PER_SEC));
    }
    std::nth_element(seconds.begin(), seconds.begin() + runs / 2, seconds.end());
    return seconds[static_cast<std::size_t>(runs / 2)];
}

Json swept(const ScreenScene& scene, int runs) {
    if (sweep_forecast(scene).crossings > most_crossings)
        return nullptr;
    SweepCounts counts;
    const double seconds = seconds_of(runs, [&] { plane_sweep(scene, {std::nullopt, &counts}); });
    const std::uint64_t steps = counts.orientations + counts.comparisons + counts.queued
        + counts.insertions + counts.depth_orders;
    return {{"crossings", counts.crossings}, {"steps", steps}, {"seconds", seconds}};
}

Json by_cells(const ScreenScene& scene, int runs) {
    CellCounts counts;
    const double seconds = seconds_of(runs, [&] { cell_raster(scene, {}, nullptr, {}, &counts); });
    const std::uint64_t steps = counts.touched + counts.edge_cells + counts.looked_at
        + counts.candidates + counts.events + counts.active;
    return {{"steps", steps}, {"seconds", seconds}};
}

Json as_json(const QueryCounts& counts, double seconds) {
    return {
        {"rays", counts.rays},
        {"nodes", counts.cells},
        {"tests", counts.tests},
        {"seconds", seconds}};
}

std::size_t differences(const PixelSources& a, const PixelSources& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        count += a[i] != b[i] ? 1 : 0;
    return count;
}

Json at_side(
    const ScreenScene& scene,
    const VisiblePieces& pieces,
    const GridRays& rays,
    std::size_t side,
    int runs) {
    DepthCounts depth;
    PixelSources by_depth;
    const double depth_seconds = seconds_of(runs, [&] {
        depth = {};
        by_depth = sources_by_depth(scene, side, depth);
    });
    PixelSources by_map;
    const double map_seconds =
        seconds_of(runs, [&] { by_map = sources_by_map(scene, pieces, side); });
    QueryCounts query;
    PixelSources by_rays;
    const double rays_seconds = seconds_of(runs, [&] {
        query = {};
        by_rays = rays.sources(rays.hits(side, query));
    });
    return {
        {"side", side},
        {"depth",
         {{"filled", depth.filled}, {"compared", depth.compared}, {"seconds", depth_seconds}}},
        {"map", {{"seconds", map_seconds}}},
        {"rays", as_json(query, rays_seconds)},
        {"seen",
         side * side
             - static_cast<std::size_t>(std::count(by_map.begin(), by_map.end(), no_source))},
        {"differences",
         {{"depth and map", differences(by_depth, by_map)},
          {"depth and rays", differences(by_depth, by_rays)},
          {"map and rays", differences(by_map, by_rays)}}}};
}

Json of_light(
    const ScreenScene& scene,
    const GridRays& rays,
    GridRays::Light light,
    const std::vector<std::size_t>& sides,
    int runs) {
    const ScreenScene from_light = seen_from(scene, light);
    Json json = {{"sweep", swept(from_light, runs)}, {"cells", by_cells(from_light, runs)}};
    for (const std::size_t side : sides) {
        QueryCounts counts;
        const std::vector<Hit> hits = rays.hits(side, counts);
        std::size_t lit = 0;
        const double seconds = seconds_of(runs, [&] {
            counts = {};
            lit = rays.lit(hits, light, counts);
        });
        json["rays"].push_back(as_json(counts, seconds));
        json["rays"].back()["lit"] = lit;
    }
    return json;
}

void measure(const std::string& path, const std::vector<std::size_t>& sides, int lights, int runs) {
    const ThreadLimit one(1);
    const ScreenScene scene = scene_on_grid(path);
    const VisiblePieces pieces = cell_raster(scene);
    std::optional<GridRays> rays;
    const double build = seconds_of(runs, [&] { rays.emplace(scene); });
    Json json = {
        {"triangles", scene.triangles.size()},
        {"corners", pieces.points.size()},
        {"sweep", swept(scene, runs)},
        {"cells", by_cells(scene, runs)},
        {"build", {{"seconds", build}, {"bytes", rays->bytes()}}}};
    for (const std::size_t side : sides)
        json["sides"].push_back(at_side(scene, pieces, *rays, side, runs));
    for (int i = 0; i < lights; ++i) {
        const double turn = 2 * std::numbers::pi * (i + 0.3) / lights;
        json["lights"].push_back(
            of_light(scene, *rays, {0.3 * std::cos(turn), 0.3 * std::sin(turn)}, sides, runs));
    }
    std::printf("%s\n", json.dump().c_str());
}

} // namespace

} // namespace vera

int main(int count, char** words) {
    std::vector<std::size_t> sides;
    for (int i = 4; i < count; ++i)
        sides.push_back(static_cast<std::size_t>(std::max(std::atoi(words[i]), 0)));
    const int lights = count > 2 ? std::atoi(words[2]) : -1;
    const int runs = count > 3 ? std::atoi(words[3]) : 0;
    if (sides.empty() || lights < 0 || runs < 1
        || std::any_of(sides.begin(), sides.end(), [](std::size_t side) {
               return side < 1 || side > 16384;
           })) {
        std::fprintf(
            stderr,
            "usage: comparison_bench SCENE.vera LIGHTS RUNS SIDE ...\n"
            "SIDE x SIDE are the pixels, up to 16384 each way\n");
        return 2;
    }
    try {
        vera::measure(words[1], sides, lights, runs);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "comparison_bench: %s\n", error.what());
        return 3;
    }
    return 0;
}
