// SPDX-License-Identifier: Apache-2.0
// Many rays among rectangles across the z axis, by a plane that moves through all of them (VERA
// 3.3.2, "space sweep"; Mueller 1986). It carries the places at which it meets the rays in a
// kinetic range tree, and where it comes to a rectangle that tree tells the rays that meet it.
//
// With k crossings of m rays within the range of the n rectangles, and I rays told, it takes
// O((m + k) log^2 m + n (log n + log^2 m) + I) steps and O(m log m + n) of space. k is 0 where all
// rays come from a point behind their beginnings, as those of a viewer or a light do, and m^2 at
// most.
#pragma once

#include "vera/base/parallel.h"
#include "vera/theory/kinetic_range_tree.h"
#include "vera/theory/moving_plane.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vera {

/// Calls the meeting for all rectangles that each ray meets up to where it ends. Throws
/// std::invalid_argument as require_sloped_rays() and require_rectangles() do, std::runtime_error
/// where the memory that is available does not suffice, and Cancelled.
void sweep(
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    SweepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// As brute_force_first_rectangles(): a ray ends at the first rectangle that it meets. Throws as
/// sweep() does.
FirstRectangles sweep_first_rectangles(
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    SweepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// What a sweep takes of memory, in bytes, at most; without what the allocator takes for itself.
double sweep_bytes_forecast(std::size_t rectangles, std::size_t rays);

namespace detail {

/// The same, of what is known to be right and to fit into memory.
void sweep_checked(
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    SweepCounts& counts,
    const Progress& progress,
    const CancelFlag* cancel);

} // namespace detail

} // namespace vera
