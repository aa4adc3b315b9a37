// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_query.h"
#include "vera/accel/tree_structures.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/tree_search.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/tree_blocks-inl.h"
#include "vera/accel/tree_lanes-inl.h"
#include "vera/accel/tree_walks-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What holds all rays of a packet: none comes to a plane earlier than the earlier of two lines in
/// the plane's place does, nor later than the later of two others.
struct Beam {
    float inverse[3][2];
    float near_offset[3][2];
    float far_offset[3][2];
};

/// Of the lanes' rays, which are all of the octant.
HWY_INLINE Beam beam_of(const Frame& frame, std::size_t octant, LaneMask lanes) {
    const Lanes d;
    Beam beam;
    const float inward = frame.box_slack;
    const auto largest = hn::Set(d, std::numeric_limits<float>::max());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        auto least_inverse = largest;
        auto most_inverse = hn::Neg(largest);
        auto least_origin = largest;
        auto most_origin = hn::Neg(largest);
        for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
            const auto counts = in_lanes(d, lanes, i);
            const auto inverse = hn::LoadU(d, frame.inverse[axis].data() + i);
            const auto origin = hn::LoadU(d, frame.origin[axis].data() + i);
            least_inverse = hn::Min(least_inverse, hn::IfThenElse(counts, inverse, least_inverse));
            most_inverse = hn::Max(most_inverse, hn::IfThenElse(counts, inverse, most_inverse));
            least_origin = hn::Min(least_origin, hn::IfThenElse(counts, origin, least_origin));
            most_origin = hn::Max(most_origin, hn::IfThenElse(counts, origin, most_origin));
        }
        beam.inverse[axis][0] = hn::GetLane(hn::MinOfLanes(d, least_inverse));
        beam.inverse[axis][1] = hn::GetLane(hn::MaxOfLanes(d, most_inverse));
        const float least = hn::GetLane(hn::MinOfLanes(d, least_origin));
        const float most = hn::GetLane(hn::MaxOfLanes(d, most_origin));
        const bool backward = (octant >> axis & 1U) != 0;
        const float first = backward ? least - inward : most + inward;
        const float last = backward ? most + inward : least - inward;
        for (std::size_t i = 0; i < 2; ++i) {
            beam.near_offset[axis][i] = -first * beam.inverse[axis][i];
            beam.far_offset[axis][i] = -last * beam.inverse[axis][i];
        }
    }
    return beam;
}

/// The largest limit of the lanes.
HWY_INLINE float largest_limit(const Frame& frame, LaneMask lanes) {
    const Lanes d;
    auto largest = hn::Set(d, static_cast<float>(-farthest));
    for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d))
        largest = hn::Max(
            largest,
            hn::IfThenElse(in_lanes(d, lanes, i), hn::LoadU(d, frame.limit.data() + i), largest));
    return hn::GetLane(hn::MaxOfLanes(d, largest));
}

/// The children of the node whose boxes the beam meets before the limit, and where it enters them.
HWY_INLINE std::uint32_t children_in_beam(
    const WideNode& node,
    const Beam& beam,
    std::size_t octant,
    float limit,
    std::array<float, tree_width>& nears) {
    const Children d;
    const float* const planes = node.planes[0].data();
    const auto& places = plane_places[octant];
    const auto line = [&](std::size_t place, float inverse, float offset) HWY_ATTR {
        return hn::MulAdd(hn::Load(d, planes + place), hn::Set(d, inverse), hn::Set(d, offset));
    };
    std::uint32_t met = 0;
    for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d)) {
        auto near = hn::Zero(d); // stays the second of two zeros, which counts: +0
        auto far = hn::Set(d, limit);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t first = places[axis] + i;
            const std::size_t last = places[3 + axis] + i;
            near = hn::Max(
                hn::Min(
                    line(first, beam.inverse[axis][0], beam.near_offset[axis][0]),
                    line(first, beam.inverse[axis][1], beam.near_offset[axis][1])),
                near);
            far = hn::Min(
                far,
                hn::Max(
                    line(last, beam.inverse[axis][0], beam.far_offset[axis][0]),
                    line(last, beam.inverse[axis][1], beam.far_offset[axis][1])));
        }
        hn::StoreU(near, d, nears.data() + i);
        met |= bits_of(d, hn::Le(near, far)) << i;
    }
    return met;
}

