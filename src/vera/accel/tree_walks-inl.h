// SPDX-License-Identifier: Apache-2.0
// Rays that go down a tree of boxes each by itself: see tree_search.cpp. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_TREE_WALKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_TREE_WALKS_INL_H
#undef VERA_ACCEL_TREE_WALKS_INL_H
#else
#define VERA_ACCEL_TREE_WALKS_INL_H
#endif

#include "vera/accel/packet_query.h"
#include "vera/accel/tree_blocks-inl.h"
#include "vera/accel/tree_lanes-inl.h"
#include "vera/accel/tree_structures.h"

#include <array>
#include <bit>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Walks = std::array<Walk, packet_size>;

/// Sets a lane's ray on its way, with nothing waiting.
HWY_INLINE void start_walk(
    const PacketQuery& query, Frame& frame, const BoxRays& rays, std::size_t lane, Walk& walk) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        walk.inverse[axis] = rays.inverse[axis][lane];
        walk.near_offset[axis] = rays.near_offset[axis][lane];
        walk.far_offset[axis] = rays.far_offset[axis][lane];
    }
    const std::size_t octant = octant_of(rays, lane);
    walk.places = plane_places[octant];
    walk.order = static_cast<std::uint8_t>(order_of(query, octant));
    walk.size = 0;
    walk.stack = frame.waiting.data() + lane * waiting_depth(tree_of(frame).levels);
}

/// Follows each of the lanes' rays down from what waits for it, by itself. The rays take steps in
/// turn, so that what each needs next arrives while the others work.
inline void search_apart(PacketQuery& query, Frame& frame, Walks& walks, LaneMask lanes) {
    const GeometryTree& tree = tree_of(frame);
    LaneMask at_node = 0;
    LaneMask at_block = 0;
    const auto go_on = [&](std::size_t lane) HWY_ATTR {
        fetch(tree, walks[lane].next);
        const auto is_block = static_cast<LaneMask>(walks[lane].next.is_block());
        at_block |= is_block << lane;
        at_node |= (1 - is_block) << lane;
    };
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        if (take_waiting(walks[lane]))
            go_on(lane);
    }
    while ((at_node | at_block) != 0) {
        LaneMask rest = at_node;
        at_node = 0;
        query.counts.cells += static_cast<std::uint64_t>(std::popcount(rest));
        for (; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            Walk& walk = walks[lane];
            add_met_children(tree.nodes[walk.next.first()], frame.limit[lane], walk);
            if (take_waiting(walk))
                go_on(lane);
        }
        rest = at_block;
        at_block = 0;
        for (; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            Walk& walk = walks[lane];
            const float before = frame.limit[lane];
            visit_block_alone(query, frame, walk.next, lane);
            const float limit = frame.limit[lane];
            if (limit < before)
                walk.size = limit < 0 ? 0 : drop_behind(walk.stack, walk.size, limit);
            if (take_waiting(walk))
                go_on(lane);
        }
    }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
