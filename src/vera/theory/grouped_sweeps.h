// SPDX-License-Identifier: Apache-2.0
// Space sweeps through groups of rays (VERA 3.3.2, proposition 5). Rays cross up to m^2 times, and
// each crossing takes steps. In groups of m / 2^i rays that are near to one another, only crossings
// within a group count: m^2 / 2^i together. But each rectangle is asked of all groups that it may
// meet: 2^(i alpha), as many as a line of the plane leaves of the nodes of a conjugation tree
// undecided, alpha = 0.694. Both are equal at one i, and there is a valley in the steps.
//
// Groups are the nodes at which two nested conjugation trees are cut, of the points (a, b) of the
// rays and then of the points (c, d) of those of one node. What a group is asked is told by the
// convex hulls of its rays' points. Each group has a sweep of its own, so space stays linear, but
// for a logarithm, and groups are answered by many threads.
#pragma once

#include "vera/theory/space_sweep.h"
#include "vera/theory/tree_kind.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vera {

/// The level i at which proposition 5 cuts the trees: (2 log m - log n) / (1 + alpha), but from 0
/// to log m. With partition trees of today alpha is 0.5, and both parts are (m n)^(2/3).
std::size_t
stated_level(std::size_t rectangles, std::size_t rays, TreeKind kind = TreeKind::conjugation);

/// The level at which the steps are likely to be fewest, those that divide the rays among them: by
/// the crossings among a thousand pairs of the rays within the range of the rectangles. 0, which is
/// one sweep of all, where rays that come from one point do not cross.
std::size_t
sampled_level(std::span<const IsoRectangle> rectangles, std::span<const SlopedRay> rays);

/// As sweep(), by 2^level groups of rays. The meeting is called from many threads, but never from
/// two of the same ray at once; of each ray in the order of sweep(). The counts are the same for
/// any number of threads.
void sweep_groups(
    std::size_t level,
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    SweepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// As sweep_first_rectangles(), by 2^level groups of rays.
FirstRectangles sweep_groups_first_rectangles(
    std::size_t level,
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    SweepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// What sweep_groups() takes of memory, in bytes, at most; without what the allocator takes for
/// itself.
double sweep_groups_bytes_forecast(std::size_t level, std::size_t rectangles, std::size_t rays);

} // namespace vera
