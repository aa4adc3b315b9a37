// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/generator.h"

#include <array>

namespace vera {

constexpr std::array<Parameter, 6> tree_parameters = {{
    {"levels", 7, 1, 14, true, "forks from the trunk to a twig"},
    {"limbs", 3, 2, 5, true, "branches that leave a branch at its end"},
    {"leaves", 12, 0, 100, true, "leaves on a twig"},
    {"spread", 36, 0, 80, false, "degrees by which limbs lean away"},
    {"variants", 4, 1, 20, true, "different branches of each level; the rest are the same ones"},
    {"seed", 1, 0, 1e9, true, "of the random numbers"},
}};
/// A tree by recursion: each branch carries smaller trees (VERA figure 2f).
Scene make_tree(const ParameterValues& values);

constexpr std::array<Parameter, 5> forest_parameters = {{
    {"rows", 8, 1, 1000, true, "rows of trees, and trees in a row"},
    {"levels", 6, 1, 14, true, "forks of a tree from the trunk to a twig"},
    {"leaves", 12, 0, 100, true, "leaves on a twig"},
    {"variants", 4, 1, 20, true, "different trees"},
    {"seed", 1, 0, 1e9, true, "of the random numbers"},
}};
/// Trees in rows on uneven distances, all of the same few subscenes.
Scene make_forest(const ParameterValues& values);

} // namespace vera
