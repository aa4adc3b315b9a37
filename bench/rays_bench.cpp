// SPDX-License-Identifier: Apache-2.0
// Million rays a second of our indexes and of Embree, in one process and run by run in turn.
//
// rays_bench               every usual scene and every kind of rays
// rays_bench --quick       a small version of all, to see that it works
// rays_bench --help        what else there is
//
// Of Embree, the fastest call on either of its builds counts, for each kind of rays. That both
// sides find the same is checked in the same run: the exit code is 1 where they differ on more than
// a thousandth of the rays.

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
#include "rays/report.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace vera;

/// The command line: what to measure, and where it goes.
struct Request {
    RaysBenchSettings settings;
    std::string json;
};

/// Reads the command line into the request; the exit code where that ends the program.
std::optional<int> exit_code_of_reading(Request& request, int argc, char** argv) {
    RaysBenchSettings& settings = request.settings;
    bool quick = false;
    bool large = false;
    bool robust = false;
    CLI::App app("Million rays a second of VERA's indexes and of Embree.", "rays_bench");
    app.add_option("--index", settings.index, "the index of ours")
        ->check(CLI::IsMember(index_names()))
        ->capture_default_str();
    app.add_option("--meshes", settings.scenes, "the scenes, between commas")
        ->delimiter(',')
        ->check(CLI::IsMember(bench_scene_names()));
    app.add_option("--rays", settings.rays, "the kinds of rays, between commas")
        ->delimiter(',')
        ->check(CLI::IsMember(ray_set_names()));
    app.add_option("--runs", settings.runs, "of which the median is taken")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--threads", settings.threads, "for building and for rays")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--raster", settings.raster, "primary rays across the picture, and down")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--generation", settings.generation, "rays that our index gets at a time")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--json", request.json, "a file for every number");
    app.add_option("--embree", settings.embree, "settings for Embree's device, as isa=avx2");
    app.add_flag("--quick", quick, "small scenes and few rays");
    app.add_flag("--large", large, "the largest scene as well");
    app.add_flag("--robust", robust, "Embree's scenes with its robust flag");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (settings.raster % 32 != 0) {
        fmt::print(stderr, "rays_bench: --raster must be a multiple of 32\n");
        return 2;
    }
    if (settings.scenes.empty())
        settings.scenes = usual_bench_scene_names();
    if (large)
        settings.scenes.emplace_back("flake_large");
    if (settings.rays.empty())
        settings.rays = ray_set_names();
    if (robust)
        settings.edges = EmbreeEdges::robust;
    if (quick) {
        settings.size = BenchSize::quick;
        if (app.count("--raster") == 0)
            settings.raster = 128;
    }
    return std::nullopt;
}

/// Whether both sides found the same; tells standard error where they did not.
bool all_agree(const std::vector<SceneMeasurement>& scenes) {
    bool good = true;
    for (const SceneMeasurement& scene : scenes)
        for (const RaysMeasurement& rays : scene.rays)
            if (rays.disagreement > largest_disagreement) {
                fmt::print(
                    stderr,
                    "rays_bench: {}, {}: the two sides differ on {:.2g} of the rays\n",
                    scene.name,
                    rays.rays,
                    rays.disagreement);
                good = false;
            }
    return good;
}

/// The exit code.
int run(const Request& request) {
    std::optional<OutputFile> json;
    if (!request.json.empty())
        json.emplace(request.json);
    const ThreadLimit limit(request.settings.threads);
    std::vector<SceneMeasurement> scenes;
    for (const std::string& name : request.settings.scenes)
        if (auto scene = measured_scene(name, request.settings))
            scenes.push_back(std::move(*scene));
    if (scenes.empty())
        throw std::runtime_error("no scene is there; set VERA_MODELS and VERA_SCENES, or --meshes");
    fmt::print("{}", as_text(scenes, request.settings));
    if (json) {
        json->write(as_json(scenes, request.settings));
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
