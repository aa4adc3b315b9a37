// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "embree_scene.h"
#include "our_index.h"
#include "scenes.h"

namespace vera {

/// What is measured of a scene, and how often.
struct MeasurementSettings {
    std::vector<std::string> indexes;
    std::vector<EmbreeSettings> embree;
    std::vector<std::string> rays;
    std::size_t runs = 5;
    std::size_t threads = 1;
    std::size_t raster = 1024;     ///< primary rays across the picture, and as many down
    std::size_t generation = 1024; ///< rays that our indexes are asked about at a time
    std::string embree_device;     ///< settings of Embree's device
};

/// Million rays a second of the median run, and of the slowest and the fastest.
struct Rate {
    double median = 0;
    double slowest = 0;
    double fastest = 0;
};

struct OurRate {
    std::string index;
    OurCall call = OurCall::generation;
    Rate rate;
};

struct EmbreeRate {
    EmbreeSettings build;
    std::string call;
    bool one_ray = false; ///< a call for each ray
    Rate rate;
};

/// Counted steps for each ray.
struct StepsPerRay {
    std::string index;
    double nodes = 0;
    double tests = 0;
};

/// One kind of rays in one scene.
struct RaysMeasurement {
    std::string rays;
    std::size_t count = 0;
    std::vector<OurRate> ours;
    std::vector<EmbreeRate> embree;
    std::vector<StepsPerRay> steps;
    double disagreement = 0; ///< part of the rays that someone answered unlike our first index
};

/// More than this part of the rays is no comparison of like with like. Where Embree sees flat sides
/// in place of round ones, shadows begin a little elsewhere.
constexpr double largest_disagreement(BenchSceneKind kind) {
    return kind == BenchSceneKind::rotational ? 5e-3 : 1e-3;
}

/// Million rays a second of the index's fastest call for many rays; nothing where it was not asked.
std::optional<double> best_rate(const RaysMeasurement& rays, const std::string& index);

/// Of its call for one ray.
std::optional<double> one_ray_rate(const RaysMeasurement& rays, const std::string& index);

/// The fastest of Embree's calls that are wanted; null where there is none.
template <typename Predicate>
const EmbreeRate* fastest_of_embree(const RaysMeasurement& rays, const Predicate& wanted) {
    const EmbreeRate* fastest = nullptr;
    for (const EmbreeRate& each : rays.embree)
        if (wanted(each) && (fastest == nullptr || each.rate.median > fastest->rate.median))
            fastest = &each;
    return fastest;
}

struct BuildMeasurement {
    std::string name;
    std::optional<EmbreeSettings> embree; ///< nothing: it is ours
    double seconds = 0;                   ///< the median of some
    double bytes = 0;                     ///< beside the scene
    double nodes = 0;                     ///< 0 where it does not say
};

struct SceneMeasurement {
    std::string name;
    BenchSceneKind kind = BenchSceneKind::triangles;
    std::size_t primitives = 0;
    std::size_t triangles_for_embree = 0; ///< of which there are more where shapes are round
    std::vector<BuildMeasurement> builds; ///< ours first
    std::vector<RaysMeasurement> rays;
};

/// Measures a scene; tells standard error how far it is.
SceneMeasurement measured_scene(const BenchScene& scene, const MeasurementSettings& settings);

/// Whether both sides found the same; tells standard error where they did not.
bool all_agree(const std::vector<SceneMeasurement>& scenes);

} // namespace vera
