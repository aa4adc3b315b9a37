// SPDX-License-Identifier: Apache-2.0
// Rays as they go through the tree of a mesh: see mesh_search.cpp. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_MESH_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_MESH_RAYS_INL_H
#undef VERA_ACCEL_MESH_RAYS_INL_H
#else
#define VERA_ACCEL_MESH_RAYS_INL_H
#endif

#include "vera/accel/mesh_tree.h"
#include "vera/accel/tree_children-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Rays that follow each other, and may go through the tree together.
constexpr std::size_t group_size = 16;
using GroupMask = std::uint32_t;

using Rays = hn::CappedTag<float, group_size>;
using RayInts = hn::RebindToSigned<Rays>;

template <typename Number>
struct alignas(64) GroupRow : std::array<Number, group_size> {};

/// A group of rays, coordinate by coordinate, as single precision follows them: in the coordinates
/// of the tree, with directions of which the largest coordinate lies between 1 and 2. There t is
/// t_scale times what it is outside. All of these are powers of two times what was given, exactly.
struct RayGroup {
    GroupRow<float> origin[3];
    GroupRow<float> direction[3];
    GroupRow<float> t_min;
    GroupRow<float> t_max;
    GroupRow<float> per_t_scale; ///< 1 / t_scale
    GroupRow<float> inverse[3];  ///< of the direction; large but finite where that is 0
    GroupRow<float> largest;     ///< the direction's largest coordinate, without its sign
    GroupRow<float> limit;       ///< what lies behind this t does not count any more
    /// Of what is surely met and nearest so far: a t before which it is not; and where it stands.
    GroupRow<float> near;
    GroupRow<std::uint32_t> leaf;  ///< TreeChild::first() of its leaf
    GroupRow<std::uint32_t> place; ///< in the leaf: see place_in_leaf()
    GroupRow<std::uint32_t> doubtful; ///< the last of the lane's Doubtful
    GroupMask in_doubt = 0;           ///< the lanes that have one
    std::span<const MeshRay> rays;
    GroupMask followed = 0;   ///< the lanes of rays that single precision can follow
    GroupMask met = 0;        ///< where only this is asked: the lanes that surely meet something
    float direction_size = 0; ///< the largest sum of a direction's coordinates, without signs
    float slack = 0;          ///< how far boxes are enlarged for what is rounded
    /// How far the lines of rays may pass the origins. Where that is more than 0, the rays were
    /// turned round, and these say where they started, before.
    float blur = 0;
    GroupRow<float> start[3];
    GroupRow<float> start_t_min;
};

/// No place in a leaf.
constexpr std::uint32_t no_place = ~std::uint32_t{0};

/// Where triangle i of a leaf of that size stands.
inline std::uint32_t place_in_leaf(std::size_t size, std::size_t i) {
    return static_cast<std::uint32_t>(size << 8U | i);
}

HWY_INLINE hn::Mask<Rays> in_group(Rays d, GroupMask set, std::size_t first) {
    const std::uint8_t bytes[8] = {
        static_cast<std::uint8_t>(set >> first), static_cast<std::uint8_t>(set >> first >> 8U)};
    return hn::LoadMaskBits(d, bytes);
}

/// Rays that go to more than so many times the mesh's size away from it are followed in double
/// precision: single precision does not tell much of them.
constexpr float farthest_origin = 0x1p10F;

/// 2^(exponents - 127), for exponents as they stand in a float: from 1 to 254.
HWY_INLINE hn::Vec<Rays> power_of_two(hn::Vec<RayInts> exponents) {
    return hn::BitCast(Rays(), hn::ShiftLeft<23>(exponents));
}