/// The lanes that meet the box of a node's child before their limits. All rays are of the octant.
HWY_INLINE LaneMask meeting_child(
    const WideNode& node,
    std::size_t child,
    const BoxRays& rays,
    std::size_t octant,
    const Frame::Row& limit,
    LaneMask lanes) {
    const Lanes d;
    const float* const planes = node.planes[0].data() + child;
    const auto& places = plane_places[octant];
    LaneMask met = 0;
    for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
        if (!any_from(d, lanes, i))
            continue;
        auto near = hn::Zero(d);
        auto far = hn::LoadU(d, limit.data() + i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto inverse = hn::LoadU(d, rays.inverse[axis].data() + i);
            near = hn::Max(
                near,
                hn::MulAdd(
                    hn::Set(d, planes[places[axis]]),
                    inverse,
                    hn::LoadU(d, rays.near_offset[axis].data() + i)));
            far = hn::Min(
                far,
                hn::MulAdd(
                    hn::Set(d, planes[places[3 + axis]]),
                    inverse,
                    hn::LoadU(d, rays.far_offset[axis].data() + i)));
        }
        met |= bits_of(d, hn::Le(near, far)) << i;
    }
    return met & lanes;
}

/// Lets the children of the node wait that the lanes' rays meet, the nearest on top. Returns how
/// many.
HWY_INLINE std::size_t put_children(
    const GeometryTree& tree,
    const WideNode& node,
    const Frame& frame,
    const BoxRays& rays,
    const Beam& beam,
    std::size_t octant,
    float limit,
    LaneMask lanes,
    WaitingTogether* stack) {
    alignas(64) std::array<float, tree_width> nears;
    std::uint32_t met = children_in_beam(node, beam, octant, limit, nears);
    std::size_t size = 0;
    for (; met != 0; met &= met - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(met));
        const LaneMask meeting = meeting_child(node, i, rays, octant, frame.limit, lanes);
        if (meeting == 0)
            continue;
        fetch(tree, node.children[i]);
        std::size_t place = size++;
        for (; place > 0 && stack[place - 1].near < nears[i]; --place)
            stack[place] = stack[place - 1];
        stack[place] = {node.children[i], meeting, nears[i]};
    }
    return size;
}

/// The lanes whose limits are not before a local distance.
HWY_INLINE LaneMask reaching(const Frame& frame, float near) {
    const Lanes d;
    LaneMask lanes = 0;
    for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d))
        lanes |= bits_of(d, hn::Ge(hn::LoadU(d, frame.limit.data() + i), hn::Set(d, near))) << i;
    return lanes;
}

/// So few rays of a packet go on as a stream from where they are.
constexpr int few_lanes = 2;

