// SPDX-License-Identifier: Apache-2.0
// Ways through a tree of boxes: see float_search-inl.h. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_FLOAT_WALKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_WALKS_INL_H
#undef VERA_ACCEL_FLOAT_WALKS_INL_H
#else
#define VERA_ACCEL_FLOAT_WALKS_INL_H
#endif

#include "vera/accel/float_leaves-inl.h"
#include "vera/accel/float_shafts-inl.h"
#include "vera/accel/float_streams-inl.h"
#include "vera/accel/float_workspace-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Notes that the lanes' rays may meet element j of a leaf.
template <typename Tree>
HWY_NOINLINE void doubt_lanes(
    const Search<Tree>& search,
    const TreeChild& leaf,
    std::size_t j,
    GroupMask lanes,
    RayGroup& group) {
    for (; lanes != 0; lanes &= lanes - 1)
        doubt(
            search.space.doubtful,
            group,
            static_cast<std::size_t>(std::countr_zero(lanes)),
            static_cast<std::uint32_t>(leaf.first()),
            place_in_leaf(leaf_size(leaf), j));
}

/// Decides which of the lanes' rays meet element j of a leaf.
template <typename Tree>
HWY_NOINLINE void decide_lanes(
    const Search<Tree>& search,
    const TreeChild& leaf,
    std::size_t j,
    GroupMask lanes,
    RayGroup& group) {
    const auto first = static_cast<std::uint32_t>(leaf.first());
    const std::size_t size = leaf_size(leaf);
    const std::uint32_t place = place_in_leaf(size, j);
    lanes = not_ruled_out(rows_of(search.tree, leaf) + j, size, lanes, group);
    for (; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        if (surely_meets(search.tree, group.rays[lane], first, place))
            group.met |= lanes & -lanes;
    }
}

/// What the rays of a beam do at a leaf.
template <typename Tree>
HWY_INLINE void visit_leaf(const Search<Tree>& search, const TreeChild& leaf, BeamWalk& beam) {
    const Rays d;
    const hn::RebindToUnsigned<Rays> du;
    const std::size_t size = leaf_size(leaf);
    RayGroup& group = *beam.group;
    const auto seen = seen_elements(search, rows_of(search.tree, leaf), size, beam);
    if (seen.may == 0)
        return;
    search.counts.tests += static_cast<std::uint64_t>(std::popcount(seen.may));
    auto largest = hn::Set(d, -1);
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const auto followed = in_group(d, group.followed, i);
        const auto rays = rays_at(search, group, i);
        auto limit = hn::Load(d, group.limit.data() + i);
        auto near = hn::Load(d, group.near.data() + i);
        auto first = hn::Load(du, group.leaf.data() + i);
        auto place = hn::Load(du, group.place.data() + i);
        for (std::uint32_t rest = seen.may; rest != 0; rest &= rest - 1) {
            const auto j = static_cast<std::size_t>(std::countr_zero(rest));
            const FloatMeeting<Rays> meeting = meeting_seen(d, rays, seen, j, limit);
            const auto sure = hn::And(meeting.sure, followed);
            const auto nearer = hn::And(sure, hn::Lt(meeting.far, near));
            const auto nearer_ints = hn::RebindMask(du, nearer);
            const GroupMask doubtful =
                bits_of(d, hn::AndNot(nearer, hn::And(meeting.may, followed))) << i;
            limit = hn::IfThenElse(sure, hn::Min(limit, meeting.far), limit);
            near = hn::IfThenElse(nearer, meeting.near, near);
            first = hn::IfThenElse(
                nearer_ints, hn::Set(du, static_cast<std::uint32_t>(leaf.first())), first);
            place = hn::IfThenElse(nearer_ints, hn::Set(du, place_in_leaf(size, j)), place);
            if (HWY_UNLIKELY(doubtful != 0))
                doubt_lanes(search, leaf, j, doubtful, group);
        }
        hn::Store(limit, d, group.limit.data() + i);
        hn::Store(near, d, group.near.data() + i);
        hn::Store(first, du, group.leaf.data() + i);
        hn::Store(place, du, group.place.data() + i);
        largest = hn::Max(largest, hn::Mul(limit, hn::Load(d, group.largest.data() + i)));
    }
    beam.limit = limit_of_largest(largest);
}

