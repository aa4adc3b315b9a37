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
#include <span>
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

/// Between two of the runs, where the part of them falls between two.
double quantile(std::span<const double> ascending, double part) {
    const double place = part * static_cast<double>(ascending.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, ascending.size() - 1);
    return ascending[below]
        + (place - static_cast<double>(below)) * (ascending[above] - ascending[below]);
}

/// Adds the seconds of the processor that the work takes: the median of some runs and the
/// quartiles, between which half of them lie. Other work on the machine counts less.
template <typename Work>
void add_seconds(Json& json, int runs, const Work& work) {
    std::vector<double> seconds;
    for (int i = 0; i < runs; ++i) {
        const std::clock_t start = std::clock();
        work();
        seconds.push_back(
            static_cast<double>(std::clock() - start) / static_cast<double>(CLOCKS_PER_SEC));
    }
    std::sort(seconds.begin(), seconds.end());
    json["seconds"] = quantile(seconds, 0.5);
    json["quartiles"] = {quantile(seconds, 0.25), quantile(seconds, 0.75)};
}

Json swept(const ScreenScene& scene, int runs) {
    if (sweep_forecast(scene).crossings > most_crossings)
        return nullptr;
    PlaneSweepCounts counts;
    Json times;
    add_seconds(times, runs, [&] { plane_sweep(scene, {std::nullopt, &counts}); });
    Json json = {{"crossings", counts.crossings}, {"steps", counts.steps()}};
    json.update(times);
    return json;
}

Json by_cells(const ScreenScene& scene, int runs) {
    CellCounts counts;
    Json times;
    add_seconds(times, runs, [&] { cell_raster(scene, {}, nullptr, {}, &counts); });
    const std::uint64_t steps = counts.touched + counts.edge_cells + counts.looked_at
        + counts.candidates + counts.events + counts.active;
    Json json = {{"steps", steps}};
    json.update(times);
    return json;
}

Json as_json(const QueryCounts& counts, const Json& times) {
    Json json = {{"rays", counts.rays}, {"nodes", counts.cells}, {"tests", counts.tests}};
    json.update(times);
    return json;
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
    Json depth_times;
    add_seconds(depth_times, runs, [&] {
        depth = {};
        by_depth = sources_by_depth(scene, side, depth);
    });
    PixelSources by_map;
    Json map_times;
    add_seconds(map_times, runs, [&] { by_map = sources_by_map(scene, pieces, side); });
    QueryCounts query;
    PixelSources by_rays;
    Json rays_times;
    add_seconds(rays_times, runs, [&] {
        query = {};
        by_rays = rays.sources(rays.hits(side, query));
    });
    Json depth_json = {{"filled", depth.filled}, {"compared", depth.compared}};
    depth_json.update(depth_times);
    return {
        {"side", side},
        {"depth", depth_json},
        {"map", map_times},
        {"rays", as_json(query, rays_times)},
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
        Json times;
        add_seconds(times, runs, [&] {
            counts = {};
            lit = rays.lit(hits, light, counts);
        });
        json["rays"].push_back(as_json(counts, times));
        json["rays"].back()["lit"] = lit;
    }
    return json;
}

void measure(const std::string& path, const std::vector<std::size_t>& sides, int lights, int runs) {
    const ThreadLimit one(1);
    const ScreenScene scene = scene_on_grid(path);
    const VisiblePieces pieces = cell_raster(scene);
    std::optional<GridRays> rays;
    Json build;
    add_seconds(build, runs, [&] { rays.emplace(scene); });
    build["bytes"] = rays->bytes();
    Json json = {
        {"triangles", scene.triangles.size()},
        {"corners", pieces.points.size()},
        {"sweep", swept(scene, runs)},
        {"cells", by_cells(scene, runs)},
        {"build", build}};
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
