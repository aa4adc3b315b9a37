// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <cmath>
#include <iterator>

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

/// The geometric mean of what is added.
class GeometricMean {
public:
    void add(double value) {
        logarithms_ += std::log(value);
        ++count_;
    }

    std::size_t count() const { return count_; }

    double value() const { return std::exp(logarithms_ / static_cast<double>(count_)); }

private:
    double logarithms_ = 0;
    std::size_t count_ = 0;
};

std::string builds_table(const std::vector<SceneMeasurement>& scenes) {
    std::string text = "builds; bytes are those beside the scene\n";
    text += fmt::format(
        "  {:<12} {:>10}  {:<14} {:>8} {:>12}\n",
        "scene",
        "primitives",
        "index",
        "seconds",
        "bytes each");
    for (const SceneMeasurement& scene : scenes)
        for (const BuildMeasurement& build : scene.builds)
            text += fmt::format(
                "  {:<12} {:>10}  {:<14} {:>8.3f} {:>12.1f}\n",
                scene.name,
                scene.primitives,
                build.name,
                build.seconds,
                build.bytes / static_cast<double>(scene.primitives));
    return text;
}

std::string row(const std::string& name, const RaysMeasurement& rays) {
    const EmbreeRate& embree = best(rays);
    return fmt::format(
        "  {:<12} {:>9} {:>8.3g} {:>8.3g} {:>8.3g}  {:<30} {:>7.3g} {:>7.3g}  {:>9.1e}\n",
        name,
        rays.count,
        rays.ours.median,
        rays.ours_whole.median,
        embree.rate.median,
        fmt::format("{}, {}", embree.call, name_of(embree.quality)),
        rays.ours.median / embree.rate.median,
        rays.ours_whole.median / embree.rate.median,
        rays.disagreement);
}

const RaysMeasurement* measurement_of(const SceneMeasurement& scene, const std::string& kind) {
    for (const RaysMeasurement& rays : scene.rays)
        if (rays.rays == kind)
            return &rays;
    return nullptr;
}

/// The rows of the scenes of one kind, and their mean where there are several.
std::string rows(
    const std::vector<SceneMeasurement>& scenes, BenchSceneKind kind, const std::string& ray_kind) {
    std::string text;
    GeometricMean ours;
    GeometricMean whole;
    for (const SceneMeasurement& scene : scenes) {
        const RaysMeasurement* const rays = measurement_of(scene, ray_kind);
        if (scene.kind != kind || rays == nullptr)
            continue;
        text += row(scene.name, *rays);
        ours.add(rays->ours.median / best(*rays).rate.median);
        whole.add(rays->ours_whole.median / best(*rays).rate.median);
    }
    if (ours.count() > 1)
        text += fmt::format(
            "  {:<81} {:>7.3g} {:>7.3g}\n", "geometric mean", ours.value(), whole.value());
    return text;
}

std::string rays_table(
    const std::vector<SceneMeasurement>& scenes,
    const std::string& kind,
    const RaysBenchSettings& settings) {
    const std::string generation = fmt::format("in {}", settings.generation);
    std::string text = fmt::format("\n{}: million rays a second\n", kind);
    text += fmt::format(
        "  {:<12} {:>9} {:>8} {:>8} {:>8}  {:<30} {:>7} {:>7}  {:>9}\n",
        "scene",
        "rays",
        generation,
        "at once",
        "Embree",
        "its fastest call",
        "ratio",
        "at once",
        "disagree");
    const std::string meshes = rows(scenes, BenchSceneKind::triangles, kind);
    const std::string spheres = rows(scenes, BenchSceneKind::spheres, kind);
    // Such rays there may be none of: shadow rays where nothing is hit.
    return meshes.empty() && spheres.empty() ? std::string() : text + meshes + spheres;
}

using Json = nlohmann::ordered_json;

Json as_json(const Rate& rate) {
    return {{"median", rate.median}, {"slowest", rate.slowest}, {"fastest", rate.fastest}};
}

Json as_json(const RaysMeasurement& rays) {
    Json json = {
        {"kind", rays.rays},
        {"rays", rays.count},
        {"disagreement", rays.disagreement},
        {"ours", as_json(rays.ours)},
        {"ours_at_once", as_json(rays.ours_whole)},
        {"embree", Json::array()}};
    for (const EmbreeRate& embree : rays.embree)
        json["embree"].push_back(
            {{"call", embree.call},
             {"quality", name_of(embree.quality)},
             {"rate", as_json(embree.rate)}});
    return json;
}

Json as_json(const SceneMeasurement& scene) {
    Json json = {
        {"name", scene.name},
        {"primitives", scene.primitives},
        {"builds", Json::array()},
        {"rays", Json::array()}};
    for (const BuildMeasurement& build : scene.builds)
        json["builds"].push_back(
            {{"index", build.name}, {"seconds", build.seconds}, {"bytes", build.bytes}});
    for (const RaysMeasurement& rays : scene.rays)
        json["rays"].push_back(as_json(rays));
    return json;
}

} // namespace

std::string
as_text(const std::vector<SceneMeasurement>& scenes, const RaysBenchSettings& settings) {
    std::string text = fmt::format(
        "{} and Embree {}{}, threads: {}, median of {}\n\n",
        settings.index,
        RTC_VERSION_STRING,
        settings.edges == EmbreeEdges::robust ? " robust" : "",
        settings.threads,
        settings.runs);
    text += builds_table(scenes);
    for (const std::string& kind : settings.rays)
        text += rays_table(scenes, kind, settings);
    return text;
}

std::string
as_json(const std::vector<SceneMeasurement>& scenes, const RaysBenchSettings& settings) {
    Json json = {
        {"version", 1},
        {"index", settings.index},
        {"embree", RTC_VERSION_STRING},
        {"embree_settings", settings.embree},
        {"threads", settings.threads},
        {"runs", settings.runs},
        {"raster", settings.raster},
        {"generation", settings.generation},
        {"size", settings.size == BenchSize::full ? "full" : "quick"},
        {"robust", settings.edges == EmbreeEdges::robust},
        {"unit", "million rays a second"},
        {"scenes", Json::array()}};
    for (const SceneMeasurement& scene : scenes)
        json["scenes"].push_back(as_json(scene));
    return json.dump(2) + "\n";
}

} // namespace vera