/// Notes that the ray may meet the element at this place of this leaf.
template <typename Tree>
HWY_INLINE void
doubt(const Search<Tree>& search, const SingleRay& ray, std::uint32_t leaf, std::uint32_t place) {
    doubt(search.space.doubtful, *ray.group, ray.lane, leaf, place);
}

/// Whether double precision says that the ray meets the element at this place of this leaf.
template <typename Tree>
HWY_INLINE bool surely_meets(
    const Search<Tree>& search, const SingleRay& ray, std::uint32_t leaf, std::uint32_t place) {
    return surely_meets(search.tree, *ray.given, leaf, place);
}

/// Takes how a ray meets elements number i on of a leaf; true when it is only asked whether it
/// meets anything, and it does.
template <bool any, typename AnySearch>
HWY_INLINE bool take_meetings(
    AnySearch& search,
    const TreeChild& leaf,
    std::size_t i,
    const FloatMeeting<LeafLanes>& meeting,
    SingleRay& ray) {
    const LeafLanes d;
    const std::size_t size = leaf_size(leaf);
    std::uint32_t may = bits_of(d, meeting.may) & ((std::uint32_t{1} << (size - i)) - 1);
    if (may == 0)
        return false;
    const std::uint32_t sure = bits_of(d, meeting.sure);
    if constexpr (any)
        if ((sure & may) != 0)
            return true;
    alignas(64) float near[most_in_leaf];
    alignas(64) float far[most_in_leaf];
    hn::Store(meeting.near, d, near);
    hn::Store(meeting.far, d, far);
    const auto first = static_cast<std::uint32_t>(leaf.first());
    for (; may != 0; may &= may - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(may));
        const std::uint32_t place = place_in_leaf(size, i + j);
        if constexpr (!any) {
            if ((sure >> j & 1U) != 0) {
                ray.limit = std::min(ray.limit, far[j]);
                if (far[j] < ray.near) {
                    ray.near = near[j];
                    ray.leaf = first;
                    ray.place = place;
                    continue;
                }
                if (near[j] > ray.limit)
                    continue; // behind what was met in the same leaf
            }
        }
        if constexpr (any) {
            if (surely_meets(search, ray, first, place))
                return true;
        } else {
            doubt(search, ray, first, place);
        }
    }
    return false;
}

/// What the rays of a stream do at a leaf.
template <bool any, typename Tree>
HWY_INLINE void
visit_leaf(const Search<Tree>& search, const TreeChild& leaf, StreamMask rays, RayStream& stream) {
    const LeafLanes d;
    const std::size_t size = leaf_size(leaf);
    const float* const rows = rows_of(search.tree, leaf);
    search.counts.tests += size * static_cast<std::size_t>(std::popcount(rays));
    for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
        const auto elements = elements_at(search, d, rows, size, i);
        for (StreamMask rest = rays & stream.left; rest != 0; rest &= rest - 1) {
            SingleRay& ray = *stream.rays[static_cast<std::size_t>(std::countr_zero(rest))];
            if (take_meetings<any>(search, leaf, i, meeting_single(elements, ray), ray)) {
                ray.group->met |= GroupMask{1} << ray.lane;
                stream.left &= ~(rest & -rest);
            }
        }
    }
}