/// Follows a packet of rays of one octant down from the root. Where few of them are left, what
/// waits for them is left to the streams.
void search_together(
    PacketQuery& query,
    Frame& frame,
    const BoxRays& rays,
    LaneMask lanes,
    std::size_t octant,
    PacketStreams& streams) {
    const GeometryTree& tree = tree_of(frame);
    Beam beam = beam_of(frame, octant, lanes);
    float limit = largest_limit(frame, lanes);
    WaitingTogether* const stack = frame.waiting_together.data();
    std::size_t size = 0;
    std::size_t turn = 0;
    const auto leave = [&](TreeChild child, LaneMask for_lanes) {
        StreamStack& later = streams.all[turn % octant_count].stack;
        if (later.size == tree_width)
            return false;
        later.push(child, for_lanes);
        ++turn;
        return true;
    };
    TreeChild child = TreeChild::node(0);
    LaneMask child_lanes = lanes;
    while (true) {
        if (child.is_block() != 0) {
            visit_block(query, frame, child, child_lanes);
            if ((lanes & ~query.active) != 0) {
                lanes &= query.active;
                if (lanes == 0)
                    break;
                beam = beam_of(frame, octant, lanes);
            }
            limit = largest_limit(frame, lanes);
        } else if (std::popcount(child_lanes) > few_lanes || !leave(child, child_lanes)) {
            query.counts.cells += static_cast<std::uint64_t>(std::popcount(child_lanes));
            const std::size_t count = put_children(
                tree,
                tree.nodes[child.first()],
                frame,
                rays,
                beam,
                octant,
                limit,
                child_lanes,
                stack + size);
            if (count > 0) {
                size += count - 1;
                child = stack[size].child;
                child_lanes = stack[size].lanes;
                continue;
            }
        }
        do {
            if (size == 0) {
                lanes = 0;
                break;
            }
            --size;
            child = stack[size].child;
            child_lanes = stack[size].lanes & lanes & reaching(frame, stack[size].near);
        } while (child_lanes == 0);
        if (lanes == 0)
            break;
    }
    for (OctantStream& stream : streams.all) {
        // The first that was left is to be the next.
        std::reverse(stream.stack.children, stream.stack.children + stream.stack.size);
        std::reverse(stream.stack.rays, stream.stack.rays + stream.stack.size);
    }
}

/// The lanes of the octant.
HWY_INLINE LaneMask lanes_of(const BoxRays& rays, std::size_t octant, LaneMask lanes) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        lanes &= (octant >> axis & 1U) != 0 ? rays.backward[axis] : ~rays.backward[axis];
    return lanes;
}

void search_tree(PacketQuery& query, Frame& frame, LaneMask lanes) {
    lanes &= query.active;
    frame.candidates.count = 0;
    const std::size_t depth = waiting_depth(tree_of(frame).levels);
    if (frame.waiting_together.size() < depth) {
        frame.waiting.resize(octant_count * depth);
        frame.waiting_lanes.resize(octant_count * depth);
        frame.waiting_together.resize(depth);
    }
    BoxRays rays;
    fill_box_rays(frame, rays);
    PacketStreams streams;
    for (std::size_t i = 0; i < octant_count; ++i)
        streams.all[i].stack = {
            frame.waiting.data() + i * depth, frame.waiting_lanes.data() + i * depth, 0};
    if (std::popcount(lanes) > few_lanes && one_octant(rays, lanes)) {
        const std::size_t octant =
            octant_of(rays, static_cast<std::size_t>(std::countr_zero(lanes)));
        for (OctantStream& stream : streams.all)
            stream.octant = octant;
        streams.count = octant_count;
        search_together(query, frame, rays, lanes, octant, streams);
    } else {
        for (std::size_t octant = 0; octant < octant_count; ++octant)
            if (const LaneMask of_octant = lanes_of(rays, octant, lanes); of_octant != 0) {
                OctantStream& stream = streams.all[streams.count++];
                stream.octant = octant;
                stream.stack.push(TreeChild::node(0), of_octant);
            }
    }
    search_streams(query, frame, rays, streams);
    if (frame.depth > 0)
        return decide(query, frame, lanes);
    // What the main scene's candidates are arrives while the next packet is searched.
    fetch_candidates(frame);
}

void search_trees_kernel(PacketQuery& query) {
    query.local_start = LocalStart::near_bounds;
    const LaneMask lanes = enter_scene(query);
    if (lanes != 0)
        search_tree(query, query.frames.front(), lanes);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(search_trees_kernel);

void search_trees(PacketQuery& query) {
    HWY_DYNAMIC_DISPATCH(search_trees_kernel)(query);
}

} // namespace vera::detail

#endif
