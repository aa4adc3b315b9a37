// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

#include "float_geometry.h"
#include "meshes.h"
#include "ray_sets.h"

namespace vera {

/// How large the scenes are that are made: small enough for a smoke test, or as they are to be
/// measured.
enum class BenchSize { quick, full };

/// What a scene's rays are compared on: the mean is taken over the scenes of one kind.
enum class BenchSceneKind { triangles, spheres, rotational };

const char* name_of(BenchSceneKind kind);

/// The names of all scenes, those that are measured when none is named first.
std::vector<std::string> bench_scene_names();

/// Those of them that are measured when none is named.
std::vector<std::string> usual_bench_scene_names();

/// A scene with a camera and a light, all of it opaque.
struct BenchScene {
    std::string name;
    BenchSceneKind kind = BenchSceneKind::triangles;
    Scene scene;
    Facets facets;                  ///< what Embree sees in place of rotational shapes
    double beside = usually_beside; ///< how far from faces its rays start
};

/// The scene of that name; nothing where it needs a file that is not there. Models are looked for
/// in the folder that the environment variable VERA_MODELS names, scenes in that of VERA_SCENES.
std::optional<BenchScene> bench_scene(const std::string& name, BenchSize size);

/// The scenes "mountain" and "flake" of other sizes.
BenchScene mountain_of(std::size_t side);
BenchScene flake_of(const Sphereflake& flake);

} // namespace vera
