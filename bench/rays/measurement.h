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

/// What is measured, and how often.
struct RaysBenchSettings {
    std::string index = index_names().front();
    std::vector<std::string> scenes;
    std::vector<std::string> rays;
    BenchSize size = BenchSize::full;
    std::size_t runs = 5;
    std::size_t threads = 1;
    std::size_t raster = 1024;     ///< primary rays across the picture, and as many down
    std::size_t generation = 1024; ///< rays that our index is asked about at a time
    EmbreeEdges edges = EmbreeEdges::fast;
    std::string embree; ///< settings of its device
};

/// Million rays a second of the median run, and of the slowest and the fastest.
struct Rate {
    double median = 0;
    double slowest = 0;
    double fastest = 0;
};

struct EmbreeRate {
    std::string call;
    EmbreeQuality quality = EmbreeQuality::medium;
    Rate rate;
};

/// One kind of rays in one scene.
struct RaysMeasurement {
    std::string rays;
    std::size_t count = 0;
    Rate ours;       ///< in generations
    Rate ours_whole; ///< all rays at once
    std::vector<EmbreeRate> embree;
    double disagreement = 0; ///< part of the rays that some call of Embree's answered otherwise
};

/// More than this is no comparison of like with like.
constexpr double largest_disagreement = 1e-3;

/// The fastest call of Embree's. There is one.
const EmbreeRate& best(const RaysMeasurement& measurement);

struct BuildMeasurement {
    std::string name;
    double seconds = 0;
    double bytes = 0;
};

struct SceneMeasurement {
    std::string name;
    BenchSceneKind kind = BenchSceneKind::triangles;
    std::size_t primitives = 0;
    std::vector<BuildMeasurement> builds; ///< ours first
    std::vector<RaysMeasurement> rays;
};

/// Measures a scene; tells standard error how far it is. Nothing where the scene needs a file that
/// is not there.
std::optional<SceneMeasurement>
measured_scene(const std::string& name, const RaysBenchSettings& settings);

} // namespace vera
