// SPDX-License-Identifier: Apache-2.0
// Point location in slabs (Sarnak and Tarjan 1986). Through each end of a border a vertical line is
// thought, and between two such lines borders are in one order from below to above, which a search
// tree keeps. From one slab to the next few borders change. So the tree is persistent: each of its
// versions stays as it was, and has its nodes in common with the others. A node has place for one
// change of a child; the next one copies it (Driscoll, Sarnak, Sleator and Tarjan 1989). All
// versions together then take as much memory as there are borders, apart from a factor.
//
// The tree is a treap, whose shape depends on the numbers of the borders alone: a change of it
// turns a constant number of children on the average.
#pragma once

#include "vera/visible/region_locator.h"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace vera {

class SlabTree : public RegionLocator {
public:
    /// Throws Cancelled, and CrossingBorders.
    explicit SlabTree(MapSegments segments, const CancelFlag* cancel = nullptr);

    std::uint32_t region_at(const MapPoint& point, LocatorSteps& steps) const override;

    std::size_t memory() const override;

    std::uint64_t build_steps() const override { return build_steps_; }

private:
    friend class SlabTreeBuilder;

    static constexpr std::uint32_t no_node = ~std::uint32_t{0};

    enum Side : std::uint8_t { below, above };

    /// A border in some versions of the tree, and its children.
    struct Node {
        std::uint32_t segment = 0;
        std::array<std::uint32_t, 2> children = {no_node, no_node};
        std::uint32_t version = 0; ///< the first in which it is
        /// From that version on the child on that side is another one.
        std::uint32_t changed_version = ~std::uint32_t{0};
        std::uint32_t changed_child = no_node;
        Side changed_side = below;
    };

    /// As it is in the version.
    static std::uint32_t child(const Node& node, Side side, std::uint32_t version) {
        return node.changed_version <= version && node.changed_side == side ? node.changed_child
                                                                            : node.children[side];
    }

    MapSegments segments_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> slabs_; ///< points where slabs begin, by ascending x
    std::vector<std::uint32_t> roots_; ///< of each version: that of its slab
    std::uint64_t build_steps_ = 0;
};

} // namespace vera
