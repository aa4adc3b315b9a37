// SPDX-License-Identifier: Apache-2.0
// Rays of a packet that go different ways down a tree of boxes: see tree_search.cpp. Compiled once
// for each instruction set.

#if defined(VERA_ACCEL_TREE_WALKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_TREE_WALKS_INL_H
#undef VERA_ACCEL_TREE_WALKS_INL_H
#else
#define VERA_ACCEL_TREE_WALKS_INL_H
#endif

#include "vera/accel/packet_query.h"
#include "vera/accel/tree_blocks-inl.h"
#include "vera/accel/tree_lanes-inl.h"
#include "vera/accel/tree_streams-inl.h"
#include "vera/accel/tree_structures.h"

#include <array>
#include <bit>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A packet's rays of one octant on their way.
struct OctantStream {
    std::size_t octant = 0;
    StreamStack stack;
};

/// What waits for the packet's rays; several streams may be of one octant.
struct PacketStreams {
    std::array<OctantStream, octant_count> all;
    std::size_t count = 0;
};

/// So few rays are tested against a block's elements one by one.
constexpr int few_at_block = 6;

/// Lets the children of the node wait that the rays, which are all of the octant, meet before their
/// limits.
HWY_INLINE void put_met_children(
    const PacketQuery& query,
    const Frame& frame,
    const BoxRays& rays,
    const WideNode& node,
    std::size_t octant,
    LaneMask lanes,
    StreamStack& stack) {
    static_assert(sizeof(FloatRow) == packet_size * sizeof(float));
    const auto ray_at = [&](std::size_t lane) {
        return BoxedRay<packet_size>{
            rays.inverse[0].data() + lane,
            rays.near_offset[0].data() + lane,
            rays.far_offset[0].data() + lane,
            frame.limit[lane]};
    };
    put_waiting(
        node,
        rays_of_children<packet_size>(node, plane_places[octant], lanes, ray_at),
        order_of(query, octant),
        stack);
}

/// Follows the streams, a step each in turn, so that what each needs next arrives while the others
/// work.
inline void
search_streams(PacketQuery& query, Frame& frame, const BoxRays& rays, PacketStreams& streams) {
    const GeometryTree& tree = tree_of(frame);
    std::uint32_t under_way = (std::uint32_t{1} << streams.count) - 1;
    while (under_way != 0) {
        for (std::uint32_t those = under_way; those != 0; those &= those - 1) {
            OctantStream& stream = streams.all[static_cast<std::size_t>(std::countr_zero(those))];
            TreeChild child;
            const auto lanes = static_cast<LaneMask>(stream.stack.take(query.active, child));
            if (lanes == 0) {
                under_way &= ~(those & -those);
                continue;
            }
            if (child.is_block() == 0) {
                query.counts.cells += static_cast<std::uint64_t>(std::popcount(lanes));
                put_met_children(
                    query,
                    frame,
                    rays,
                    tree.nodes[child.first()],
                    stream.octant,
                    lanes,
                    stream.stack);
            } else if (std::popcount(lanes) > few_at_block) {
                visit_block(query, frame, child, lanes);
            } else {
                for (LaneMask rest = lanes; rest != 0; rest &= rest - 1)
                    visit_block_alone(
                        query, frame, child, static_cast<std::size_t>(std::countr_zero(rest)));
            }
            if (stream.stack.size > 0)
                fetch(tree, stream.stack.children[stream.stack.size - 1]);
        }
    }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
