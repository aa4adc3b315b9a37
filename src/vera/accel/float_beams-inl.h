// SPDX-License-Identifier: Apache-2.0
// Groups of rays that go through a tree of boxes together: see float_search-inl.h. Compiled once
// for each instruction set.

#if defined(VERA_ACCEL_FLOAT_BEAMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_BEAMS_INL_H
#undef VERA_ACCEL_FLOAT_BEAMS_INL_H
#else
#define VERA_ACCEL_FLOAT_BEAMS_INL_H
#endif

#include "vera/accel/float_rays-inl.h"

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

/// The limit of a BeamWalk, where the rays' limits times their largest coordinates are these.
HWY_INLINE float limit_of_largest(hn::Vec<Rays> limits) {
    return hn::GetLane(hn::MaxOfLanes(Rays(), limits)) * (1 + 0x1p-20F);
}

/// A group of rays of one octant that goes through the tree as one: none of its rays comes to a
/// plane earlier than the earlier of two lines in the plane's place does, nor later than the later
/// of two others. It takes the rays' directions divided by their largest coordinates, so that t is
/// the way along that axis, and rays of different lengths are alike.
struct alignas(64) BeamWalk {
    float inverse[3][2];
    float near_offset[3][2];
    float far_offset[3][2];
    float origin[3];
    float direction_middle[3];
    float direction_half[3];  ///< what the directions differ from the middle
    float direction_size = 0; ///< at least the rays' and the sum of middle and half: see RayGroup
    float limit = 0;          ///< the largest of the rays
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

/// 1 / direction, but never infinite.
inline float inverse_of(float direction, bool backward) {
    constexpr float least = 0x1p-60F;
    return 1 / (backward ? std::min(direction, -least) : std::max(direction, least));
}

/// Fills in the lines of an axis along which the beam runs backward or not.
HWY_INLINE void set_lines(BeamWalk& beam, std::size_t axis, bool backward, Extent inverse) {
    const float outward = backward ? -beam.group->slack : beam.group->slack;
    const float first = beam.origin[axis] + outward;
    const float last = beam.origin[axis] - outward;
    beam.inverse[axis][0] = inverse.least;
    beam.inverse[axis][1] = inverse.most;
    for (std::size_t i = 0; i < 2; ++i) {
        beam.near_offset[axis][i] = -first * beam.inverse[axis][i];
        beam.far_offset[axis][i] = -last * beam.inverse[axis][i];
    }
}

/// Sets the group's followed rays on their way together, from the root; false where they are of
/// several octants, do not start at one place, or part so widely that boxes which the beam meets
/// are not met by rays.
HWY_INLINE bool start_beam(RayGroup& group, TreeChild* stack, BeamWalk& beam) {
    constexpr float widest = 0.02F;
    const Rays d;
    const GroupMask lanes = group.followed;
    beam.group = &group;
    std::size_t octant = 0;
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
        if (!(half < widest))
            return false;
        beam.direction_middle[axis] = 0.5F * (direction.most + direction.least);
        beam.direction_half[axis] = half + 0x1p-22F;
        size += std::abs(beam.direction_middle[axis]) + beam.direction_half[axis];
        inverse[axis] = {
            inverse_of(direction.most, backward), inverse_of(direction.least, backward)};
    }
    beam.direction_size = std::max(group.direction_size, size * (1 + 0x1p-20F));
    if (!from_one_origin(group, lanes))
        return false;
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        beam.origin[axis] = group.origin[axis][lane];
        set_lines(beam, axis, (octant >> axis & 1U) != 0, inverse[axis]);
    }
    auto largest = hn::Set(d, -1);
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
        largest = hn::Max(
            largest,
            hn::Mul(hn::Load(d, group.limit.data() + i), hn::Load(d, group.largest.data() + i)));
    beam.limit = limit_of_largest(largest);
    beam.places = plane_places[octant];
    beam.order = static_cast<std::uint8_t>(octant);
    beam.size = 0;
    beam.stack = stack;
    beam.next = TreeChild::node(0);
    beam.steps = 0;
    return true;
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
    beam.size += put_met_children(node, beam.order, near_at, far_at, beam.stack + beam.size).count;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
