// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_tree.h"
#include "vera/accel/wide_bvh.h"
#include "vera/scene/bounds.h"

#include "command.h"
#include "grid_picture.h"
#include "interrupt.h"
#include "messages.h"
#include "named_parts.h"
#include "prepared_scene.h"
#include "progress_display.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

struct Request {
    SceneRequest scene;
    GridPictureRequest grid;
    double threads = 0;
    bool json = false;
};

/// How many there are of each kind in the main scene and in all subscenes, each subscene once.
struct Counts {
    std::size_t spheres = 0;
    std::size_t triangles = 0;
    std::size_t polygons = 0;
    std::size_t patches = 0;
    std::size_t rotational_shapes = 0;
    std::size_t meshes = 0;
    std::size_t mesh_triangles = 0;
    std::size_t subscene_calls = 0;
};

void add(Counts& counts, const Geometry& geometry) {
    counts.spheres += geometry.spheres.size();
    counts.triangles += geometry.triangles.size();
    counts.polygons += geometry.polygons.size();
    counts.patches += geometry.patches.size();
    counts.rotational_shapes += geometry.rotational_shapes.size();
    counts.meshes += geometry.meshes.size();
    for (const Mesh& mesh : geometry.meshes)
        counts.mesh_triangles += mesh.triangle_count();
    counts.subscene_calls += geometry.calls.size();
}

nlohmann::ordered_json as_json(Vec3 a) {
    return {a.x, a.y, a.z};
}

nlohmann::ordered_json scene_json(const Scene& scene) {
    Counts counts;
    add(counts, scene.geometry);
    for (const Geometry& subscene : scene.subscenes)
        add(counts, subscene);
    const Box3 box = bounds(scene);
    nlohmann::ordered_json json = {
        {"version", 1},
        {"primitives", scene.geometry.primitive_count},
        {"spheres", counts.spheres},
        {"triangles", counts.triangles},
        {"polygons", counts.polygons},
        {"patches", counts.patches},
        {"rotational_shapes", counts.rotational_shapes},
        {"meshes", counts.meshes},
        {"mesh_triangles", counts.mesh_triangles},
        {"subscenes", scene.subscenes.size()},
        {"subscene_calls", counts.subscene_calls},
        {"materials", scene.materials.size()},
        {"lights", scene.lights.size()}};
    if (!box.empty())
        json["bounds"] = {{"lower", as_json(box.lower)}, {"upper", as_json(box.upper)}};
    return json;
}

nlohmann::ordered_json grid_json(const IndexForecast& forecast, const GridTreeStatistics& grid) {
    return {
        {"forecast_bytes", forecast.bytes},
        {"memory_bytes", grid.bytes},
        {"grids", grid.grids},
        {"levels", grid.levels},
        {"cells", grid.cells},
        {"empty_cells", grid.empty_cells},
        {"references", grid.references},
        {"longest_list", grid.longest_list}};
}

nlohmann::ordered_json bvh_json(const IndexForecast& forecast, const WideBvhStatistics& bvh) {
    return {
        {"forecast_bytes", forecast.bytes},
        {"memory_bytes", bvh.bytes},
        {"nodes", bvh.nodes},
        {"levels", bvh.levels},
        {"blocks", bvh.blocks},
        {"elements", bvh.elements}};
}

std::string bytes_text(double bytes) {
    if (bytes < 1024)
        return fmt::format("{:.0f} bytes", bytes);
    const char* unit = "KiB";
    bytes /= 1024;
    for (const char* larger : {"MiB", "GiB", "TiB"}) {
        if (bytes < 1024)
            break;
        bytes /= 1024;
        unit = larger;
    }
    return fmt::format("{:.1f} {}", bytes, unit);
}

void print_scene(const nlohmann::ordered_json& scene) {
    for (const auto& [name, value] : scene.items()) {
        if (name == "version")
            continue;
        std::string label = name;
        for (char& letter : label)
            letter = letter == '_' ? ' ' : letter;
        if (name == "bounds") {
            const auto& lower = value["lower"];
            const auto& upper = value["upper"];
            fmt::print(
                "bounds              {} {} {}  to  {} {} {}\n",
                lower[0].get<double>(),
                lower[1].get<double>(),
                lower[2].get<double>(),
                upper[0].get<double>(),
                upper[1].get<double>(),
                upper[2].get<double>());
        } else if (value.get<std::uint64_t>() > 0 || name == "primitives" || name == "lights") {
            fmt::print("{:<18}  {}\n", label, value.get<std::uint64_t>());
        }
    }
}

