// SPDX-License-Identifier: Apache-2.0
#include "measurement.h"

#include "vera/accel/wide_bvh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
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

/// How far apart two sides' t of a ray may be: Embree's are floats, and its ray starts a little
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

/// Our indexes, by name.
using OurIndexes = std::vector<std::pair<std::string, std::unique_ptr<OurIndex>>>;

/// Embree's scenes, by how they were built.
using EmbreeScenes = std::vector<std::pair<EmbreeSettings, std::unique_ptr<EmbreeScene>>>;

/// One way to ask one side about rays, and what it took so far.
struct Contender {
    std::function<double()> run;
    std::function<Distances()> distances;
    Seconds seconds;
};

void run_once(Contender& contender) {
    contender.seconds.push_back(contender.run());
}

/// What the queries of one side are, for the contenders that use them.
struct OurContenders {
    std::vector<std::unique_ptr<OurQuery>> queries;
    std::vector<Contender> contenders; ///< one for each of RaysMeasurement::ours
};

OurContenders our_contenders(
    const OurIndexes& indexes,
    const RaySet& rays,
    const MeasurementSettings& settings,
    RaysMeasurement& result) {
    OurContenders ours;
    for (const auto& [name, index] : indexes) {
        ours.queries.push_back(index->query(rays, settings.threads, settings.generation));
        OurQuery* const query = ours.queries.back().get();
        for (const OurCall call : index->calls()) {
            result.ours.push_back({name, call, {}});
            ours.contenders.push_back(
                {[=] { return query->run(call); }, [=] { return query->distances(); }, {}});
        }
    }
    return ours;
}

/// One for each of RaysMeasurement::embree.
std::vector<Contender> embree_contenders(
    const EmbreeScenes& scenes, EmbreeQuery& query, const RaySet& rays, RaysMeasurement& result) {
    std::vector<Contender> contenders;
    for (const auto& [build, scene] : scenes)
        for (const EmbreeCall& call : embree_calls(rays.coherence)) {
            result.embree.push_back(
                {build, name_of(call, rays.question), call.width == EmbreeWidth::one, {}});
            contenders.push_back(
                {[&query, &scene = *scene, call] { return query.run(scene, call); },
                 [&query] { return query.distances(); },
                 {}});
        }
    return contenders;
}

/// Those that may still be the fastest of their like after one run: the others are run no more.
std::vector<std::size_t>
hopeful(const std::vector<EmbreeRate>& rates, const std::vector<Contender>& contenders) {
    constexpr double hopelessly_slower = 1.4;
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < rates.size(); ++i) {
        double least = contenders[i].seconds.front();
        for (std::size_t j = 0; j < rates.size(); ++j)
            if (rates[j].build == rates[i].build && rates[j].one_ray == rates[i].one_ray)
                least = std::min(least, contenders[j].seconds.front());
        if (contenders[i].seconds.front() <= hopelessly_slower * least)
            chosen.push_back(i);
    }
    return chosen;
}

/// Lets every contender answer once; the part of the rays that one answered unlike the first.
double
first_runs(const RaySet& rays, std::vector<Contender>& ours, std::vector<Contender>& theirs) {
    std::optional<Distances> first;
    double most = 0;
    for (auto* const side : {&ours, &theirs})
        for (Contender& each : *side) {
            run_once(each);
            if (first)
                most = std::max(most, disagreement(rays, *first, each.distances()));
            else
                first = each.distances();
        }
    return most;
}

StepsPerRay steps_per_ray(const std::string& index, OurQuery& query, std::size_t rays) {
    const Steps steps = query.steps();
    const auto n = static_cast<double>(rays);
    return {index, static_cast<double>(steps.nodes) / n, static_cast<double>(steps.tests) / n};
}

/// Runs everyone in turn, so that what the machine does meanwhile meets all alike.
RaysMeasurement measured_rays(
    const OurIndexes& indexes,
    const EmbreeScenes& scenes,
    const RaySet& rays,
    const MeasurementSettings& settings) {
    RaysMeasurement result;
    result.rays = rays.name;
    result.count = rays.queries.size();
    if (rays.queries.empty())
        return result;
    OurContenders ours = our_contenders(indexes, rays, settings, result);
    EmbreeQuery embree_query(rays, settings.threads);
    std::vector<Contender> theirs = embree_contenders(scenes, embree_query, rays, result);

    result.disagreement = first_runs(rays, ours.contenders, theirs);
    const std::vector<std::size_t> run_again = hopeful(result.embree, theirs);
    for (std::size_t run = 1; run < settings.runs; ++run) {
        for (Contender& each : ours.contenders)
            run_once(each);
        for (const std::size_t i : run_again)
            run_once(theirs[i]);
    }

    for (std::size_t i = 0; i < result.ours.size(); ++i)
        result.ours[i].rate = rate(result.count, ours.contenders[i].seconds);
    for (std::size_t i = 0; i < result.embree.size(); ++i)
        result.embree[i].rate = rate(result.count, theirs[i].seconds);
    for (std::size_t i = 0; i < indexes.size(); ++i)
        result.steps.push_back(steps_per_ray(indexes[i].first, *ours.queries[i], result.count));
    return result;
}

