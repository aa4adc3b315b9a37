// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_query.h"
#include "vera/accel/tree_structures.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/tree_search.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/element_tests-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Rays of a packet, as many as fit into a register.
using Lanes = hn::CappedTag<float, packet_size>;
/// Children of a node that a ray is tested against together.
using Children = hn::CappedTag<float, tree_width>;
/// Elements of a block that a ray is tested against together.
using Elements = hn::CappedTag<float, block_width>;

template <typename D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    const std::uint32_t all = bytes[0] | std::uint32_t{bytes[1]} << 8U;
    return all & ((std::uint32_t{1} << hn::Lanes(d)) - 1);
}

inline const GeometryTree& tree_of(const Frame& frame) {
    return static_cast<const GeometryTree&>(*frame.local);
}

/// A child of a node that waits for its turn. What it is stands in the node.
inline TreeChild child_of(const WideNode& node, std::size_t i) {
    return {node.first[i], node.kind[i], node.count[i]};
}

void search_tree(PacketQuery& query, Frame& frame, LaneMask lanes);

void visit_call(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes) {
    if (too_deep(frame))
        return search_plainly(query, frame, element, lanes);
    const LaneMask entering = enter_call(query, frame, element, lanes);
    if (entering == 0)
        return;
    search_tree(query, query.frames[frame.depth + std::size_t{1}], entering);
    refresh_limits(query, frame, lanes);
}

void visit_element(
    PacketQuery& query,
    Frame& frame,
    ElementRecord::Kind kind,
    std::uint32_t element,
    LaneMask lanes) {
    if (kind == ElementRecord::Kind::call)
        visit_call(query, frame, element, lanes);
    else
        test_exactly(query, frame, element, lanes);
}

inline ElementRecord::Kind element_kind(const TreeChild& child) {
    return static_cast<ElementRecord::Kind>(child.kind - ChildKind::first_block);
}

/// A ray as boxes are tested against it. The slack is in the offsets: it moves the planes of a box
/// outward.
struct BoxRay {
    float inverse[3];
    float near_offset[3];
    float far_offset[3];
    bool backward[3];
};

inline BoxRay box_ray(const Frame& frame, std::size_t lane) {
    BoxRay ray;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float inverse = frame.inverse[axis][lane];
        const float origin = frame.origin[axis][lane];
        const bool backward = inverse < 0;
        const float outward = backward ? -2 * frame.slack : 2 * frame.slack;
        ray.inverse[axis] = inverse;
        ray.near_offset[axis] = -(origin + outward) * inverse;
        ray.far_offset[axis] = -(origin - outward) * inverse;
        ray.backward[axis] = backward;
    }
    return ray;
}

/// The children of the node whose boxes the ray meets before the limit, and where it enters them.
HWY_INLINE std::uint32_t
met_children(const WideNode& node, const BoxRay& ray, float limit, float* near_row) {
    const Children d;
    std::uint32_t met = 0;
    for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d)) {
        auto near = hn::Zero(d);
        auto far = hn::Set(d, limit);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& first = (ray.backward[axis] ? node.upper : node.lower)[axis];
            const auto& last = (ray.backward[axis] ? node.lower : node.upper)[axis];
            const auto inverse = hn::Set(d, ray.inverse[axis]);
            near = hn::Max(
                near,
                hn::MulAdd(
                    hn::Load(d, first.data() + i), inverse, hn::Set(d, ray.near_offset[axis])));
            far = hn::Min(
                far,
                hn::MulAdd(
                    hn::Load(d, last.data() + i), inverse, hn::Set(d, ray.far_offset[axis])));
        }
        hn::StoreU(near, d, near_row + i);
        met |= bits_of(d, hn::Le(near, far)) << i;
    }
    return met;
}

inline std::uint32_t
element_number(const GeometryTree& tree, const TreeChild& child, std::size_t i) {
    return std::bit_cast<std::uint32_t>(tree.rows[child.first][i]);
}