/// Fills in what follows from the rows of the rays as they were given.
HWY_INLINE void place_group(const MeshTree& tree, GroupMask lanes, RayGroup& group) {
    const Rays d;
    const RayInts di;
    const auto first = hn::Set(d, tree.scale.first);
    const auto second = hn::Set(d, tree.scale.second);
    const auto back_first = hn::Set(d, tree.scale_back.first);
    const auto back_second = hn::Set(d, tree.scale_back.second);
    const auto exponent = hn::Set(di, tree.exponent);
    const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    auto largest_origin = hn::Zero(d);
    auto largest_direction = hn::Zero(d);
    group.followed = 0;
    group.met = 0;
    group.in_doubt = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        auto followed = in_group(d, lanes, i);
        auto size = hn::Zero(d);
        for (const auto& row : group.direction)
            size = hn::Max(size, hn::Abs(hn::Load(d, row.data() + i)));
        const auto size_exponent = hn::ShiftRight<23>(hn::BitCast(di, size));
        const auto t_exponent = hn::Add(size_exponent, exponent);
        const auto usual = hn::And(
            hn::And(hn::Gt(size_exponent, hn::Zero(di)), hn::Lt(size_exponent, hn::Set(di, 254))),
            hn::And(hn::Gt(t_exponent, hn::Zero(di)), hn::Lt(t_exponent, hn::Set(di, 254))));
        followed = hn::And(followed, hn::RebindMask(d, usual));

        const auto to_unit = power_of_two(hn::Sub(hn::Set(di, 254), size_exponent));
        const auto from_unit = power_of_two(size_exponent);
        auto origin_size = hn::Zero(d);
        auto direction_size = hn::Zero(d);
        auto largest = hn::Zero(d);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto given = hn::Load(d, group.direction[axis].data() + i);
            // -0 becomes 0.
            const auto direction = hn::Add(hn::Mul(given, to_unit), hn::Zero(d));
            followed = hn::And(followed, hn::Eq(hn::Mul(direction, from_unit), given));
            hn::Store(direction, d, group.direction[axis].data() + i);
            largest = hn::Max(largest, hn::Abs(direction));
            direction_size = hn::Add(direction_size, hn::Abs(direction));
            hn::Store(
                hn::Div(
                    hn::Set(d, 1),
                    hn::CopySign(hn::Max(hn::Abs(direction), hn::Set(d, 0x1p-60F)), direction)),
                d,
                group.inverse[axis].data() + i);
            const auto given_origin = hn::Load(d, group.origin[axis].data() + i);
            const auto origin = hn::Mul(hn::Mul(given_origin, first), second);
            followed = hn::And(
                followed, hn::Eq(hn::Mul(hn::Mul(origin, back_first), back_second), given_origin));
            hn::Store(origin, d, group.origin[axis].data() + i);
            origin_size = hn::Max(origin_size, hn::Abs(origin));
        }
        followed = hn::And(followed, hn::Le(origin_size, hn::Set(d, farthest_origin)));

        const auto t_scale = power_of_two(t_exponent);
        const auto per_t_scale = power_of_two(hn::Sub(hn::Set(di, 254), t_exponent));
        const auto given_min = hn::Load(d, group.t_min.data() + i);
        const auto given_max = hn::Load(d, group.t_max.data() + i);
        // -0 becomes 0.
        const auto t_min = hn::Add(hn::Mul(given_min, t_scale), hn::Zero(d));
        const auto t_max = hn::Mul(given_max, t_scale);
        followed = hn::And(
            followed,
            hn::And(
                hn::And(hn::Ge(t_min, hn::Zero(d)), hn::Le(t_min, t_max)),
                hn::And(
                    hn::Eq(hn::Mul(t_min, per_t_scale), given_min),
                    hn::Or(
                        hn::Eq(hn::Mul(t_max, per_t_scale), given_max), hn::Eq(t_max, infinite)))));
        hn::Store(t_min, d, group.t_min.data() + i);
        hn::Store(t_max, d, group.t_max.data() + i);
        hn::Store(per_t_scale, d, group.per_t_scale.data() + i);
        hn::Store(hn::IfThenElse(followed, t_max, hn::Set(d, -1)), d, group.limit.data() + i);
        hn::Store(infinite, d, group.near.data() + i);
        hn::Store(
            hn::Set(hn::RebindToUnsigned<Rays>(), no_place),
            hn::RebindToUnsigned<Rays>(),
            group.place.data() + i);
        // Those of other rays may be no numbers.
        hn::Store(hn::IfThenElse(followed, largest, hn::Set(d, 1)), d, group.largest.data() + i);
        group.followed |= bits_of(d, followed) << i;
        largest_origin = hn::Max(largest_origin, hn::IfThenElseZero(followed, origin_size));
        largest_direction =
            hn::Max(largest_direction, hn::IfThenElseZero(followed, direction_size));
    }
    group.direction_size = hn::GetLane(hn::MaxOfLanes(d, largest_direction)) * (1 + 0x1p-20F);
    // A plane's place is rounded by up to five units of 2^-24 of what is added up: the plane's
    // coordinate, which is at most 1, and the origin's.
    group.blur = 0;
    group.slack = 0x1p-20F * (1 + hn::GetLane(hn::MaxOfLanes(d, largest_origin)));
}

