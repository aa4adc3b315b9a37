// SPDX-License-Identifier: Apache-2.0
// How building, memory, and the time and counted steps of a ray grow with the number of triangles:
// our indexes and Embree, on two families of meshes.
//
// growth_bench             512 to 8 million triangles
// growth_bench --large     to 34 million; takes some 16 GB
// growth_bench --help      what else there is
//
// Each quantity is fitted by a power of the number of triangles: a straight line through the
// logarithms, by least squares.

#include "vera/accel/simd_level.h"
#include "vera/base/output_file.h"
#include "vera/base/parallel.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <optional>
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
using Json = nlohmann::ordered_json;

struct Request {
    MeasurementSettings settings;
    std::size_t most = 10'000'000; ///< triangles
    std::string json;
};

std::optional<int> exit_code_of_reading(Request& request, int argc, char** argv) {
    MeasurementSettings& settings = request.settings;
    settings.indexes = usual_index_names();
    settings.embree = {{EmbreeQuality::medium, EmbreeEdges::fast}};
    settings.rays = {"primary", "diffuse"};
    settings.runs = 3;
    settings.raster = 512;
    bool large = false;
    CLI::App app("How times and counted steps grow with the number of triangles.", "growth_bench");
    app.add_option("--index", settings.indexes, "indexes of ours, between commas")
        ->delimiter(',')
        ->check(CLI::IsMember(index_names()));
    add_measurement_options(app, settings);
    app.add_option("--most", request.most, "no mesh of more triangles")->capture_default_str();
    app.add_flag("--large", large, "up to 34 million triangles");
    app.add_option("--json", request.json, "a file for every number");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (large)
        request.most = 40'000'000;
    return std::nullopt;
}

/// A mesh of a family, and how it is made.
struct Member {
    std::size_t triangles = 0;
    std::function<BenchScene()> make;
};

struct Family {
    std::string name;
    std::vector<Member> members; ///< by size
};

/// The same mountain ever finer.
Family mountains() {
    Family family = {"mountain", {}};
    for (std::size_t side = 16; side <= 4096; side *= 2)
        family.members.push_back({2 * side * side, [=] { return mountain_of(side); }});
    return family;
}

/// Ever more spheres on spheres, and then finer ones.
Family flakes() {
    Family family = {"flake", {}};
    std::size_t spheres = 1;
    std::size_t newest = 1;
    for (std::uint32_t generations = 1; generations <= 5; ++generations) {
        newest *= 9;
        spheres += newest;
        family.members.push_back({128 * spheres, [=] { return flake_of({generations, 2}); }});
    }
    family.members.push_back({512 * spheres, [] { return flake_of({5, 3}); }});
    return family;
}

/// A number of what an index takes, for each of the sizes at which there is one.
struct Curve {
    std::string index;
    std::string quantity;
    std::vector<double> triangles;
    std::vector<double> values;
};

/// The curves of a family, in the order in which they were first added to.
class Curves {
public:
    void
    add(const std::string& index,
        const std::string& quantity,
        std::size_t triangles,
        double value) {
        if (!(value > 0))
            return;
        Curve& curve = find(index, quantity);
        curve.triangles.push_back(static_cast<double>(triangles));
        curve.values.push_back(value);
    }

    const std::vector<Curve>& all() const { return curves_; }

private:
    Curve& find(const std::string& index, const std::string& quantity) {
        for (Curve& curve : curves_)
            if (curve.index == index && curve.quantity == quantity)
                return curve;
        return curves_.emplace_back(Curve{index, quantity, {}, {}});
    }

    std::vector<Curve> curves_;
};

/// The power of the number of triangles that the values grow by.
double exponent(const Curve& curve) {
    const auto n = static_cast<double>(curve.values.size());
    double x = 0;
    double y = 0;
    double xx = 0;
    double xy = 0;
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
        const double log_x = std::log(curve.triangles[i]);
        const double log_y = std::log(curve.values[i]);
        x += log_x;
        y += log_y;
        xx += log_x * log_x;
        xy += log_x * log_y;
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

void add_scene(Curves& curves, const SceneMeasurement& scene) {
    const std::size_t n = scene.primitives;
    for (const BuildMeasurement& build : scene.builds) {
        curves.add(build.name, "build seconds", n, build.seconds);
        curves.add(build.name, "bytes", n, build.bytes);
        curves.add(build.name, "nodes", n, build.nodes);
    }
    for (const RaysMeasurement& rays : scene.rays) {
        const std::string per_ray = " for each " + rays.rays + " ray";
        for (const BuildMeasurement& build : scene.builds) {
            const auto rate = build.embree
                ? fastest_of_embree(rays, [](const EmbreeRate&) { return true; })->rate.median
                : best_rate(rays, build.name).value_or(0);
            curves.add(build.name, "microseconds" + per_ray, n, 1 / rate);
        }
        for (const StepsPerRay& steps : rays.steps) {
            curves.add(steps.index, "nodes" + per_ray, n, steps.nodes);
            curves.add(steps.index, "tests" + per_ray, n, steps.tests);
        }
    }
}

void print(const std::string& family, const Curves& curves) {
    fmt::print("\n{}\n", family);
    for (const Curve& curve : curves.all()) {
        fmt::print("  {:<14} {:<36}", curve.index, curve.quantity);
        for (const double value : curve.values)
            fmt::print(" {:>9.3g}", value);
        if (curve.values.size() > 1)
            fmt::print("   grows by n^{:.3f}", exponent(curve));
        fmt::print("\n");
    }
}

Json as_json(const Curves& curves) {
    Json json = Json::array();
    for (const Curve& curve : curves.all())
        json.push_back(
            {{"index", curve.index},
             {"quantity", curve.quantity},
             {"triangles", curve.triangles},
             {"values", curve.values},
             {"exponent", curve.values.size() > 1 ? Json(exponent(curve)) : Json()}});
    return json;
}

int run(const Request& request) {
    std::optional<OutputFile> json;
    if (!request.json.empty())
        json.emplace(request.json);
    const ThreadLimit limit(request.settings.threads);
    Json report = vera::as_json(request.settings);
    report["families"] = Json::array();
    std::vector<SceneMeasurement> all;
    for (const Family& family : {mountains(), flakes()}) {
        Curves curves;
        for (const Member& member : family.members)
            if (member.triangles <= request.most) {
                all.push_back(measured_scene(member.make(), request.settings));
                add_scene(curves, all.back());
            }
        print(family.name, curves);
        report["families"].push_back({{"name", family.name}, {"curves", as_json(curves)}});
    }
    if (json) {
        json->write(report.dump(1) + "\n");
        json->commit();
    }
    return all_agree(all) ? 0 : 1;
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
        fmt::print(stderr, "growth_bench: {}\n", error.what());
        return 3;
    }
}
