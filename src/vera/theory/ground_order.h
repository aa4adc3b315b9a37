// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/screen_scene.h"

#include <cstdint>
#include <vector>

namespace vera {

/// The triangles of a terrain from the nearest to the farthest, so that none is hidden by one that
/// comes later.
///
/// In an upright picture (one whose columns are the scene's verticals) a terrain is what has one
/// height over each point of the plane of x and nearness, its ground. There its triangles are
/// apart, and of convex areas in a plane one order always suits every line of sight at once. A
/// sweep along x meets those that are next to each other: O(n log n) steps for n triangles, however
/// many lie one before the other in the picture. `steps`, if given, grows by those.
///
/// Throws InputError that names two triangles of which neither lies before the other on the ground,
/// or which the grid of the picture does not tell apart, or one that stands upright; and Cancelled.
std::vector<std::uint32_t> ground_order(
    const ScreenScene& scene, std::uint64_t* steps = nullptr, const CancelFlag* cancel = nullptr);

} // namespace vera
