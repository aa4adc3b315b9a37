// SPDX-License-Identifier: Apache-2.0
// Groups of rays that run nearly alike and only ask whether they meet anything, as those to a light
// do. A shaft holds the lines of such a group (Haines and Wallace, Shaft culling for efficient
// ray-cast radiosity, 1994): boxes of nodes are tested against it, boxes of leaves against its
// rays, side by side. See float_search-inl.h. Compiled once for each instruction set.

#if defined(VERA_ACCEL_FLOAT_SHAFTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_SHAFTS_INL_H
#undef VERA_ACCEL_FLOAT_SHAFTS_INL_H
#else
#define VERA_ACCEL_FLOAT_SHAFTS_INL_H
#endif

#include "vera/accel/float_beams-inl.h"
#include "vera/accel/float_singles-inl.h"
#include "vera/accel/tree_streams-inl.h"

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
/// So few of a shaft's rays are tested one by one: against boxes, and against what is in a leaf.
constexpr int few_in_shaft = 6;
constexpr int few_at_leaf = 10;

/// A group of rays of one octant, held by bounds of where they pass. Their main axis is the one
/// along which the first runs fastest; c is the way along it from where the first of them starts.
/// Across it, a ray is at a + (c - anchor) slope, with a in a rectangle and slopes between bounds.
/// The anchor is where they start or where they end, whichever is narrower: at a light, a point all
/// but for what is rounded.
///
/// Boxes are tested as against a BoxedRay, but by one line where rays enter and another where they
/// leave: none of the rays comes to a plane ahead of it earlier than the near line tells, nor later
/// than the far one.
struct alignas(64) RayShaft {
    float near_inverse[3];
    float far_inverse[3];
    float near_offset[3];
    float far_offset[3];
    float limit;            ///< where the last of the rays ends
    float before;           ///< from the first start to the anchor
    float after;            ///< from the anchor to the last end
    float anchor_middle[3]; ///< of the rectangle
    float anchor_half[3];
    float direction_middle[3]; ///< slopes; 1 or -1 along the main axis
    float direction_half[3];
    float moment_half[3];          ///< of way x direction, what comes of the rectangle's size
    float outward[3];              ///< slack, against the direction
    float anchor_reach = 0;        ///< the largest half
    float direction_size = 0;      ///< at least the sum of middle and half
    GroupRow<float> ray_offset[3]; ///< of the rays: -origin / direction
    RayGroup* group = nullptr;
    SingleRay* singles = nullptr; ///< where the rays stand by themselves
    bool written = false;         ///< whether they do already
    /// How often none of the rays may meet a leaf that the shaft meets, until they are tested
    /// against all children.
    int patience = 0;
};

/// Groups in a stream of shafts: one bit of a StreamMask for each ray.
constexpr std::size_t shafts_in_stream = stream_size / group_size;

/// Shafts of one octant that go through the tree together.
struct ShaftStream {
    std::array<RayShaft*, shafts_in_stream> shafts;
    std::size_t count = 0;
    StreamMask left = 0;                ///< the rays whose search goes on
    std::array<std::uint8_t, 6> places; ///< see plane_places
    StreamStack stack;
};

/// Of the rays of a stream, those of a shaft.
HWY_INLINE GroupMask lanes_of(StreamMask rays, std::size_t shaft) {
    return static_cast<GroupMask>(rays >> (shaft * group_size)) & 0xffffU;
}

HWY_INLINE StreamMask rays_of(GroupMask lanes, std::size_t shaft) {
    return StreamMask{lanes} << (shaft * group_size);
}

/// Writes the rays of the shaft by themselves, unless they are written already.
HWY_INLINE void write_once(RayShaft& shaft) {
    if (HWY_UNLIKELY(!shaft.written))
        write_singles(*shaft.group, shaft.singles);
    shaft.written = true;
}

HWY_INLINE SingleRay& single_at(ShaftStream& stream, std::size_t ray) {
    return stream.shafts[ray / group_size]->singles[ray % group_size];
}

