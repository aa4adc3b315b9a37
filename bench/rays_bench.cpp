// SPDX-License-Identifier: Apache-2.0
// Million rays a second of our indexes and of Embree, in one process and run by run in turn.
//
// rays_bench               every usual scene, index and kind of rays
// rays_bench --quick       a small version of all, to see that it works
// rays_bench --help        what else there is
//
// Of Embree, the fastest call on either of its builds counts, for each kind of rays; beside it, the
// fastest with its robust flag, and the fastest call for one ray. That both sides find the same is
// checked in the same run: the exit code is 1 where they differ on more than a thousandth of the
// rays.

#include "vera/accel/simd_level.h"
#include "vera/base/output_file.h"
#include "vera/base/parallel.h"

#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "rays/measurement.h"
#include "rays/measurement_options.h"
#include "rays/report.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace {

using namespace vera;

/// The command line: what to measure, and where it goes.
struct Request {
    MeasurementSettings settings;
    std::vector<std::string> scenes = usual_bench_scene_names();
    BenchSize size = BenchSize::full;
    std::string json;
};

/// With its robust flag Embree builds the same in either quality.
std::vector<EmbreeSettings> embree_builds(const std::vector<std::string>& edges) {
    std::vector<EmbreeSettings> builds;
    for (const std::string& each : edges) {
        const EmbreeEdges kind = each == "robust" ? EmbreeEdges::robust : EmbreeEdges::fast;
        builds.push_back({EmbreeQuality::medium, kind});
        if (kind == EmbreeEdges::fast)
            builds.push_back({EmbreeQuality::high, kind});
    }
    return builds;
}

/// Reads the command line into the request; the exit code where that ends the program.
std::optional<int> exit_code_of_reading(Request& request, int argc, char** argv) {
    MeasurementSettings& settings = request.settings;
    std::vector<std::string> edges = {"fast", "robust"};
    bool quick = false;
    bool large = false;
    settings.indexes = usual_index_names();
    settings.rays = ray_set_names();
    CLI::App app("Million rays a second of VERA's indexes and of Embree.", "rays_bench");
    const auto add_list = [&](const char* name,
                              std::vector<std::string>& list,
                              const std::vector<std::string>& known,
                              const char* what) {
        app.add_option(name, list, what)->delimiter(',')->check(CLI::IsMember(known));
    };
    add_list("--index", settings.indexes, index_names(), "indexes of ours, between commas");
    add_list("--meshes", request.scenes, bench_scene_names(), "the scenes, between commas");
    add_list("--rays", settings.rays, ray_set_names(), "the kinds of rays, between commas");
    add_list("--edges", edges, {"fast", "robust"}, "Embree without or with its robust flag");
    add_measurement_options(app, settings);
    app.add_option("--json", request.json, "a file for every number");
    app.add_flag("--quick", quick, "small scenes and few rays");
    app.add_flag("--large", large, "the largest scene as well");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    settings.embree = embree_builds(edges);
    if (large)
        request.scenes.emplace_back("flake_large");
    if (quick) {
        request.size = BenchSize::quick;
        if (app.count("--raster") == 0)
            settings.raster = 128;
    }
    return std::nullopt;
}

std::vector<SceneMeasurement> measured_scenes(const Request& request) {
    const ThreadLimit limit(request.settings.threads);
    std::vector<SceneMeasurement> measurements;
    for (const std::string& name : request.scenes)
        if (const auto scene = bench_scene(name, request.size))
            measurements.push_back(measured_scene(*scene, request.settings));
        else
            fmt::print(stderr, "{}: left out, since its file is not there\n", name);
    if (measurements.empty())
        throw std::runtime_error("no scene is there; set VERA_MODELS and VERA_SCENES, or --meshes");
    return measurements;
}

std::string json_text(const std::vector<SceneMeasurement>& scenes, const Request& request) {
    nlohmann::ordered_json json = as_json(request.settings);
    json["size"] = request.size == BenchSize::full ? "full" : "quick";
    json["scenes"] = nlohmann::ordered_json::array();
    for (const SceneMeasurement& scene : scenes)
        json["scenes"].push_back(as_json(scene));
    return json.dump(1) + "\n";
}

/// The exit code.
int run(const Request& request) {
    std::optional<OutputFile> json;
    if (!request.json.empty())
        json.emplace(request.json);
    const std::vector<SceneMeasurement> scenes = measured_scenes(request);
    fmt::print("{}", as_text(scenes, request.settings));
    if (json) {
        json->write(json_text(scenes, request));
        json->commit();
    }
    return all_agree(scenes) ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
    try {
        honour_simd_environment();
        Request request;
        if (const auto code = exit_code_of_reading(request, argc, argv))
            return *code;
        return run(request);
    } catch (const std::exception& error) {
        fmt::print(stderr, "rays_bench: {}\n", error.what());
        return 3;
    }
}
