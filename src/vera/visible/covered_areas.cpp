// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/covered_areas.h"

#include "vera/base/disjoint_sets.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"

#include <algorithm>
#include <cstddef>

namespace vera {

namespace {

/// A part of a border beyond which nothing is seen.
struct Side {
    std::uint32_t area = 0;
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t place = 0; ///< of its first vertex in ring_vertices
    bool used = false;
};

bool comes_before(const Side& a, const Side& b) {
    return a.area != b.area ? a.area < b.area : a.from < b.from;
}

/// Calls visit(source, the places in ring_vertices of one of its vertices and of the next, what is
/// seen across).
template <typename Visit>
void for_each_side(
    const VisibleMap& map, const Progress& progress, const CancelFlag* cancel, const Visit& visit) {
    const LongLoop loop(map.rings.size(), progress, cancel);
    for (std::size_t number = 0; number < map.rings.size(); ++number) {
        loop.turn(number);
        const VisibleMap::Ring& ring = map.rings[number];
        for (std::size_t i = 0; i < ring.count; ++i)
            visit(
                ring.source,
                static_cast<std::uint32_t>(ring.first + i),
                static_cast<std::uint32_t>(ring.first + (i + 1 == ring.count ? 0 : i + 1)),
                map.source_across(ring.first + i));
    }
}

/// The way that begins with the side and goes on, in its area, until nothing is left to go on with:
/// at the side's beginning, since as many sides end at a vertex as begin there.
std::vector<std::uint32_t> way_from(std::vector<Side>& sides, Side& first) {
    std::vector<std::uint32_t> way;
    for (Side* side = &first; side != nullptr;) {
        side->used = true;
        way.push_back(side->place);
        const Side wanted = {side->area, side->to, 0};
        auto next = std::lower_bound(sides.begin(), sides.end(), wanted, comes_before);
        while (next != sides.end() && !comes_before(wanted, *next) && next->used)
            ++next;
        side = next == sides.end() || comes_before(wanted, *next) ? nullptr : &*next;
    }
    return way;
}

} // namespace

CoveredAreas
covered_areas(const VisibleMap& map, const Progress& progress, const CancelFlag* cancel) {
    StageProgress stages(progress, 3);
    CoveredAreas areas;
    if (map.rings.empty())
        return areas;
    const std::size_t source_count = std::size_t{map.rings.back().source} + 1;
    DisjointSets joined(source_count);
    for_each_side(
        map,
        stages.next(1),
        cancel,
        [&](std::uint32_t source, std::uint32_t, std::uint32_t, std::uint32_t across) {
            if (across != no_source)
                joined.join(source, across);
        });
    constexpr std::uint32_t none = ~std::uint32_t{0};
    areas.of_source.assign(source_count, none);
    for (const VisibleMap::Ring& ring : map.rings) {
        // The smallest of an area stands for it, and so comes first.
        std::uint32_t& area = areas.of_source[joined.first_of(ring.source)];
        if (area == none) {
            area = static_cast<std::uint32_t>(areas.outlines.size());
            areas.outlines.emplace_back();
        }
        areas.of_source[ring.source] = area;
    }

    std::vector<Side> sides;
    for_each_side(
        map,
        stages.next(1),
        cancel,
        [&](std::uint32_t source, std::uint32_t from, std::uint32_t to, std::uint32_t across) {
            if (across == no_source)
                sides.push_back(
                    {areas.of_source[source],
                     map.ring_vertices[from],
                     map.ring_vertices[to],
                     from});
        });
    std::stable_sort(sides.begin(), sides.end(), comes_before);
    const LongLoop loop(sides.size(), stages.next(1), cancel);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        loop.turn(i);
        if (!sides[i].used)
            areas.outlines[sides[i].area].push_back(way_from(sides, sides[i]));
    }
    return areas;
}

} // namespace vera