/// Whether the first and the last of the lanes' rays end nearer to each other than they start.
HWY_INLINE bool run_together(const RayGroup& group, GroupMask lanes) {
    const auto first = static_cast<std::size_t>(std::countr_zero(lanes));
    const auto last = static_cast<std::size_t>(std::bit_width(lanes) - 1);
    float start_apart = 0;
    float end_apart = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto end = [&](std::size_t lane) {
            return group.origin[axis][lane] + group.limit[lane] * group.direction[axis][lane];
        };
        start_apart += std::abs(group.origin[axis][first] - group.origin[axis][last]);
        end_apart += std::abs(end(first) - end(last));
    }
    return end_apart < start_apart; // false where an end is infinite
}

/// Where a shaft is anchored, and between which bounds its rays run across an axis.
struct ShaftAxis {
    bool from_end = false; ///< the anchor is where they end
    float way = 0;         ///< from the first start to the anchor
    float slack = 0;       ///< for what is rounded
    bool backward = false;
    Extent slope;
    Extent at_anchor;
};

/// Fills in what tells of one axis.
HWY_INLINE void set_axis(RayShaft& shaft, std::size_t axis, const ShaftAxis& from) {
    const auto& [from_end, way, slack, backward, slope, at_anchor] = from;
    const float half = 0.5F * (slope.most - slope.least);
    shaft.direction_middle[axis] = 0.5F * (slope.most + slope.least);
    // A slope is rounded twice.
    shaft.direction_half[axis] = half + 0x1p-21F;
    shaft.direction_size += std::abs(shaft.direction_middle[axis]) + shaft.direction_half[axis];
    shaft.anchor_middle[axis] = 0.5F * (at_anchor.most + at_anchor.least);
    shaft.anchor_half[axis] = 0.5F * (at_anchor.most - at_anchor.least) + slack;
    shaft.anchor_reach = std::max(shaft.anchor_reach, shaft.anchor_half[axis]);
    // What is ahead of all rays runs fast where it leaves the anchor, and slowly where it comes to
    // it; what is behind them, the other way round.
    const float slow = backward ? slope.most : slope.least;
    const float fast = backward ? slope.least : slope.most;
    const float ahead = backward ? at_anchor.least - slack : at_anchor.most + slack;
    const float behind = backward ? at_anchor.most + slack : at_anchor.least - slack;
    const float ahead_slope = from_end ? slow : fast;
    const float behind_slope = from_end ? fast : slow;
    shaft.near_inverse[axis] = inverse_of(ahead_slope, backward);
    shaft.far_inverse[axis] = inverse_of(behind_slope, backward);
    shaft.near_offset[axis] = -(ahead - way * ahead_slope) * shaft.near_inverse[axis];
    shaft.far_offset[axis] = -(behind - way * behind_slope) * shaft.far_inverse[axis];
}

/// Fills in what follows from all axes, and of each ray by itself.
HWY_INLINE void finish_shaft(RayGroup& group, std::size_t octant, RayShaft& shaft) {
    const Rays d;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t next = (axis + 1) % 3;
        const std::size_t other = (axis + 2) % 3;
        const auto direction = [&](std::size_t of) {
            return std::abs(shaft.direction_middle[of]) + shaft.direction_half[of];
        };
        shaft.moment_half[axis] = (1 + 0x1p-20F)
            * (shaft.anchor_half[next] * direction(other)
               + shaft.anchor_half[other] * direction(next));
        shaft.outward[axis] = (octant >> axis & 1U) != 0 ? -group.slack : group.slack;
        for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
            hn::Store(
                hn::Neg(hn::Mul(
                    hn::Load(d, group.origin[axis].data() + i),
                    hn::Load(d, group.inverse[axis].data() + i))),
                d,
                shaft.ray_offset[axis].data() + i);
    }
    shaft.direction_size *= 1 + 0x1p-20F;
    shaft.written = false;
    shaft.patience = 2;
    shaft.group = &group;
}