void print_grid(const IndexForecast& forecast, const GridTreeStatistics& grid) {
    const double cells = static_cast<double>(std::max<std::uint64_t>(grid.cells, 1));
    const double full =
        static_cast<double>(std::max<std::uint64_t>(grid.cells - grid.empty_cells, 1));
    fmt::print("tree of grids\n");
    fmt::print("  grids             {}, in {} levels\n", grid.grids, grid.levels);
    fmt::print(
        "  cells             {}, {:.1f} % of them empty\n",
        grid.cells,
        100 * static_cast<double>(grid.empty_cells) / cells);
    fmt::print(
        "  references        {}; {:.2f} in a cell that is not empty, {} at most\n",
        grid.references,
        static_cast<double>(grid.references) / full,
        grid.longest_list);
    fmt::print(
        "  memory            {} (forecast: {})\n",
        bytes_text(static_cast<double>(grid.bytes)),
        bytes_text(static_cast<double>(forecast.bytes)));
}

void print_bvh(const IndexForecast& forecast, const WideBvhStatistics& bvh) {
    fmt::print("hierarchy of boxes\n");
    fmt::print("  nodes             {}, in {} levels\n", bvh.nodes, bvh.levels);
    fmt::print(
        "  blocks            {}, with {:.2f} elements each\n",
        bvh.blocks,
        static_cast<double>(bvh.elements)
            / static_cast<double>(std::max<std::size_t>(bvh.blocks, 1)));
    fmt::print(
        "  memory            {} (forecast: {})\n",
        bytes_text(static_cast<double>(bvh.bytes)),
        bytes_text(static_cast<double>(forecast.bytes)));
}

void print_info(const Request& request, const Console& console) {
    check_grid_picture(request.grid);
    const ThreadLimit limit = thread_limit(request.threads);
    const PreparedScene prepared = prepared_scene(request.scene);
    print_diagnostics(prepared.warnings, console);
    keep_what_was_read(request.scene, prepared.scene, "--draw-grid", request.grid.path);
    const GridSettings settings;
    const IndexForecast bvh_forecast = wide_bvh_forecast(prepared.scene);
    const IndexForecast forecast = grid_forecast(prepared.scene, settings);
    const CancellableWork work;
    const WideBvhStatistics bvh = make_wide_bvh(prepared.scene, {}, &console.cancel)->statistics();
    ProgressDisplay display(console, "index");
    const GridTreeStatistics grid =
        make_grid_tree(prepared.scene, settings, display.callback(), &console.cancel)->statistics();
    if (!request.grid.path.empty())
        write_grid_picture(prepared.scene, prepared.settings, request.grid, console);
    nlohmann::ordered_json json = scene_json(prepared.scene);
    if (request.json) {
        json["bvh"] = bvh_json(bvh_forecast, bvh);
        json["grid"] = grid_json(forecast, grid);
        if (auto parts = named_parts_json(prepared.scene); !parts.empty())
            json["named_parts"] = std::move(parts);
        // Names are as their files have them.
        fmt::print(
            "{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
        return;
    }
    print_scene(json);
    print_named_parts(prepared.scene);
    print_bvh(bvh_forecast, bvh);
    print_grid(forecast, grid);
}

} // namespace

/// vera info SCENE
void add_info_command(CLI::App& app, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* info = app.add_subcommand("info", "what a scene holds, and what its indexes take");
    add_scene_options(*info, request->scene);
    info->add_flag("--json", request->json, "the same as JSON");
    add_grid_picture_options(*info, request->grid);
    add_threads_option(*info, request->threads);
    add_console_options(*info, console);
    info->footer("Examples:\n"
                 "  vera info scene.vera\n"
                 "  vera info bunny.obj --json\n"
                 "  vera info scene.vera --draw-grid grid.svg --raster 900x700\n"
                 "  vera info room.vera --draw-grid grid.png --grid-levels 2 --grid-cut 0.5");

    info->callback([request, &console] { print_info(*request, console); });
}

} // namespace vera
