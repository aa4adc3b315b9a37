// SPDX-License-Identifier: Apache-2.0
// Groups of rays that go through the tree of a mesh together: see mesh_search.cpp. Compiled once
// for each instruction set.

#if defined(VERA_ACCEL_MESH_BEAMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_MESH_BEAMS_INL_H
#undef VERA_ACCEL_MESH_BEAMS_INL_H
#else
#define VERA_ACCEL_MESH_BEAMS_INL_H
#endif

#include "vera/accel/mesh_rays-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// From the least to the most of the lanes' numbers.
struct Extent {
    float least = 0;
    float most = 0;
};

HWY_INLINE Extent extent_of(const GroupRow<float>& row, GroupMask lanes) {
    const Rays d;
    const auto first = hn::Set(d, row[static_cast<std::size_t>(std::countr_zero(lanes))]);
    auto least = first;
    auto most = first;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const auto values =
            hn::IfThenElse(in_group(d, lanes, i), hn::Load(d, row.data() + i), first);
        least = hn::Min(least, values);
        most = hn::Max(most, values);
    }
    return {hn::GetLane(hn::MinOfLanes(d, least)), hn::GetLane(hn::MaxOfLanes(d, most))};
}

/// The largest limit of the rays as a BeamWalk measures it.
HWY_INLINE float largest_limit(const RayGroup& group) {
    const Rays d;
    auto limit = hn::Set(d, -1);
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
        limit = hn::Max(
            limit,
            hn::Mul(hn::Load(d, group.limit.data() + i), hn::Load(d, group.largest.data() + i)));
    return hn::GetLane(hn::MaxOfLanes(d, limit)) * (1 + 0x1p-20F);
}

/// A child that waits until rays of a group come to it: which of them, and the way along the axis
/// before which none enters its box.
struct WaitingGroup {
    TreeChild child;
    GroupMask lanes = 0;
    float near = 0;
};

/// A group of rays of one octant that goes through the tree as one: none of its rays comes to a
/// plane earlier than the earlier of two lines in the plane's place does, nor later than the later
/// of two others. It takes the rays' directions divided by their largest coordinates, so that t is
/// the way along that axis, and rays of different lengths are alike.
struct alignas(64) BeamWalk {
    float inverse[3][2];
    float near_offset[3][2];
    float far_offset[3][2];
    float origin[3]; ///< where there is one
    float direction_middle[3];
    float direction_half[3];  ///< what the directions differ from the middle
    float direction_size = 0; ///< at least the rays' and the sum of middle and half: see RayGroup
    float limit = 0;          ///< the largest of the rays
    bool one_origin = false;
    bool narrow = false;                ///< so that boxes that the beam meets are met by rays
    std::array<std::uint8_t, 6> places; ///< see plane_places
    std::uint8_t order = 0;             ///< see put_met_children
    std::uint32_t size = 0;             ///< of the stack
    TreeChild* stack = nullptr;         ///< what waits; the next one is on top
    TreeChild next;                     ///< where the group is
    RayGroup* group = nullptr;
    std::uint32_t steps = 0; ///< that it has taken
};

/// Whether the lanes' rays all start at one place.
HWY_INLINE bool from_one_origin(const RayGroup& group, GroupMask lanes) {
    const Rays d;
    const auto first = static_cast<std::size_t>(std::countr_zero(lanes));
    GroupMask same = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        auto equal =
            hn::Eq(hn::Load(d, group.origin[0].data() + i), hn::Set(d, group.origin[0][first]));
        for (std::size_t axis = 1; axis < 3; ++axis)
            equal = hn::And(
                equal,
                hn::Eq(
                    hn::Load(d, group.origin[axis].data() + i),
                    hn::Set(d, group.origin[axis][first])));
        same |= bits_of(d, equal) << i;
    }
    return (lanes & ~same) == 0;
}

