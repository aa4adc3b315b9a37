// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/grid_rings.h"

#include "vera/base/check.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace vera {

namespace {

/// A quarter turn to the left is 1 more, and 4 turns are none.
unsigned direction(const GridEdge& edge) {
    if (edge.from.y == edge.to.y)
        return edge.from.x < edge.to.x ? 0 : 2;
    return edge.from.y < edge.to.y ? 1 : 3;
}

class Linking {
public:
    Linking(std::vector<GridEdge> edges, std::uint64_t& comparisons)
        : edges_(std::move(edges))
        , is_done_(edges_.size())
        , comparisons_(comparisons) {
        std::sort(edges_.begin(), edges_.end(), [&](const GridEdge& a, const GridEdge& b) {
            ++comparisons_;
            return a.from != b.from ? a.from < b.from : direction(a) < direction(b);
        });
    }

    std::vector<GridRing> rings() {
        std::vector<GridRing> rings;
        for (std::size_t i = 0; i < edges_.size(); ++i)
            if (!is_done_[i])
                rings.push_back(ring_from(i));
        return rings;
    }

private:
    /// What goes on at the end of the edge. Where two do, they go opposite ways, and the one to the
    /// left goes round the same part of the area.
    std::size_t following(const GridEdge& edge) const {
        const auto first = std::lower_bound(
            edges_.begin(), edges_.end(), edge.to, [&](const GridEdge& other, GridCorner corner) {
                ++comparisons_;
                return other.from < corner;
            });
        VERA_CHECK(first != edges_.end() && first->from == edge.to);
        const auto number = static_cast<std::size_t>(first - edges_.begin());
        const bool is_meeting = number + 1 < edges_.size() && edges_[number + 1].from == edge.to;
        return is_meeting && direction(*first) != (direction(edge) + 1) % 4 ? number + 1 : number;
    }

    /// The first edge begins at a corner: no other edge of the ring begins farther to the left or
    /// below, so that the way comes from above and leaves to the right, or the other way.
    GridRing ring_from(std::size_t first) {
        GridRing ring = {edges_[first].from};
        for (std::size_t at = first;;) {
            is_done_[at] = true;
            const std::size_t next = following(edges_[at]);
            if (next == first)
                return ring;
            if (direction(edges_[next]) != direction(edges_[at]))
                ring.push_back(edges_[next].from);
            at = next;
        }
    }

    std::vector<GridEdge> edges_;
    std::vector<bool> is_done_;
    std::uint64_t& comparisons_;
};

} // namespace

std::vector<GridRing> grid_rings(std::vector<GridEdge> edges, std::uint64_t& comparisons) {
    return Linking(std::move(edges), comparisons).rings();
}

} // namespace vera
