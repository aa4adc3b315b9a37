// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/camera.h"
#include "vera/scene/geometry.h"
#include "vera/scene/light.h"
#include "vera/scene/material.h"
#include "vera/scene/picture_settings.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vera {

/// Everything that a picture is made from, but the settings of its making. Plain values: the parts
/// refer to one another by number.
struct Scene {
    std::optional<Camera> camera; ///< nothing: to be framed automatically
    std::vector<PointLight> lights;
    std::vector<Material> materials;
    Geometry geometry;
    std::vector<Geometry> subscenes; ///< never call themselves, not through others either
    std::vector<std::string> files;  ///< that the scene was read from; items name them by number
    PictureSettings defaults;        ///< used where no control file is given
};

/// The numbers of all subscenes, each after all those that it calls.
std::vector<std::size_t> callees_first(const Scene& scene);

/// Fills in what is derived in every geometry. Throws InputError when there are more than 2^62
/// primitives, or 2^32 - 1 or more elements in one geometry.
void number_primitives(Scene& scene);

/// How far from the origin geometry may reach: fourth powers of it are finite.
constexpr double largest_reach = 1e70;

/// Throws InputError when an item, of a subscene in its own coordinates, reaches farther.
void check_reach(const Scene& scene);

} // namespace vera
