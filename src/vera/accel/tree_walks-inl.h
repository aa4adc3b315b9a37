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

/// A ray on its way: what a step takes, side by side.
struct alignas(64) Walk {
    float inverse[3];
    float near_offset[3];
    float far_offset[3];
    std::array<std::uint8_t, 6> places; ///< see plane_places
    std::uint8_t order;                 ///< see put_met_children
    std::uint32_t size;                 ///< of the stack
    TreeChild* stack;                   ///< what waits; the next one is on top
    TreeChild next;                     ///< where the ray is
};

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
    walk.stack = frame.waiting.data() + lane * waiting_depth(tree_of(frame));
}

/// Lets the children of the node wait whose boxes the ray meets before the limit.
HWY_INLINE void add_met_children(const WideNode& node, float limit, Walk& walk) {
    const Children d;
    const float* const planes = node.planes[0].data();
    const auto enter = [&](std::size_t axis, std::size_t i) HWY_ATTR {
        return hn::MulAdd(
            hn::Load(d, planes + walk.places[axis] + i),
            hn::Set(d, walk.inverse[axis]),
            hn::Set(d, walk.near_offset[axis]));
    };
    const auto leave = [&](std::size_t axis, std::size_t i) HWY_ATTR {
        return hn::MulAdd(
            hn::Load(d, planes + walk.places[3 + axis] + i),
            hn::Set(d, walk.inverse[axis]),
            hn::Set(d, walk.far_offset[axis]));
    };
    const auto near_at = [&](std::size_t i) HWY_ATTR {
        return hn::Max(hn::Max(enter(0, i), enter(1, i)), hn::Max(enter(2, i), hn::Zero(d)));
    };
    const auto far_at = [&](std::size_t i) HWY_ATTR {
        return hn::Min(hn::Min(leave(0, i), leave(1, i)), hn::Min(leave(2, i), hn::Set(d, limit)));
    };
    walk.size += put_met_children(node, walk.order, near_at, far_at, walk.stack + walk.size);
}

/// Moves the ray to the next child that waits for it; false when there is none.
HWY_INLINE bool take_waiting(Walk& walk) {
    if (walk.size == 0)
        return false;
    walk.next = walk.stack[--walk.size];
    return true;
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
