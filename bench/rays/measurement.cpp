// SPDX-License-Identifier: Apache-2.0
#include "measurement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "embree_query.h"
#include "turns.h"
#include <fmt/format.h>

namespace vera {

namespace {

/// The seconds that each run took.
using Seconds = std::vector<double>;

double median(Seconds seconds) {
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
}

Rate rate(std::size_t rays, const Seconds& seconds) {
    const auto of = [&](double time) { return 1e-6 * static_cast<double>(rays) / time; };
    const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
    return {of(median(seconds)), of(*most), of(*least)};
}

/// How far apart the two sides' t of a ray may be: Embree's are floats, and its ray starts a little
/// beside ours, which moves t by the more the flatter the ray meets the face.
float tolerance(const QueryRay& query, const FloatRay& theirs, float t) {
    constexpr double largest_slope = 100;
    const auto [x, y, z] = theirs.origin;
    const Vec3 start = {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    const double beside = length(start - query.ray.origin) / length(query.ray.direction);
    return static_cast<float>(1e-3 * static_cast<double>(t) + largest_slope * beside);
}

bool agree(float ours, float theirs, float difference) {
    if (std::isinf(ours) || std::isinf(theirs))
        return ours == theirs;
    return std::abs(ours - theirs) <= difference;
}

/// The part of the rays of which the two sides say otherwise.
double disagreement(const RaySet& rays, const Distances& ours, const Distances& theirs) {
    std::size_t different = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const float difference = tolerance(rays.queries[i], rays.floats[i], ours[i]);
        different += agree(ours[i], theirs[i], difference) ? 0 : 1;
    }
    return ours.empty() ? 0 : static_cast<double>(different) / static_cast<double>(ours.size());
}

/// Embree's scene of each quality.
struct EmbreeScenes {
    EmbreeInput input;
    std::vector<std::pair<EmbreeQuality, std::unique_ptr<EmbreeScene>>> scenes;
};

/// One of Embree's calls on one of its scenes, and what it took so far.
struct Contender {
    const EmbreeScene* scene = nullptr;
    EmbreeQuality quality = EmbreeQuality::medium;
    EmbreeCall call;
    Seconds seconds;
};

std::vector<Contender> contenders(const EmbreeScenes& embree, Coherence coherence) {
    std::vector<Contender> all;
    for (const auto& [quality, scene] : embree.scenes)
        for (const EmbreeCall& call : embree_calls(coherence))
            all.push_back({scene.get(), quality, call, {}});
    return all;
}

/// Runs everyone in turn, so that what the machine does meanwhile meets all alike.
RaysMeasurement measured_rays(
    const RayIndex& index,
    const EmbreeScenes& embree,
    const RaySet& rays,
    const RaysBenchSettings& settings) {
    RaysMeasurement result;
    result.rays = rays.name;
    result.count = rays.queries.size();
    if (rays.queries.empty())
        return result;
    OurQuery our_query(index, rays, settings.threads);
    EmbreeQuery embree_query(rays, settings.threads);
    std::vector<Contender> theirs = contenders(embree, rays.coherence);
    Seconds ours;
    Seconds ours_whole;
    Distances our_distances;
    for (std::size_t run = 0; run < settings.runs; ++run) {
        ours.push_back(our_query.run(settings.generation));
        ours_whole.push_back(our_query.run(whole_generation));
        if (run == 0)
            our_distances = our_query.distances();
        for (Contender& each : theirs) {
            each.seconds.push_back(embree_query.run(*each.scene, each.call));
            if (run == 0)
                result.disagreement = std::max(
                    result.disagreement,
                    disagreement(rays, our_distances, embree_query.distances()));
        }
    }
    result.ours = rate(result.count, ours);
    result.ours_whole = rate(result.count, ours_whole);
    for (const Contender& each : theirs)
        result.embree.push_back(
            {name_of(each.call, rays.question), each.quality, rate(result.count, each.seconds)});
    return result;
}

std::unique_ptr<RayIndex>
built_index(const Scene& scene, const RaysBenchSettings& settings, SceneMeasurement& result) {
    const Stopwatch watch(settings.threads);
    auto index = make_index(settings.index, scene);
    result.builds.push_back(
        {settings.index, watch.seconds(), static_cast<double>(index->memory())});
    return index;
}

void build_embree(
    EmbreeDevice& device,
    EmbreeScenes& embree,
    const RaysBenchSettings& settings,
    SceneMeasurement& result) {
    for (const EmbreeQuality quality : {EmbreeQuality::medium, EmbreeQuality::high}) {
        const Stopwatch watch(settings.threads);
        auto scene = std::make_unique<EmbreeScene>(
            device, embree.input, EmbreeSettings{quality, settings.edges});
        result.builds.push_back(
            {fmt::format("Embree {}", name_of(quality)),
             watch.seconds(),
             static_cast<double>(scene->memory())});
        embree.scenes.emplace_back(quality, std::move(scene));
    }
}

} // namespace

const EmbreeRate& best(const RaysMeasurement& measurement) {
    return *std::max_element(
        measurement.embree.begin(),
        measurement.embree.end(),
        [](const EmbreeRate& a, const EmbreeRate& b) { return a.rate.median < b.rate.median; });
}

std::optional<SceneMeasurement>
measured_scene(const std::string& name, const RaysBenchSettings& settings) {
    fmt::print(stderr, "{}: making the scene\n", name);
    const auto made = bench_scene(name, settings.size);
    if (!made) {
        fmt::print(stderr, "{}: left out, since its file is not there\n", name);
        return std::nullopt;
    }
    const Scene& scene = made->scene;
    SceneMeasurement result;
    result.name = name;
    result.kind = made->kind;
    result.primitives = scene.geometry.primitive_count;
    fmt::print(stderr, "{}: building for {} primitives\n", name, result.primitives);
    const auto index = built_index(scene, settings, result);
    EmbreeDevice device(settings.threads, settings.embree);
    EmbreeScenes embree = {embree_input(scene), {}};
    build_embree(device, embree, settings, result);

    const PrimaryHits hits = primary_hits(scene, *index, settings.raster);
    for (const std::string& kind : settings.rays) {
        const RaySet rays = ray_set(kind, scene, hits);
        fmt::print(stderr, "{}: {}, {} rays\n", name, kind, rays.queries.size());
        RaysMeasurement measurement = measured_rays(*index, embree, rays, settings);
        if (measurement.count > 0)
            result.rays.push_back(std::move(measurement));
    }
    return result;
}

} // namespace vera