/// Writes four times four numbers column by column: number i of from[j] becomes number j of to[i].
HWY_INLINE void
transpose(const std::array<const float*, 4>& from, const std::array<float*, 4>& to) {
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            to[i][j] = from[j][i];
#else
    const hn::FixedTag<float, 4> d;
    const auto a = hn::LoadU(d, from[0]);
    const auto b = hn::LoadU(d, from[1]);
    const auto c = hn::LoadU(d, from[2]);
    const auto e = hn::LoadU(d, from[3]);
    const auto ac = hn::InterleaveLower(d, a, c);
    const auto be = hn::InterleaveLower(d, b, e);
    const auto upper_ac = hn::InterleaveUpper(d, a, c);
    const auto upper_be = hn::InterleaveUpper(d, b, e);
    hn::StoreU(hn::InterleaveLower(d, ac, be), d, to[0]);
    hn::StoreU(hn::InterleaveUpper(d, ac, be), d, to[1]);
    hn::StoreU(hn::InterleaveLower(d, upper_ac, upper_be), d, to[2]);
    hn::StoreU(hn::InterleaveUpper(d, upper_ac, upper_be), d, to[3]);
#endif
}

/// Writes up to group_size rays row by row, and places them.
HWY_INLINE void start_group(const MeshTree& tree, std::span<const MeshRay> rays, RayGroup& group) {
    static_assert(offsetof(MeshRay, t_min) == 3 * sizeof(float));
    static_assert(offsetof(MeshRay, direction) == 4 * sizeof(float));
    static_assert(offsetof(MeshRay, t_max) == 7 * sizeof(float));
    group.rays = rays;
    std::array<MeshRay, group_size> copies;
    const MeshRay* from = rays.data();
    if (rays.size() < group_size) {
        // What is missing is a copy of the last.
        for (std::size_t lane = 0; lane < group_size; ++lane)
            copies[lane] = rays[std::min(lane, rays.size() - 1)];
        from = copies.data();
    }
    for (std::size_t lane = 0; lane < group_size; lane += 4) {
        const MeshRay* const four = from + lane;
        transpose(
            {four[0].origin.data(),
             four[1].origin.data(),
             four[2].origin.data(),
             four[3].origin.data()},
            {&group.origin[0][lane],
             &group.origin[1][lane],
             &group.origin[2][lane],
             &group.t_min[lane]});
        transpose(
            {four[0].direction.data(),
             four[1].direction.data(),
             four[2].direction.data(),
             four[3].direction.data()},
            {&group.direction[0][lane],
             &group.direction[1][lane],
             &group.direction[2][lane],
             &group.t_max[lane]});
    }
    // Where corners lost digits, what is sure in single precision is sure of other corners.
    place_group(tree, tree.exact ? (GroupMask{1} << rays.size()) - 1 : 0, group);
}

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
    float direction_half[3]; ///< what the directions differ from the middle
    float limit = 0;         ///< the largest of the rays
    bool one_origin = false;
    bool narrow = false;                ///< so that boxes that the beam meets are met by rays
    std::array<std::uint8_t, 6> places; ///< see plane_places
    std::uint8_t order = 0;             ///< see put_met_children
    std::uint32_t size = 0;             ///< of the stack
    TreeChild* stack = nullptr;         ///< what waits; the next one is on top
    TreeChild next;                     ///< where the group is
    RayGroup* group = nullptr;
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
    const Rays d;
    const GroupMask lanes = group.followed;
    beam.group = &group;
    std::size_t octant = 0;
    beam.narrow = true;
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
        beam.narrow = beam.narrow && half < widest;
        beam.direction_middle[axis] = 0.5F * (direction.most + direction.least);
        beam.direction_half[axis] = half + 0x1p-22F;
        inverse[axis] = {
            inverse_of(direction.most, backward), inverse_of(direction.least, backward)};
    }
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

/// A ray that goes through the tree alone.
struct alignas(64) RayWalk {
    Walk walk;
    float origin[3];
    float direction[3];
    float direction_size = 0; ///< this and the next: see RayGroup
    float blur = 0;
    float t_min = 0;
    float limit = 0;
    float near = 0;
    std::uint32_t leaf = 0;
    std::uint32_t place = no_place;
    std::uint32_t lane = 0;
    RayGroup* group = nullptr; ///< where it stands among others
    const MeshRay* given = nullptr;
};