/// The elements of a block of which a test says yes for one ray.
template <typename Test>
std::uint32_t test_elements(
    const GeometryTree& tree,
    const TreeChild& child,
    const Frame& frame,
    std::size_t lane,
    const Test& test) {
    const Elements d;
    const ElementRecord::Kind kind = element_kind(child);
    const TestedRays<Elements> rays = {
        {hn::Set(d, frame.origin[0][lane]),
         hn::Set(d, frame.origin[1][lane]),
         hn::Set(d, frame.origin[2][lane])},
        {hn::Set(d, frame.direction[0][lane]),
         hn::Set(d, frame.direction[1][lane]),
         hn::Set(d, frame.direction[2][lane])},
        {hn::Set(d, frame.inverse[0][lane]),
         hn::Set(d, frame.inverse[1][lane]),
         hn::Set(d, frame.inverse[2][lane])},
        hn::Set(d, frame.limit[lane]),
        frame.slack};
    const BlockRow* rows = tree.rows.data() + child.first + 1;
    const std::size_t count = value_count(kind);
    std::uint32_t met = 0;
    for (std::size_t i = 0; i < block_width; i += hn::Lanes(d)) {
        hn::Vec<Elements> values[11];
        for (std::size_t value = 0; value < 11; ++value)
            values[value] = value < count ? hn::LoadU(d, rows[value].data() + i) : hn::Zero(d);
        met |= bits_of(d, test(d, rays, kind, values)) << i;
    }
    return met & ((std::uint32_t{1} << child.count) - 1);
}

void visit_block_alone(PacketQuery& query, Frame& frame, const TreeChild& child, std::size_t lane) {
    const GeometryTree& tree = tree_of(frame);
    const ElementRecord::Kind kind = element_kind(child);
    const LaneMask lanes = LaneMask{1} << lane;
    if (kind != ElementRecord::Kind::call)
        query.counts.tests += child.count;
    std::uint32_t met = test_elements(tree, child, frame, lane, MayMeet());
    if (met == 0)
        return;
    std::uint32_t starts = 0;
    for (std::size_t i = 0; i < child.count; ++i)
        if (element_number(tree, child, i) == frame.start_element[lane])
            starts |= std::uint32_t{1} << i;
    if ((met & starts) != 0)
        met &= ~(starts & test_elements(tree, child, frame, lane, SurelyLeaves()));
    const std::uint32_t doubtful = met & ~starts;
    if (query.purpose == Purpose::any && doubtful != 0
        && (doubtful & test_elements(tree, child, frame, lane, SurelyMeets())) != 0)
        return block(query, frame, lanes);
    for (; met != 0; met &= met - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(met));
        visit_element(query, frame, kind, element_number(tree, child, i), lanes);
        if ((query.active & lanes) == 0)
            return;
    }
}

/// The nearest of the children that a ray meets. The others wait, the nearest on top.
HWY_INLINE TreeChild nearest_child(
    const WideNode& node, std::uint32_t met, const float* near, std::vector<WaitingAlone>& stack) {
    auto i = static_cast<std::size_t>(std::countr_zero(met));
    met &= met - 1;
    if (met == 0)
        return child_of(node, i);
    const std::size_t first = stack.size();
    while (true) {
        std::size_t place = stack.size();
        stack.push_back({child_of(node, i), near[i]});
        for (; place > first && stack[place - 1].near < near[i]; --place)
            stack[place] = stack[place - 1];
        stack[place] = {child_of(node, i), near[i]};
        if (met == 0)
            break;
        i = static_cast<std::size_t>(std::countr_zero(met));
        met &= met - 1;
    }
    const TreeChild nearest = stack.back().child;
    stack.pop_back();
    return nearest;
}

/// Follows one ray down from a node, or a block: the nearest boxes first.
void search_alone(PacketQuery& query, Frame& frame, std::size_t lane, const TreeChild& from) {
    const GeometryTree& tree = tree_of(frame);
    const BoxRay ray = box_ray(frame, lane);
    std::vector<WaitingAlone>& stack = query.waiting_alone;
    const std::size_t bottom = stack.size();
    TreeChild next = from;
    while (true) {
        if (next.kind == ChildKind::node) {
            ++query.counts.cells;
            const WideNode& node = tree.nodes[next.first];
            alignas(64) float near[tree_width];
            const std::uint32_t met = met_children(node, ray, frame.limit[lane], near);
            if (met != 0) {
                next = nearest_child(node, met, near, stack);
                continue;
            }
        } else {
            visit_block_alone(query, frame, next, lane);
            if ((query.active >> lane & 1U) == 0)
                break;
        }
        while (stack.size() > bottom && !(stack.back().near <= frame.limit[lane]))
            stack.pop_back();
        if (stack.size() == bottom)
            return;
        next = stack.back().child;
        stack.pop_back();
    }
    stack.resize(bottom);
}

/// A packet's rays as boxes are tested against them.
struct BoxRays {
    Frame::Row inverse[3];
    Frame::Row near_offset[3];
    Frame::Row far_offset[3];
    bool backward[3] = {};
    bool one_octant = true; ///< all rays run backward along the same axes
};