/// Builds with make() up to three times, fewer if that takes long, and keeps the last.
template <typename Make>
auto built(const MeasurementSettings& settings, BuildMeasurement& result, const Make& make) {
    constexpr std::size_t most = 3;
    constexpr double long_enough = 3;
    Seconds seconds;
    double sum = 0;
    decltype(make()) last;
    do {
        last.reset();
        const Stopwatch watch(settings.threads);
        last = make();
        seconds.push_back(watch.seconds());
        sum += seconds.back();
    } while (last != nullptr && seconds.size() < most && sum < long_enough);
    result.seconds = median(seconds);
    return last;
}

OurIndexes built_indexes(
    const IndexInput& input, const MeasurementSettings& settings, SceneMeasurement& result) {
    OurIndexes indexes;
    for (const std::string& name : settings.indexes) {
        BuildMeasurement build;
        build.name = name;
        auto index = built(settings, build, [&] { return make_index(name, input); });
        if (index == nullptr)
            continue;
        build.bytes = static_cast<double>(index->bytes());
        build.nodes = static_cast<double>(index->nodes());
        result.builds.push_back(build);
        indexes.emplace_back(name, std::move(index));
    }
    return indexes;
}

EmbreeScenes built_embree(
    EmbreeDevice& device,
    const FloatGeometry& floats,
    const MeasurementSettings& settings,
    SceneMeasurement& result) {
    EmbreeScenes scenes;
    for (const EmbreeSettings& each : settings.embree) {
        BuildMeasurement build;
        build.name = name_of(each);
        build.embree = each;
        auto scene = built(
            settings, build, [&] { return std::make_unique<EmbreeScene>(device, floats, each); });
        build.bytes = static_cast<double>(scene->memory());
        result.builds.push_back(build);
        scenes.emplace_back(each, std::move(scene));
    }
    return scenes;
}

template <typename Predicate>
std::optional<double>
fastest_of_ours(const RaysMeasurement& rays, const std::string& index, const Predicate& wanted) {
    std::optional<double> fastest;
    for (const OurRate& each : rays.ours)
        if (each.index == index && wanted(each.call))
            fastest = std::max(fastest.value_or(0), each.rate.median);
    return fastest;
}

} // namespace

std::optional<double> best_rate(const RaysMeasurement& rays, const std::string& index) {
    return fastest_of_ours(rays, index, [](OurCall call) { return call != OurCall::one; });
}

std::optional<double> one_ray_rate(const RaysMeasurement& rays, const std::string& index) {
    return fastest_of_ours(rays, index, [](OurCall call) { return call == OurCall::one; });
}

SceneMeasurement measured_scene(const BenchScene& made, const MeasurementSettings& settings) {
    const Scene& scene = made.scene;
    SceneMeasurement result;
    result.name = made.name;
    result.kind = made.kind;
    result.primitives = scene.geometry.primitive_count;
    fmt::print(stderr, "{}: building for {} primitives\n", made.name, result.primitives);
    // The rays come from an index that is not measured, and is gone when others are.
    const PrimaryHits hits =
        primary_hits(scene, *make_wide_bvh(scene), settings.raster, made.beside);
    const FloatGeometry floats = float_geometry(scene, made.facets);
    result.triangles_for_embree = floats.triangles.size();
    const bool one_mesh =
        scene.geometry.items.size() == 1 && scene.geometry.items.front().kind == ItemKind::mesh;
    const bool only_spheres =
        std::all_of(scene.geometry.items.begin(), scene.geometry.items.end(), [](const Item& item) {
            return item.kind == ItemKind::sphere;
        });
    const OurIndexes indexes =
        built_indexes({scene, floats, one_mesh, only_spheres}, settings, result);
    EmbreeDevice device(settings.threads, settings.embree_device);
    const EmbreeScenes embree = built_embree(device, floats, settings, result);

    for (const std::string& kind : settings.rays) {
        const RaySet rays = ray_set(kind, scene, hits);
        fmt::print(stderr, "{}: {}, {} rays\n", made.name, kind, rays.queries.size());
        RaysMeasurement measurement = measured_rays(indexes, embree, rays, settings);
        if (measurement.count > 0)
            result.rays.push_back(std::move(measurement));
    }
    return result;
}

bool all_agree(const std::vector<SceneMeasurement>& scenes) {
    bool good = true;
    for (const SceneMeasurement& scene : scenes)
        for (const RaysMeasurement& rays : scene.rays)
            if (rays.disagreement > largest_disagreement(scene.kind)) {
                fmt::print(
                    stderr,
                    "{}, {}: the two sides differ on {:.2g} of the rays\n",
                    scene.name,
                    rays.rays,
                    rays.disagreement);
                good = false;
            }
    return good;
}

} // namespace vera
