// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <cmath>
#include <iterator>
#include <limits>

#include <embree3/rtcore.h>
#include <fmt/format.h>

namespace vera {

namespace {

/// Of Embree's calls on what was built so.
const EmbreeRate* fastest_of_build(const RaysMeasurement& rays, const EmbreeSettings& build) {
    return fastest_of_embree(rays, [&](const EmbreeRate& each) { return each.build == build; });
}

const EmbreeRate* fastest_with(const RaysMeasurement& rays, EmbreeEdges edges) {
    return fastest_of_embree(
        rays, [&](const EmbreeRate& each) { return each.build.edges == edges; });
}

const EmbreeRate* fastest_one_ray(const RaysMeasurement& rays) {
    return fastest_of_embree(rays, [](const EmbreeRate& each) {
        return each.one_ray && each.build.edges == EmbreeEdges::fast;
    });
}

/// How many times as fast as Embree's build our index answers; the mean of all kinds of rays.
double speed_against(
    const SceneMeasurement& scene, const std::string& index, const EmbreeSettings& build) {
    GeometricMean mean;
    for (const RaysMeasurement& rays : scene.rays)
        if (const auto ours = best_rate(rays, index))
            mean.add(*ours / fastest_of_build(rays, build)->rate.median);
    return mean.count() > 0 ? mean.value() : 1;
}

/// Embree's build whose rays are as fast as those of our index, or the nearest to that.
const BuildMeasurement* equal_of_embree(const SceneMeasurement& scene, const std::string& index) {
    const BuildMeasurement* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const BuildMeasurement& build : scene.builds) {
        if (!build.embree || build.embree->edges != EmbreeEdges::fast)
            continue;
        const double difference = std::abs(std::log(speed_against(scene, index, *build.embree)));
        if (difference < least) {
            least = difference;
            nearest = &build;
        }
    }
    return nearest;
}

std::string build_row(const SceneMeasurement& scene, const BuildMeasurement& build) {
    std::string text = fmt::format(
        "  {:<12} {:>10}  {:<20} {:>8.3f} {:>10.1f}",
        scene.name,
        scene.primitives,
        build.name,
        build.seconds,
        build.bytes / static_cast<double>(scene.primitives));
    const BuildMeasurement* const equal =
        build.embree ? nullptr : equal_of_embree(scene, build.name);
    if (equal != nullptr)
        text += fmt::format(
            "  {:<20} {:>8.2f} {:>8.2f}",
            equal->name,
            build.seconds / equal->seconds,
            build.bytes / equal->bytes);
    return text + "\n";
}

std::string builds_table(const std::vector<SceneMeasurement>& scenes) {
    std::string text = "builds; bytes are those beside the scene; ratios are to the build of "
                       "Embree's whose rays are nearest in speed\n";
    text += fmt::format(
        "  {:<12} {:>10}  {:<20} {:>8} {:>10}  {:<20} {:>8} {:>8}\n",
        "scene",
        "primitives",
        "index",
        "seconds",
        "bytes each",
        "nearest of Embree's",
        "seconds",
        "bytes");
    for (const SceneMeasurement& scene : scenes)
        for (const BuildMeasurement& build : scene.builds)
            text += build_row(scene, build);
    return text;
}

/// Our index's times Embree's rate; nothing where either was not measured.
std::optional<double> ratio(std::optional<double> ours, const EmbreeRate* theirs) {
    if (!ours || theirs == nullptr)
        return std::nullopt;
    return *ours / theirs->rate.median;
}

/// An index's speed by Embree's.
struct Ratios {
    std::optional<double> fast;   ///< its fastest call
    std::optional<double> robust; ///< the same with its robust flag
    std::optional<double> one;    ///< both sides with a call for each ray
};

Ratios ratios_of(const RaysMeasurement& rays, const std::string& index) {
    const auto ours = best_rate(rays, index);
    return {
        ratio(ours, fastest_with(rays, EmbreeEdges::fast)),
        ratio(ours, fastest_with(rays, EmbreeEdges::robust)),
        ratio(one_ray_rate(rays, index), fastest_one_ray(rays))};
}

std::string number(std::optional<double> value) {
    return value ? fmt::format("{:.3g}", *value) : std::string();
}

std::string number(const EmbreeRate* rate) {
    return rate != nullptr ? fmt::format("{:.3g}", rate->rate.median) : std::string();
}

std::string rate_of(const RaysMeasurement& rays, const std::string& index, OurCall call) {
    for (const OurRate& each : rays.ours)
        if (each.index == index && each.call == call)
            return fmt::format("{:.3g}", each.rate.median);
    return {};
}

constexpr const char* rays_format =
    "  {:<12} {:<10} {:>8} {:>8} {:>8}  {:>8} {:<27} {:>8} {:>8}  {:>6} {:>6} {:>6}  {:>8}\n";

std::string
row(const SceneMeasurement& scene, const RaysMeasurement& rays, const std::string& index) {
    const EmbreeRate* const fast = fastest_with(rays, EmbreeEdges::fast);
    const Ratios ratios = ratios_of(rays, index);
    return fmt::format(
        fmt::runtime(rays_format),
        scene.name,
        index,
        rate_of(rays, index, OurCall::generation),
        rate_of(rays, index, OurCall::all),
        rate_of(rays, index, OurCall::one),
        number(fast),
        fast == nullptr
            ? std::string()
            : fmt::format(
                "{}{}", fast->call, fast->build.quality == EmbreeQuality::high ? ", high" : ""),
        number(fastest_with(rays, EmbreeEdges::robust)),
        number(fastest_one_ray(rays)),
        number(ratios.fast),
        number(ratios.robust),
        number(ratios.one),
        fmt::format("{:.1e}", rays.disagreement));
}

void add(GeometricMean& mean, std::optional<double> value) {
    if (value)
        mean.add(*value);
}

std::string number(const GeometricMean& mean) {
    return mean.count() > 0 ? fmt::format("{:.3g}", mean.value()) : std::string();
}

/// The rows of the index for the scenes of one kind, and their mean where there are several.
std::string rows(
    const std::vector<SceneMeasurement>& scenes,
    BenchSceneKind kind,
    const std::string& ray_kind,
    const std::string& index) {
    std::string text;
    GeometricMean fast;
    GeometricMean robust;
    GeometricMean one;
    std::size_t count = 0;
    for (const SceneMeasurement& scene : scenes)
        for (const RaysMeasurement& rays : scene.rays) {
            if (scene.kind != kind || rays.rays != ray_kind || !best_rate(rays, index))
                continue;
            text += row(scene, rays, index);
            const Ratios ratios = ratios_of(rays, index);
            add(fast, ratios.fast);
            add(robust, ratios.robust);
            add(one, ratios.one);
            ++count;
        }
    if (count > 1)
        text += fmt::format(
            "  {:<104}  {:>6} {:>6} {:>6}\n",
            fmt::format("geometric mean, {}, {}", name_of(kind), index),
            number(fast),
            number(robust),
            number(one));
    return text;
}

std::string rays_table(
    const std::vector<SceneMeasurement>& scenes,
    const std::string& kind,
    const MeasurementSettings& settings) {
    std::string body;
    for (const BenchSceneKind scene_kind :
         {BenchSceneKind::triangles, BenchSceneKind::spheres, BenchSceneKind::rotational})
        for (const std::string& index : settings.indexes)
            body += rows(scenes, scene_kind, kind, index);
    // Such rays there may be none of: shadow rays where nothing is hit.
    if (body.empty())
        return body;
    return fmt::format("\n{}: million rays a second\n", kind)
        + fmt::format(
               fmt::runtime(rays_format),
               "scene",
               "index",
               name_of(OurCall::generation, settings.generation),
               name_of(OurCall::all, settings.generation),
               "1 by 1",
               "Embree",
               "its fastest call",
               "robust",
               "1 by 1",
               "ratio",
               "robust",
               "1 by 1",
               "disagree")
        + body;
}

} // namespace

void GeometricMean::add(double value) {
    logarithms_ += std::log(value);
    ++count_;
}

double GeometricMean::value() const {
    return std::exp(logarithms_ / static_cast<double>(count_));
}

std::string
as_text(const std::vector<SceneMeasurement>& scenes, const MeasurementSettings& settings) {
    std::string text = fmt::format(
        "Embree {}, threads: {}, median of {}; ratio: VERA's rate by Embree's\n\n",
        RTC_VERSION_STRING,
        settings.threads,
        settings.runs);
    text += builds_table(scenes);
    for (const std::string& kind : settings.rays)
        text += rays_table(scenes, kind, settings);
    return text;
}

} // namespace vera