/// Lets the ray begin at the root, or where it is left.
HWY_INLINE void
start_walk(const float* inverse, float slack, bool any, TreeChild* stack, RayWalk& ray) {
    std::size_t octant = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float outward = std::copysign(slack, inverse[axis]);
        ray.walk.inverse[axis] = inverse[axis];
        ray.walk.near_offset[axis] = -(ray.origin[axis] + outward) * inverse[axis];
        ray.walk.far_offset[axis] = -(ray.origin[axis] - outward) * inverse[axis];
        octant |= std::size_t{std::signbit(inverse[axis])} << axis;
    }
    ray.walk.places = plane_places[octant];
    ray.walk.order = static_cast<std::uint8_t>(any ? any_order : octant);
    ray.walk.size = 0;
    ray.walk.stack = stack;
    ray.place = no_place;
}

HWY_INLINE void
start_alone(RayGroup& group, std::size_t lane, bool any, TreeChild* stack, RayWalk& ray) {
    float inverse[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        ray.origin[axis] = group.origin[axis][lane];
        ray.direction[axis] = group.direction[axis][lane];
        inverse[axis] = group.inverse[axis][lane];
    }
    ray.direction_size = group.direction_size;
    ray.blur = group.blur;
    ray.t_min = group.t_min[lane];
    ray.limit = group.limit[lane];
    ray.near = group.near[lane];
    ray.lane = static_cast<std::uint32_t>(lane);
    ray.group = &group;
    ray.given = &group.rays[lane];
    start_walk(inverse, group.slack, any, stack, ray);
}

/// The factor 2^(exponent - 127), of an exponent as it stands in a float: from 1 to 254.
inline float power_of_two(int exponent) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(exponent) << 23U);
}

/// The same for one ray that is asked about alone, as place_group() does it; false where single
/// precision cannot follow it. per_t_scale as in a RayGroup.
HWY_INLINE bool start_single(
    const MeshTree& tree,
    const MeshRay& given,
    bool any,
    TreeChild* stack,
    RayWalk& ray,
    float& per_t_scale) {
    const float size = std::max(
        std::abs(given.direction[0]),
        std::max(std::abs(given.direction[1]), std::abs(given.direction[2])));
    const int size_exponent = static_cast<int>(std::bit_cast<std::uint32_t>(size) >> 23U);
    const int t_exponent = size_exponent + tree.exponent;
    if (!tree.exact || size_exponent < 1 || size_exponent > 253 || t_exponent < 1
        || t_exponent > 253)
        return false;
    const float to_unit = power_of_two(254 - size_exponent);
    const float from_unit = power_of_two(size_exponent);
    const float t_scale = power_of_two(t_exponent);
    per_t_scale = power_of_two(254 - t_exponent);
    bool followed = true;
    float origin_size = 0;
    float direction_size = 0;
    float inverse[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float direction = given.direction[axis] * to_unit + 0;
        const float origin = tree.scale(given.origin[axis]);
        followed = followed && direction * from_unit == given.direction[axis]
            && tree.scale_back(origin) == given.origin[axis];
        ray.origin[axis] = origin;
        ray.direction[axis] = direction;
        inverse[axis] = 1 / std::copysign(std::max(std::abs(direction), 0x1p-60F), direction);
        origin_size = std::max(origin_size, std::abs(origin));
        direction_size += std::abs(direction);
    }
    ray.t_min = given.t_min * t_scale + 0;
    ray.limit = given.t_max * t_scale;
    followed = followed && origin_size <= farthest_origin && ray.t_min >= 0
        && ray.t_min <= ray.limit && ray.t_min * per_t_scale == given.t_min
        && (ray.limit * per_t_scale == given.t_max
            || ray.limit == std::numeric_limits<float>::infinity());
    if (!followed)
        return false;
    ray.direction_size = direction_size * (1 + 0x1p-20F);
    ray.blur = 0;
    ray.near = std::numeric_limits<float>::infinity();
    ray.lane = 0;
    ray.given = &given;
    start_walk(inverse, 0x1p-20F * (1 + origin_size), any, stack, ray);
    return true;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
