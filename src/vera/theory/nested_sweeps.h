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
#include "vera/theory/ray_trees.h"

#include <cstddef>
#include <span>

namespace vera {

struct NestedSweepCounts {
    StepCounts trees;
    SweepCounts sweeps;
};

/// As brute_force_first_rectangles(). Throws std::invalid_argument as require_sloped_rays() and
/// require_rectangles() do, std::runtime_error where the memory that is available does not suffice,
/// and Cancelled.
FirstRectangles nested_sweeps_first_rectangles(
    std::size_t level,
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    NestedSweepCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr,
    TreeKind kind = TreeKind::conjugation);

} // namespace vera
