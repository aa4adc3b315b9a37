// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_walk.h"
#include "vera/base/parallel.h"
#include "vera/render/ray_tree.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene_objects.h"

namespace vera {

/// What a ray of a ray tree visits in the index, and what its shadow rays do.
struct RayVisits {
    RayWalk walk;
    std::vector<std::optional<RayWalk>> shadow_walks; ///< of each light, where it was asked

    /// Cells, nodes, leaves and objects of all rays of a tree are listed up to so many.
    static constexpr std::size_t most = 100'000;
};

/// Of each ray of the tree; nothing where there are too many. The index is that of the tree, and a
/// WalkedIndex.
std::optional<std::vector<RayVisits>>
ray_visits(const RayTree& tree, const RayIndex& index, const CancelFlag& cancel);

/// Of a subscene that is called in a place, where an object of the walk stands: the call itself.
SceneObject::Call call_of(const WalkedPlace& place, const WalkedObject& object, SceneObjects& of);

/// "missed", "met", "tested_before", "entered" or "searched".
const char* name_of(WalkedObject::Outcome outcome);

/// The walk for people, line by line. The ray's direction is so long.
std::vector<std::string>
visit_lines(const RayWalk& walk, double direction_length, SceneObjects& objects);

} // namespace vera