/// Tests rays of a shaft, side by side, against a leaf's elements that it may meet.
template <typename Tree, typename Elements>
HWY_INLINE void meet_elements(
    const Search<Tree>& search,
    const TreeChild& leaf,
    const Elements& elements,
    GroupMask lanes,
    const RayShaft& shaft) {
    const Rays d;
    RayGroup& group = *shaft.group;
    std::uint32_t may = elements_in_shaft(elements, leaf_size(leaf), shaft);
    search.counts.tests += static_cast<std::uint64_t>(std::popcount(may));
    for (; may != 0; may &= may - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(may));
        for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
            const auto meeting = meeting_spread(d, elements, j, group, i);
            const GroupMask asked = lanes & ~group.met;
            const GroupMask sure = bits_of(d, meeting.sure) << i & asked;
            const GroupMask doubtful = bits_of(d, meeting.may) << i & asked & ~sure;
            group.met |= sure;
            if (HWY_UNLIKELY(doubtful != 0))
                decide_lanes(search, leaf, j, doubtful, group);
        }
    }
}

/// What the rays of shafts, of which is only asked whether they meet anything, do at a leaf.
template <bool any, typename Tree>
HWY_NOINLINE void visit_leaf(
    const Search<Tree>& search, const TreeChild& leaf, StreamMask rays, ShaftStream& stream) {
    static_assert(any);
    const LeafLanes d;
    const std::size_t size = leaf_size(leaf);
    const float* const rows = rows_of(search.tree, leaf);
    decltype(spread_elements(search, rows, size)) elements;
    bool spread = false;
    StreamMask alone = 0;
    for (std::size_t number = 0; number < stream.count; ++number) {
        const GroupMask lanes = lanes_of(rays & stream.left, number);
        RayShaft& shaft = *stream.shafts[number];
        if (lanes == 0)
            continue;
        if (std::popcount(lanes) <= few_at_leaf) {
            alone |= rays_of(lanes, number);
            write_once(shaft);
            continue;
        }
        if (!spread)
            elements = spread_elements(search, rows, size);
        spread = true;
        meet_elements(search, leaf, elements, lanes, shaft);
        stream.left &= ~rays_of(shaft.group->met, number);
    }
    if (alone == 0)
        return;
    search.counts.tests += size * static_cast<std::size_t>(std::popcount(alone));
    for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
        const auto sides = elements_at(search, d, rows, size, i);
        for (StreamMask rest = alone & stream.left; rest != 0; rest &= rest - 1) {
            SingleRay& ray = single_at(stream, static_cast<std::size_t>(std::countr_zero(rest)));
            if (take_meetings<any>(search, leaf, i, meeting_single(sides, ray), ray)) {
                ray.group->met |= GroupMask{1} << ray.lane;
                stream.left &= ~(rest & -rest);
            }
        }
    }
}

/// Moves the beam to the next child that waits for it; false when there is none.
HWY_INLINE bool take_waiting(BeamWalk& beam) {
    if (beam.size == 0)
        return false;
    beam.next = beam.stack[--beam.size];
    return true;
}

template <typename Tree>
HWY_INLINE void fetch(const Tree& tree, const TreeChild& child) {
    fetch(tree.nodes.data(), tree.leaves.data(), Tree::leaf_rows * sizeof(float), child);
}

/// Follows the beams down from the root, a step each in turn; returns the numbers, as bits, of
/// those that have taken too many to go on like this.
template <typename Tree>
HWY_NOINLINE std::uint32_t follow_beams(const Search<Tree>& search, std::size_t count) {
    const Tree& tree = search.tree;
    std::uint32_t under_way = (std::uint32_t{1} << count) - 1;
    std::uint32_t fanned_out = 0;
    while (under_way != 0) {
        for (std::uint32_t rest = under_way; rest != 0; rest &= rest - 1) {
            const auto number = static_cast<std::size_t>(std::countr_zero(rest));
            BeamWalk& beam = search.space.beams[number];
            if (HWY_UNLIKELY(++beam.steps > Tree::most_beam_steps)) {
                fanned_out |= std::uint32_t{1} << number;
                under_way &= ~(std::uint32_t{1} << number);
                continue;
            }
            if (beam.next.is_block() != 0) {
                const float before = beam.limit;
                visit_leaf(search, beam.next, beam);
                if (beam.limit < before)
                    beam.size = drop_behind(beam.stack, beam.size, beam.limit);
            } else {
                ++search.counts.nodes;
                add_met_children(tree.nodes[beam.next.first()], beam);
            }
            if (take_waiting(beam))
                fetch(tree, beam.next);
            else
                under_way &= ~(std::uint32_t{1} << number);
        }
    }
    return fanned_out;
}