/// Rays that end at one place, of which is only asked whether they meet anything, as well start
/// there: turns them round. They may miss the place by what is rounded.
HWY_INLINE bool turn_round(RayGroup& group) {
    constexpr float most_blur = 0x1p-20F;
    const Rays d;
    // Rays without an end have coordinates there that are no numbers.
    constexpr float farthest_end = 0x1p20F;
    if (!(extent_of(group.t_max, group.followed).most < farthest_end))
        return false;
    const auto first = static_cast<std::size_t>(std::countr_zero(group.followed));
    float end[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        end[axis] = group.origin[axis][first] + group.t_max[first] * group.direction[axis][first];
    auto away = hn::Zero(d);
    auto size = hn::Zero(d);
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const auto counts = in_group(d, group.followed, i);
        const auto t_max = hn::Load(d, group.t_max.data() + i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto way = hn::Mul(t_max, hn::Load(d, group.direction[axis].data() + i));
            const auto at_end = hn::Add(hn::Load(d, group.origin[axis].data() + i), way);
            const auto off = hn::Abs(hn::Sub(at_end, hn::Set(d, end[axis])));
            away = hn::Max(away, hn::IfThenElseZero(counts, off));
            size = hn::Max(size, hn::IfThenElseZero(counts, hn::Abs(way)));
        }
    }
    // What is computed here is rounded as well.
    const float blur = hn::GetLane(hn::MaxOfLanes(d, away))
        + 0x1p-22F * (hn::GetLane(hn::MaxOfLanes(d, size)) + 1);
    if (!(blur <= most_blur))
        return false;
    group.blur = blur;
    group.slack += 2 * blur;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            hn::Store(hn::Load(d, group.origin[axis].data() + i), d, group.start[axis].data() + i);
            hn::Store(hn::Set(d, end[axis]), d, group.origin[axis].data() + i);
            for (GroupRow<float>* row : {&group.direction[axis], &group.inverse[axis]})
                hn::Store(hn::Neg(hn::Load(d, row->data() + i)), d, row->data() + i);
        }
        const auto t_max = hn::Load(d, group.t_max.data() + i);
        const auto t_min = hn::Load(d, group.t_min.data() + i);
        const auto counts = in_group(d, group.followed, i);
        // The difference is rounded, as the ends are blurred.
        hn::Store(
            hn::IfThenElse(counts, hn::Sub(t_max, t_min), hn::Set(d, -1)),
            d,
            group.limit.data() + i);
        hn::Store(t_min, d, group.start_t_min.data() + i);
        hn::Store(hn::Zero(d), d, group.t_min.data() + i);
    }
    return true;
}

/// 1 / direction, but never infinite.
inline float inverse_of(float direction, bool backward) {
    constexpr float least = 0x1p-60F;
    return 1 / (backward ? std::min(direction, -least) : std::max(direction, least));
}

/// Fills in the lines of an axis along which the beam runs backward or not.
HWY_INLINE void
set_lines(BeamWalk& beam, std::size_t axis, bool backward, Extent origin, Extent inverse) {
    const float slack = beam.group->slack;
    const float first = backward ? origin.least - slack : origin.most + slack;
    const float last = backward ? origin.most + slack : origin.least - slack;
    beam.inverse[axis][0] = inverse.least;
    beam.inverse[axis][1] = inverse.most;
    for (std::size_t i = 0; i < 2; ++i) {
        beam.near_offset[axis][i] = -first * beam.inverse[axis][i];
        beam.far_offset[axis][i] = -last * beam.inverse[axis][i];
    }
}

