// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/figures.h"

#include "vera/base/check.h"

#include <algorithm>

namespace vera {

std::size_t DrawnFigure::count(const std::string& what) const {
    const auto found = std::find_if(
        counts.begin(), counts.end(), [&](const FigureCount& each) { return each.what == what; });
    VERA_CHECK(found != counts.end());
    return found->count;
}

std::span<const Figure> figures() {
    static const std::vector<Figure> all = {
        {"3a", "central ray queries as point location on six faces", figure_of_cube},
        {"3b", "the conjugation tree, and a query half-plane", figure_of_conjugation_tree},
        {"3c", "a ray moved in dual space", figure_of_dual_space},
        {"3d", "the segment tree over z, and its range trees", figure_of_segment_tree},
        {"A1", "a scene of 14 polygons and its connection graph", figure_of_connection_graph},
        {"A2", "how the connection graph is traversed", figure_of_traversal},
        {"B1", "overlapping windows, and what is seen of them", figure_of_windows}};
    return all;
}

} // namespace vera