/// Holds the group's rays by a shaft; false where they are of several octants, or part so widely
/// that boxes which the shaft meets are not met by rays.
HWY_NOINLINE inline bool start_shaft(RayGroup& group, RayShaft& shaft, std::size_t& octant) {
    constexpr float widest = 0.02F;
    constexpr float farthest_end = 16; // more than that, what is rounded on the way there counts
    const Rays d;
    using V = hn::Vec<Rays>;
    const GroupMask lanes = group.followed;
    const auto first = static_cast<std::size_t>(std::countr_zero(lanes));
    std::size_t main = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
        if (std::abs(group.direction[axis][first]) > std::abs(group.direction[main][first]))
            main = axis;
    const float sign = group.direction[main][first] < 0 ? -1.0F : 1.0F;
    const std::array<GroupMask, 3> backward = backward_lanes(group);
    octant = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const GroupMask of_axis = backward[axis] & lanes;
        if (of_axis != 0 && of_axis != lanes)
            return false;
        octant |= std::size_t{of_axis != 0} << axis;
    }
    // Where the rays start and end along the main axis, in the direction in which they run.
    GroupRow<float> starts;
    GroupRow<float> ends;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const V start = hn::Mul(hn::Load(d, group.origin[main].data() + i), hn::Set(d, sign));
        // No number where an endless ray has no direction along the axis: too steep for a shaft.
        const V way = hn::Mul(
            hn::Load(d, group.limit.data() + i),
            hn::Abs(hn::Load(d, group.direction[main].data() + i)));
        hn::Store(start, d, starts.data() + i);
        hn::Store(hn::Min(hn::Add(start, way), hn::Set(d, 0x1p60F)), d, ends.data() + i);
    }
    const float start = extent_of(starts, lanes).least;
    const float end = extent_of(ends, lanes).most;
    ShaftAxis across;
    across.from_end = end - start < farthest_end && run_together(group, lanes);
    const float anchor = across.from_end ? end : start;
    across.way = anchor - start;
    // Slopes, each off by 2^-23 of itself, and places at the anchor are rounded, and so are the
    // lines that are made of them: by less than 2^-21 of the way and a rounding or two of the
    // coordinates, of which the group's slack is several.
    across.slack = 2 * group.slack + 0x1p-20F * across.way;
    shaft.limit = (end - start) * (1 + 0x1p-20F) + 2 * across.slack;
    shaft.before = across.from_end ? shaft.limit : 0;
    shaft.after = across.from_end ? 2 * across.slack : shaft.limit;
    shaft.direction_size = 0;
    shaft.anchor_reach = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        across.slope = {sign, sign};
        across.at_anchor = {sign * anchor, sign * anchor};
        if (axis != main) {
            GroupRow<float> slopes;
            GroupRow<float> places;
            for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
                const V slope = hn::Mul(
                    hn::Load(d, group.direction[axis].data() + i),
                    hn::Abs(hn::Load(d, group.inverse[main].data() + i)));
                const V way = hn::Sub(hn::Set(d, anchor), hn::Load(d, starts.data() + i));
                const V origin = hn::Load(d, group.origin[axis].data() + i);
                hn::Store(slope, d, slopes.data() + i);
                hn::Store(hn::MulAdd(way, slope, origin), d, places.data() + i);
            }
            across.slope = extent_of(slopes, lanes);
            across.at_anchor = extent_of(places, lanes);
        }
        if (!(across.slope.most - across.slope.least < 2 * widest
              && across.at_anchor.most - across.at_anchor.least < 2 * widest))
            return false;
        across.backward = (octant >> axis & 1U) != 0;
        set_axis(shaft, axis, across);
    }
    finish_shaft(group, octant, shaft);
    return true;
}

/// The children of the node that the shaft meets.
HWY_INLINE std::uint32_t children_of_shaft(
    const WideNode& node, const std::array<std::uint8_t, 6>& places, const RayShaft& shaft) {
    const Children d;
    const float* const planes = node.planes[0].data();
    std::uint32_t met = 0;
    for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d)) {
        auto near = hn::Zero(d);
        auto far = hn::Set(d, shaft.limit);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            near = hn::Max(
                near,
                hn::MulAdd(
                    hn::Load(d, planes + places[axis] + i),
                    hn::Set(d, shaft.near_inverse[axis]),
                    hn::Set(d, shaft.near_offset[axis])));
            far = hn::Min(
                far,
                hn::MulAdd(
                    hn::Load(d, planes + places[3 + axis] + i),
                    hn::Set(d, shaft.far_inverse[axis]),
                    hn::Set(d, shaft.far_offset[axis])));
        }
        met |= bits_of(d, hn::Le(near, far)) << i;
    }
    return met;
}