/// Sets the group's followed rays on their way together, from the root; false where they are of
/// several octants.
HWY_INLINE bool start_beam(RayGroup& group, bool any, TreeChild* stack, BeamWalk& beam) {
    constexpr float widest = 0.02F;
    constexpr float widest_any = 0.008F;
    const Rays d;
    const GroupMask lanes = group.followed;
    beam.group = &group;
    std::size_t octant = 0;
    beam.narrow = true;
    float size = 0;
    Extent inverse[3];
    GroupRow<float> per_largest;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
        hn::Store(
            hn::Div(hn::Set(d, 1), hn::Load(d, group.largest.data() + i)),
            d,
            per_largest.data() + i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        GroupRow<float> directions;
        for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
            hn::Store(
                hn::Mul(
                    hn::Load(d, group.direction[axis].data() + i),
                    hn::Load(d, per_largest.data() + i)),
                d,
                directions.data() + i);
        const Extent direction = extent_of(directions, lanes);
        const bool backward = direction.most < 0;
        if (!backward && direction.least < 0)
            return false;
        octant |= std::size_t{backward} << axis;
        const float half = 0.5F * (direction.most - direction.least);
        beam.narrow = beam.narrow && half < (any ? widest_any : widest);
        beam.direction_middle[axis] = 0.5F * (direction.most + direction.least);
        beam.direction_half[axis] = half + 0x1p-22F;
        size += std::abs(beam.direction_middle[axis]) + beam.direction_half[axis];
        inverse[axis] = {
            inverse_of(direction.most, backward), inverse_of(direction.least, backward)};
    }
    beam.direction_size = std::max(group.direction_size, size * (1 + 0x1p-20F));
    beam.one_origin = from_one_origin(group, lanes);
    if (!beam.one_origin && any && turn_round(group)) {
        beam.one_origin = true;
        octant ^= octant_count - 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            beam.direction_middle[axis] = -beam.direction_middle[axis];
            inverse[axis] = {-inverse[axis].most, -inverse[axis].least};
        }
    }
    beam.narrow = beam.narrow && beam.one_origin;
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        beam.origin[axis] = group.origin[axis][lane];
        const Extent origin = beam.one_origin ? Extent{beam.origin[axis], beam.origin[axis]}
                                              : extent_of(group.origin[axis], lanes);
        set_lines(beam, axis, (octant >> axis & 1U) != 0, origin, inverse[axis]);
    }
    beam.limit = largest_limit(group);
    beam.places = plane_places[octant];
    beam.order = static_cast<std::uint8_t>(octant);
    beam.size = 0;
    beam.stack = stack;
    beam.next = TreeChild::node(0);
    beam.steps = 0;
    return true;
}

/// A group's rays as boxes are tested against them: see Walk.
struct BoxTestedGroup {
    GroupRow<float> near_offset[3];
    GroupRow<float> far_offset[3];
};

HWY_INLINE void fill_offsets(const RayGroup& group, BoxTestedGroup& tested) {
    const Rays d;
    const auto slack = hn::Set(d, group.slack);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
            const auto inverse = hn::Load(d, group.inverse[axis].data() + i);
            const auto origin = hn::Load(d, group.origin[axis].data() + i);
            const auto outward = hn::CopySign(slack, inverse);
            hn::Store(
                hn::Neg(hn::Mul(hn::Add(origin, outward), inverse)),
                d,
                tested.near_offset[axis].data() + i);
            hn::Store(
                hn::Neg(hn::Mul(hn::Sub(origin, outward), inverse)),
                d,
                tested.far_offset[axis].data() + i);
        }
}

/// The lanes whose rays meet the box of a node's child before their limits.
HWY_INLINE GroupMask meeting_child(
    const WideNode& node, std::size_t child, const BeamWalk& beam, const BoxTestedGroup& tested) {
    const Rays d;
    const RayGroup& group = *beam.group;
    const float* const planes = node.planes[0].data() + child;
    GroupMask met = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        auto near = hn::Load(d, group.t_min.data() + i);
        auto far = hn::Load(d, group.limit.data() + i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto inverse = hn::Load(d, group.inverse[axis].data() + i);
            near = hn::Max(
                near,
                hn::MulAdd(
                    hn::Set(d, planes[beam.places[axis]]),
                    inverse,
                    hn::Load(d, tested.near_offset[axis].data() + i)));
            far = hn::Min(
                far,
                hn::MulAdd(
                    hn::Set(d, planes[beam.places[3 + axis]]),
                    inverse,
                    hn::Load(d, tested.far_offset[axis].data() + i)));
        }
        met |= bits_of(d, hn::Le(near, far)) << i;
    }
    return met;
}

