// SPDX-License-Identifier: Apache-2.0
// Rectangles among rays by nested trees and sweeps (VERA 3.3.2, proposition 5, as it is stated):
// the trees of proposition 3 are cut from above where nodes have m / 2^level rays. A rectangle goes
// down the trees. Where it comes to the end of the outer one, a space sweep of that node's own rays
// answers; at the end of an inner one, where all rays are where x must be, a plane sweep, in y
// alone. A sweep goes on to the rectangle's z when it is asked, and begins with the first question.
//
// Sweeps take m^2 / 2^level steps together, and trees n 2^(level alpha): at the level of the
// proposition (stated_level()) both are m^0.820 n^0.590, but for logarithms.
#pragma once

#include "vera/base/parallel.h"
#include "vera/theory/kinetic_range_tree.h"
#include "vera/theory/moving_plane.h"
#include "vera/theory/ray_trees.h"

#include <cstddef>
#include <span>

namespace vera {

struct NestedSweepCounts {
    StepCounts trees;
    SweepCounts sweeps;

    NestedSweepCounts& operator+=(const NestedSweepCounts& more) {
        trees += more.trees;
        sweeps += more.sweeps;
        return *this;
    }
};

/// As sweep(), and throws likewise; by trees that are cut at the level. Rays are in 2^parts_level
/// parts at most, each with trees and sweeps of its own, which are worked on by all threads: these
/// levels have no inner trees. Level and parts_level count from the root. The meeting is called
/// from many threads, but never from two of the same ray at once; of each ray in the order of
/// sweep(). The counts are the same for any number of threads.
void nested_sweeps(
    std::size_t level,
    std::size_t parts_level,
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    NestedSweepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr,
    TreeKind kind = TreeKind::conjugation);

/// As brute_force_first_rectangles(), in one part.
FirstRectangles nested_sweeps_first_rectangles(
    std::size_t level,
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    NestedSweepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr,
    TreeKind kind = TreeKind::conjugation);

/// What nested_sweeps() takes of memory, in bytes, at most; of optimal trees about so much.
double nested_sweeps_bytes_forecast(
    std::size_t level,
    std::size_t parts_level,
    std::size_t rectangles,
    std::size_t rays,
    TreeKind kind = TreeKind::conjugation);

} // namespace vera
