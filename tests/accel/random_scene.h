// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <random>
#include <vector>

namespace vera::testing {

/// What a random scene is made of.
struct RandomSceneSettings {
    std::size_t items = 40;
    std::size_t subscenes = 3;
    double scale = 1; ///< all lengths are multiplied by it
    bool glass = false;
    bool curved = true; ///< whether spheres and rotational shapes are among them
};

/// A scene whose coordinates are drawn from few values, so that its faces share corners, edges and
/// planes, coincide, and lie on the borders of cells.
Scene random_scene(std::uint64_t seed, const RandomSceneSettings& settings);

/// Rays through such a scene, drawn from few values as well: along axes and diagonals, from its
/// corners and from far away, of finite and of infinite length, also towards -infinity.
std::vector<QueryRay> random_rays(std::uint64_t seed, std::size_t count, double scale);

/// Groups of rays that start at one point and spread a little.
std::vector<QueryRay> coherent_rays(std::uint64_t seed, std::size_t count, double scale);

/// Rays that start where others have hit.
std::vector<QueryRay>
rays_from_hits(std::uint64_t seed, const std::vector<QueryRay>& rays, const std::vector<Hit>& hits);

} // namespace vera::testing
