// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/closed_bodies.h"

#include "vera/base/disjoint_sets.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace vera {

namespace {

struct Side {
    std::array<std::uint32_t, 2> corners; ///< the smaller number first
    std::uint32_t facet = 0;
    bool is_forward = false; ///< from the first corner to the second

    bool is_same_as(const Side& other) const { return corners == other.corners; }
};

std::vector<Side> sides_of(const Facets& facets) {
    std::vector<Side> sides;
    sides.reserve(3 * facets.triangles.size());
    for (std::uint32_t i = 0; i < facets.triangles.size(); ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const auto& corners = facets.triangles[i].corners;
            const auto [low, high] = std::minmax(corners[j], corners[(j + 1) % 3]);
            sides.push_back({{low, high}, i, corners[j] == low});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::pair(a.corners, a.facet) < std::pair(b.corners, b.facet);
    });
    return sides;
}

} // namespace

ClosedBodies closed_bodies(const Facets& facets) {
    const std::size_t count = facets.triangles.size();
    const std::vector<Side> sides = sides_of(facets);
    DisjointSets joined(count);
    std::vector<std::uint8_t> is_open(count);
    for (auto first = sides.begin(); first != sides.end();) {
        const auto last = std::find_if(
            first, sides.end(), [&](const Side& side) { return !side.is_same_as(*first); });
        const bool are_two = last - first == 2 && first->is_forward != (first + 1)->is_forward
            && first->corners[0] != first->corners[1];
        for (auto side = first; side != last; ++side) {
            joined.join(side->facet, first->facet);
            is_open[side->facet] |= are_two ? 0 : 1;
        }
        first = last;
    }
    for (std::uint32_t i = 0; i < count; ++i)
        if (is_open[i] != 0)
            is_open[joined.first_of(i)] = 1;

    ClosedBodies bodies;
    bodies.of_facet.assign(count, no_body);
    std::vector<std::uint32_t> numbers(count, no_body); // of roots
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t root = joined.first_of(i);
        if (is_open[root] != 0)
            continue;
        if (numbers[root] == no_body) {
            numbers[root] = static_cast<std::uint32_t>(bodies.boxes.size());
            bodies.boxes.emplace_back();
        }
        bodies.of_facet[i] = numbers[root];
        Box3& box = bodies.boxes[numbers[root]];
        for (const std::uint32_t corner : facets.triangles[i].corners)
            box = grown(box, facets.corners[corner]);
    }
    return bodies;
}

} // namespace vera