HWY_INLINE void fill_box_rays(const Frame& frame, LaneMask lanes, BoxRays& rays) {
    const Lanes d;
    const auto slack = hn::Set(d, 2 * frame.slack);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
            const auto inverse = hn::LoadU(d, frame.inverse[axis].data() + i);
            const auto origin = hn::LoadU(d, frame.origin[axis].data() + i);
            const auto outward = hn::CopySign(slack, inverse);
            hn::StoreU(inverse, d, rays.inverse[axis].data() + i);
            hn::StoreU(
                hn::Neg(hn::Mul(hn::Add(origin, outward), inverse)),
                d,
                rays.near_offset[axis].data() + i);
            hn::StoreU(
                hn::Neg(hn::Mul(hn::Sub(origin, outward), inverse)),
                d,
                rays.far_offset[axis].data() + i);
        }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        LaneMask backward = 0;
        for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d))
            backward |=
                bits_of(d, hn::Lt(hn::LoadU(d, frame.inverse[axis].data() + i), hn::Zero(d))) << i;
        rays.backward[axis] = (backward & lanes) != 0;
        rays.one_octant = rays.one_octant && ((backward & lanes) == 0 || (~backward & lanes) == 0);
    }
}

/// The lanes that meet the box of a node's child before their limits, and where they enter it.
template <bool OneOctant>
HWY_INLINE LaneMask meeting_child(
    const WideNode& node,
    std::size_t child,
    const BoxRays& rays,
    const Frame::Row& limit,
    Frame::Row& near_row) {
    const Lanes d;
    LaneMask met = 0;
    for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
        auto near = hn::Zero(d);
        auto far = hn::LoadU(d, limit.data() + i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto inverse = hn::LoadU(d, rays.inverse[axis].data() + i);
            const bool turned = OneOctant && rays.backward[axis];
            auto first = hn::Set(d, (turned ? node.upper : node.lower)[axis][child]);
            auto last = hn::Set(d, (turned ? node.lower : node.upper)[axis][child]);
            if constexpr (!OneOctant) {
                const auto backward = hn::Lt(inverse, hn::Zero(d));
                const auto lower = first;
                first = hn::IfThenElse(backward, last, lower);
                last = hn::IfThenElse(backward, lower, last);
            }
            near = hn::Max(
                near, hn::MulAdd(first, inverse, hn::LoadU(d, rays.near_offset[axis].data() + i)));
            far = hn::Min(
                far, hn::MulAdd(last, inverse, hn::LoadU(d, rays.far_offset[axis].data() + i)));
        }
        hn::StoreU(near, d, near_row.data() + i);
        met |= bits_of(d, hn::Le(near, far)) << i;
    }
    return met;
}

/// The lanes of a packet for which a test says yes of element i of a block.
template <typename Test>
LaneMask test_lanes(
    const GeometryTree& tree,
    const TreeChild& child,
    std::size_t i,
    const Frame& frame,
    const Test& test) {
    const Lanes d;
    const ElementRecord::Kind kind = element_kind(child);
    const BlockRow* rows = tree.rows.data() + child.first + 1;
    const std::size_t count = value_count(kind);
    hn::Vec<Lanes> values[11];
    for (std::size_t value = 0; value < 11; ++value)
        values[value] = hn::Set(d, value < count ? rows[value][i] : 0);
    LaneMask met = 0;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
        const TestedRays<Lanes> rays = {
            {hn::LoadU(d, frame.origin[0].data() + lane),
             hn::LoadU(d, frame.origin[1].data() + lane),
             hn::LoadU(d, frame.origin[2].data() + lane)},
            {hn::LoadU(d, frame.direction[0].data() + lane),
             hn::LoadU(d, frame.direction[1].data() + lane),
             hn::LoadU(d, frame.direction[2].data() + lane)},
            {hn::LoadU(d, frame.inverse[0].data() + lane),
             hn::LoadU(d, frame.inverse[1].data() + lane),
             hn::LoadU(d, frame.inverse[2].data() + lane)},
            hn::LoadU(d, frame.limit.data() + lane),
            frame.slack};
        met |= bits_of(d, test(d, rays, kind, values)) << lane;
    }
    return met;
}

/// The lanes whose rays start on the element.
HWY_INLINE LaneMask starting_on(const Frame& frame, std::uint32_t element) {
    const hn::RebindToUnsigned<Lanes> d;
    LaneMask starting = 0;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d))
        starting |=
            bits_of(d, hn::Eq(hn::LoadU(d, frame.start_element.data() + lane), hn::Set(d, element)))
            << lane;
    return starting;
}