/// Makes a stream of single rays of one octant, with nothing that waits for them.
template <typename Tree>
HWY_INLINE RayStream& start_stream(
    const Search<Tree>& search,
    std::size_t number,
    std::span<const std::uint16_t> rays,
    std::size_t octant,
    bool any) {
    RayStream& stream = search.space.streams[number];
    for (std::size_t i = 0; i < rays.size(); ++i)
        stream.rays[i] = &search.space.singles[rays[i]];
    stream.count = rays.size();
    stream.left = ~StreamMask{0} >> (stream_size - rays.size());
    stream.places = plane_places[octant];
    stream.order = octant;
    stream.stack = {
        search.space.stream_children.data() + number * search.space.depth,
        search.space.stream_waiting.data() + number * search.space.depth,
        0};
    stream.patience = 0;
    if (any) {
        stream.order = any_order;
        if (run_alike(stream))
            bound_rays(octant, stream);
    }
    return stream;
}

/// Makes a stream of shafts of one octant, which begins at the root.
template <typename Tree>
HWY_INLINE void start_stream(
    const Search<Tree>& search,
    std::size_t number,
    std::span<RayShaft* const> shafts,
    std::size_t octant) {
    ShaftStream& stream = search.space.shaft_streams[number];
    std::copy(shafts.begin(), shafts.end(), stream.shafts.begin());
    stream.count = shafts.size();
    stream.left = 0;
    for (std::size_t i = 0; i < shafts.size(); ++i)
        stream.left |= rays_of(shafts[i]->group->followed, i);
    stream.places = plane_places[octant];
    stream.stack = {
        search.space.stream_children.data() + number * search.space.depth,
        search.space.stream_waiting.data() + number * search.space.depth,
        0};
    stream.stack.push(TreeChild::node(0), stream.left);
}

/// Follows the streams, a step each in turn, so that what each needs next arrives while the others
/// work.
template <bool any, typename Tree, typename Stream>
HWY_NOINLINE void
follow_streams(const Search<Tree>& search, Stream* const streams, std::size_t count) {
    const Tree& tree = search.tree;
    std::uint64_t under_way = (std::uint64_t{1} << count) - 1;
    while (under_way != 0) {
        for (std::uint64_t those = under_way; those != 0; those &= those - 1) {
            Stream& stream = streams[static_cast<std::size_t>(std::countr_zero(those))];
            TreeChild child;
            const StreamMask rays = stream.stack.take(stream.left, child);
            if (rays == 0) {
                under_way &= ~(those & -those);
                continue;
            }
            if (child.is_block() != 0) {
                visit_leaf<any>(search, child, rays, stream);
            } else {
                search.counts.nodes += static_cast<std::uint64_t>(std::popcount(rays));
                put_met_children<any>(tree.nodes[child.first()], rays, stream);
            }
            if (stream.stack.size > 0)
                fetch(tree, stream.stack.children[stream.stack.size - 1]);
        }
    }
    if constexpr (!any && std::is_same_v<Stream, RayStream>)
        for (std::size_t i = 0; i < count; ++i) {
            const RayStream& stream = streams[i];
            for (std::size_t j = 0; j < stream.count; ++j) {
                const SingleRay& ray = *stream.rays[j];
                ray.group->leaf[ray.lane] = ray.leaf;
                ray.group->place[ray.lane] = ray.place;
            }
        }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