/// Lets the children of the node wait that the lanes' rays meet, the nearest on top.
HWY_INLINE std::size_t put_met_children(
    const WideNode& node,
    const BeamWalk& beam,
    const BoxTestedGroup& tested,
    GroupMask lanes,
    WaitingGroup* stack) {
    const Children d;
    const float* const planes = node.planes[0].data();
    alignas(64) float nears[tree_width];
    std::uint32_t met = 0;
    for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d)) {
        auto near = hn::Zero(d);
        auto far = hn::Set(d, beam.limit);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto first = hn::Load(d, planes + beam.places[axis] + i);
            const auto last = hn::Load(d, planes + beam.places[3 + axis] + i);
            const auto inverse_0 = hn::Set(d, beam.inverse[axis][0]);
            const auto inverse_1 = hn::Set(d, beam.inverse[axis][1]);
            near = hn::Max(
                hn::Min(
                    hn::MulAdd(first, inverse_0, hn::Set(d, beam.near_offset[axis][0])),
                    hn::MulAdd(first, inverse_1, hn::Set(d, beam.near_offset[axis][1]))),
                near);
            far = hn::Min(
                hn::Max(
                    hn::MulAdd(last, inverse_0, hn::Set(d, beam.far_offset[axis][0])),
                    hn::MulAdd(last, inverse_1, hn::Set(d, beam.far_offset[axis][1]))),
                far);
        }
        hn::Store(near, d, nears + i);
        met |= bits_of(d, hn::Le(near, far)) << i;
    }
    std::size_t size = 0;
    for (; met != 0; met &= met - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(met));
        const GroupMask meeting = meeting_child(node, i, beam, tested) & lanes;
        if (meeting == 0)
            continue;
        std::size_t place = size++;
        for (; place > 0 && stack[place - 1].near < nears[i]; --place)
            stack[place] = stack[place - 1];
        stack[place] = {node.children[i], meeting, nears[i]};
    }
    return size;
}

/// Lets the children of the node wait whose boxes the beam meets before its limit.
HWY_INLINE void add_met_children(const WideNode& node, BeamWalk& beam) {
    const Children d;
    const float* const planes = node.planes[0].data();
    const auto line = [&](std::size_t place, float inverse, float offset) HWY_ATTR {
        return hn::MulAdd(hn::Load(d, planes + place), hn::Set(d, inverse), hn::Set(d, offset));
    };
    const auto enter = [&](std::size_t axis, std::size_t i) HWY_ATTR {
        const std::size_t place = beam.places[axis] + i;
        return hn::Min(
            line(place, beam.inverse[axis][0], beam.near_offset[axis][0]),
            line(place, beam.inverse[axis][1], beam.near_offset[axis][1]));
    };
    const auto leave = [&](std::size_t axis, std::size_t i) HWY_ATTR {
        const std::size_t place = beam.places[3 + axis] + i;
        return hn::Max(
            line(place, beam.inverse[axis][0], beam.far_offset[axis][0]),
            line(place, beam.inverse[axis][1], beam.far_offset[axis][1]));
    };
    const auto near_at = [&](std::size_t i) HWY_ATTR {
        return hn::Max(hn::Max(enter(0, i), enter(1, i)), hn::Max(enter(2, i), hn::Zero(d)));
    };
    const auto far_at = [&](std::size_t i) HWY_ATTR {
        return hn::Min(
            hn::Min(leave(0, i), leave(1, i)), hn::Min(leave(2, i), hn::Set(d, beam.limit)));
    };
    beam.size += put_met_children(node, beam.order, near_at, far_at, beam.stack + beam.size);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