void visit_block(PacketQuery& query, Frame& frame, const TreeChild& child, LaneMask lanes) {
    const GeometryTree& tree = tree_of(frame);
    const ElementRecord::Kind kind = element_kind(child);
    for (std::size_t i = 0; i < child.count; ++i) {
        if (kind != ElementRecord::Kind::call)
            query.counts.tests += static_cast<std::uint64_t>(std::popcount(lanes));
        LaneMask met = lanes & test_lanes(tree, child, i, frame, MayMeet());
        if (met == 0)
            continue;
        const std::uint32_t element = element_number(tree, child, i);
        const LaneMask starting = starting_on(frame, element);
        if ((met & starting) != 0)
            met &= ~(starting & test_lanes(tree, child, i, frame, SurelyLeaves()));
        const LaneMask doubtful = met & ~starting;
        if (query.purpose == Purpose::any && doubtful != 0) {
            const LaneMask blocked = doubtful & test_lanes(tree, child, i, frame, SurelyMeets());
            block(query, frame, blocked);
            met &= ~blocked;
        }
        if (met != 0)
            visit_element(query, frame, kind, element, met);
        lanes &= query.active;
        if (lanes == 0)
            return;
    }
}

/// A child that some lanes of a packet meet, and where the first of them enters it.
struct MetByPacket {
    std::size_t child = 0;
    LaneMask lanes = 0;
    float near = 0;
};

/// Lets the children wait that some of the lanes meet, the nearest on top.
HWY_INLINE void add_met_children(
    const WideNode& node,
    const BoxRays& rays,
    const Frame& frame,
    LaneMask lanes,
    std::vector<WaitingTogether>& stack) {
    const auto guide = static_cast<std::size_t>(std::countr_zero(lanes));
    alignas(64) Frame::Row near[tree_width];
    MetByPacket met[tree_width];
    std::size_t count = 0;
    for (std::size_t i = 0; i < tree_width && node.kind[i] != ChildKind::none; ++i) {
        MetByPacket child;
        child.child = i;
        child.lanes = lanes
            & (rays.one_octant ? meeting_child<true>(node, i, rays, frame.limit, near[i])
                               : meeting_child<false>(node, i, rays, frame.limit, near[i]));
        if (child.lanes == 0)
            continue;
        child.near = near[i][guide];
        std::size_t place = count++;
        for (; place > 0 && met[place - 1].near < child.near; --place)
            met[place] = met[place - 1];
        met[place] = child;
    }
    for (std::size_t i = 0; i < count; ++i)
        stack.push_back({child_of(node, met[i].child), met[i].lanes, near[met[i].child]});
}

/// Takes the next child off the stack that lanes enter before their limits; returns these lanes,
/// none when no child is left above the bottom.
HWY_INLINE LaneMask
take_waiting(PacketQuery& query, const Frame& frame, std::size_t bottom, TreeChild& next) {
    const Lanes d;
    std::vector<WaitingTogether>& stack = query.waiting_together;
    LaneMask lanes = 0;
    while (lanes == 0 && stack.size() > bottom) {
        const WaitingTogether& waiting = stack.back();
        LaneMask before_limit = 0;
        for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d))
            before_limit |= bits_of(
                                d,
                                hn::Le(
                                    hn::LoadU(d, waiting.near.data() + i),
                                    hn::LoadU(d, frame.limit.data() + i)))
                << i;
        lanes = waiting.lanes & before_limit & query.active;
        next = waiting.child;
        stack.pop_back();
    }
    return lanes;
}

/// Follows a packet down from the root. Where few of its rays are left, each goes on alone.
void search_together(PacketQuery& query, Frame& frame, LaneMask lanes) {
    const GeometryTree& tree = tree_of(frame);
    BoxRays rays;
    fill_box_rays(frame, lanes, rays);
    const std::size_t bottom = query.waiting_together.size();
    TreeChild next = {0, ChildKind::node, 0};
    while (lanes != 0) {
        if (std::popcount(lanes) <= few_lanes) {
            for (LaneMask rest = lanes; rest != 0; rest &= rest - 1)
                search_alone(query, frame, static_cast<std::size_t>(std::countr_zero(rest)), next);
        } else if (next.kind == ChildKind::node) {
            query.counts.cells += static_cast<std::uint64_t>(std::popcount(lanes));
            add_met_children(tree.nodes[next.first], rays, frame, lanes, query.waiting_together);
        } else {
            visit_block(query, frame, next, lanes);
        }
        lanes = take_waiting(query, frame, bottom, next);
    }
}

void search_tree(PacketQuery& query, Frame& frame, LaneMask lanes) {
    lanes &= query.active;
    const TreeChild root = {0, ChildKind::node, 0};
    if (std::popcount(lanes) > few_lanes)
        return search_together(query, frame, lanes);
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1)
        search_alone(query, frame, static_cast<std::size_t>(std::countr_zero(rest)), root);
}

void search_trees_kernel(PacketQuery& query) {
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
