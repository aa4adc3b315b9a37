// SPDX-License-Identifier: Apache-2.0
// The rays of a generation among rectangles by nested trees (VERA 3.3.2, proposition 3): rectangles
// are asked in the order in which they lie along the rays, and a ray is live in the trees from
// where it begins until it ends. So a ray that ends at the first rectangle that it meets is told
// once, and all are told in O(n m^0.695 polylog m + m log^2 m) steps for n rectangles. Where rays
// cross makes no difference.
//
// Rays are divided into up to eight parts (ray_parts.h), each with trees of its own, which are
// made, asked and freed by all threads: that costs eight times a root at most.
#pragma once

#include "vera/theory/moving_plane.h"
#include "vera/theory/ray_trees.h"

#include <cstddef>
#include <span>

namespace vera {

/// As sweep(), by nested trees, and throws likewise. The meeting is called from many threads, but
/// never from two of the same ray at once; of each ray in the order of sweep(). The counts are the
/// same for any number of threads, and do not tell what it takes to make the trees.
void query_trees(
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    StepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// The same by trees of these rays in one part, on one thread; `last_z` as in SweptRays.
void query_trees(
    std::span<const IsoRectangle> rectangles,
    const RayTrees& trees,
    std::span<const std::int32_t> last_z,
    const Meeting& meeting,
    StepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// The rectangle that each ray meets first: as brute_force_first_rectangles(), and throws likewise.
FirstRectangles first_rectangles(
    std::span<const IsoRectangle> rectangles,
    const RayTrees& trees,
    StepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// What query_trees() takes of memory, in bytes, at most; without what the allocator takes for
/// itself.
double query_trees_bytes_forecast(std::size_t rectangles, std::size_t rays);

} // namespace vera