/// The shaft's rays that meet a child of the node.
HWY_INLINE GroupMask rays_at_child(
    const WideNode& node,
    const std::array<std::uint8_t, 6>& places,
    std::size_t child,
    const RayShaft& shaft) {
    const Rays d;
    const RayGroup& group = *shaft.group;
    const float* const planes = node.planes[0].data() + child;
    GroupMask met = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        auto near = hn::Zero(d);
        auto far = hn::Load(d, group.limit.data() + i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto inverse = hn::Load(d, group.inverse[axis].data() + i);
            const auto offset = hn::Load(d, shaft.ray_offset[axis].data() + i);
            const float first = planes[places[axis]] - shaft.outward[axis];
            const float last = planes[places[3 + axis]] + shaft.outward[axis];
            near = hn::Max(near, hn::MulAdd(hn::Set(d, first), inverse, offset));
            far = hn::Min(far, hn::MulAdd(hn::Set(d, last), inverse, offset));
        }
        met |= bits_of(d, hn::Le(near, far)) << i;
    }
    return met;
}

/// The children of the node that are blocks.
HWY_INLINE std::uint32_t blocks_of(const WideNode& node) {
#if VERA_AVX512
    return _mm512_test_epi64_mask(
        _mm512_load_si512(node.children.data()),
        _mm512_set1_epi64(std::int64_t{1} << TreeChild::block_shift));
#else
    std::uint32_t blocks = 0;
    for (std::size_t i = 0; i < tree_width; ++i)
        blocks |= static_cast<std::uint32_t>(node.children[i].is_block()) << i;
    return blocks;
#endif
}

/// Adds the rays to those that meet each of the children.
HWY_INLINE void add_rays(std::uint32_t children, StreamMask rays, ChildRays& met_rays) {
#if VERA_AVX512
    met_rays = _mm512_mask_or_epi64(
        met_rays,
        static_cast<__mmask8>(children),
        met_rays,
        _mm512_set1_epi64(static_cast<long long>(rays)));
#else
    for (; children != 0; children &= children - 1)
        met_rays[static_cast<std::size_t>(std::countr_zero(children))] |= rays;
#endif
}

/// Lets the children of the node wait that the rays of the shafts meet before their limits.
template <bool any>
HWY_NOINLINE void put_met_children(const WideNode& node, StreamMask rays, ShaftStream& stream) {
    static_assert(any);
    ChildRays met_rays = {};
    StreamMask alone = 0;
    const std::uint32_t blocks = blocks_of(node);
    for (std::size_t i = 0; i < stream.count; ++i) {
        const GroupMask lanes = lanes_of(rays, i);
        RayShaft& shaft = *stream.shafts[i];
        if (lanes == 0)
            continue;
        if (std::popcount(lanes) <= few_in_shaft) {
            alone |= rays_of(lanes, i);
            write_once(shaft);
            continue;
        }
        const std::uint32_t met = children_of_shaft(node, stream.places, shaft);
        std::uint32_t refined = shaft.patience > 0 ? met & blocks : met;
        add_rays(met & ~refined, rays_of(lanes, i), met_rays);
        for (; refined != 0; refined &= refined - 1) {
            const auto child = static_cast<std::size_t>(std::countr_zero(refined));
            const GroupMask at_child = lanes & rays_at_child(node, stream.places, child, shaft);
            shaft.patience -= at_child == 0 ? 1 : 0;
            add_rays(refined & -refined, rays_of(at_child, i), met_rays);
        }
    }
    if (alone != 0) {
        const auto ray_at = [&](std::size_t i) {
            const SingleRay& ray = single_at(stream, i);
            return BoxedRay<1>{ray.inverse, ray.near_offset, ray.far_offset, ray.limit};
        };
        const ChildRays of_single = rays_of_children<1>(node, stream.places, alone, ray_at);
#if VERA_AVX512
        met_rays = _mm512_or_si512(met_rays, of_single);
#else
        for (std::size_t i = 0; i < tree_width; ++i)
            met_rays[i] |= of_single[i];
#endif
    }
    put_waiting(node, met_rays, any_order, stream.stack);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
