// SPDX-License-Identifier: Apache-2.0
// Searches a tree of boxes of single precision for what rays meet. Sixteen rays that follow each
// other and start at one place go through it as a beam (float_beams-inl.h), others in streams of
// one octant (float_streams-inl.h), one alone by itself (float_alone-inl.h). Single precision
// settles what it is sure of; the rest is decided in double precision, and so are the numbers of
// each hit. Compiled once for each instruction set, and for each kind of tree: see FloatTree.

#if defined(VERA_ACCEL_FLOAT_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_SEARCH_INL_H
#undef VERA_ACCEL_FLOAT_SEARCH_INL_H
#else
#define VERA_ACCEL_FLOAT_SEARCH_INL_H
#endif

#include "vera/accel/float_alone-inl.h"
#include "vera/accel/float_hits-inl.h"
#include "vera/accel/float_walks-inl.h"
#include "vera/accel/float_workspace-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Lets the processor fetch the rays of the next group.
HWY_INLINE void fetch_rays(std::span<const IndexRay> rays, std::size_t first) {
    constexpr std::size_t rays_of_line = 2;
    const std::size_t end = std::min(rays.size(), first + group_size);
    for (std::size_t i = first; i < end; i += rays_of_line)
        hwy::Prefetch(&rays[i]);
}

/// Numbers of single rays, octant by octant, and how many streams there are.
template <typename Tree>
struct Gathered {
    std::array<std::array<std::uint16_t, rays_at_once<Tree>>, octant_count> of_octant;
    std::array<std::size_t, octant_count> counts = {};
    std::size_t streams = 0;
};

/// The number of the first of the group's rays among all.
template <typename Tree>
HWY_INLINE std::size_t first_ray(const Search<Tree>& search, const RayGroup& group) {
    return static_cast<std::size_t>(&group - search.space.groups.data()) * group_size;
}

/// Adds the group's rays to those that go through the tree in streams from the root on.
template <typename Tree>
HWY_INLINE void gather(const Search<Tree>& search, RayGroup& group, Gathered<Tree>& gathered) {
    const std::size_t first = first_ray(search, group);
    write_singles(group, &search.space.singles[first]);
    add_numbers(search, group, &search.space.singles[first]);
    const auto backward = backward_lanes(group);
    for (std::size_t octant = 0; octant < octant_count; ++octant) {
        GroupMask lanes = group.followed;
        for (std::size_t axis = 0; axis < 3; ++axis)
            lanes &= (octant >> axis & 1U) != 0 ? backward[axis] : ~backward[axis];
        std::size_t& count = gathered.counts[octant];
        std::uint16_t* const numbers = gathered.of_octant[octant].data();
        for (; lanes != 0; lanes &= lanes - 1)
            numbers[count++] = static_cast<std::uint16_t>(
                first + static_cast<std::size_t>(std::countr_zero(lanes)));
    }
}

/// Shafts, octant by octant, and how many there are.
struct GatheredShafts {
    std::array<std::array<RayShaft*, most_groups>, octant_count> of_octant;
    std::array<std::size_t, octant_count> counts = {};
    std::size_t count = 0;
};

/// Makes a shaft of the group's rays, if they run alike.
template <typename Tree>
HWY_INLINE bool
gather_shaft(const Search<Tree>& search, RayGroup& group, GatheredShafts& gathered) {
    RayShaft& shaft = search.space.shafts[gathered.count];
    std::size_t octant = 0;
    if (std::popcount(group.followed) <= few_rays || not_followed(group) != 0
        || !start_shaft(group, shaft, octant))
        return false;
    shaft.singles = &search.space.singles[first_ray(search, group)];
    ++gathered.count;
    gathered.of_octant[octant][gathered.counts[octant]++] = &shaft;
    return true;
}

/// Follows all shafts.
template <typename Tree>
HWY_INLINE void follow_gathered(const Search<Tree>& search, GatheredShafts& gathered) {
    std::size_t streams = 0;
    for (std::size_t octant = 0; octant < octant_count; ++octant)
        for (std::size_t i = 0; i < gathered.counts[octant]; i += shafts_in_stream)
            start_stream(
                search,
                streams++,
                std::span<RayShaft* const>(
                    &gathered.of_octant[octant][i],
                    std::min(shafts_in_stream, gathered.counts[octant] - i)),
                octant);
    if (streams > 0)
        follow_streams<true>(search, search.space.shaft_streams.data(), streams);
}

/// Makes a stream of the rays of a beam, which goes on where the beam is.
template <typename Tree>
HWY_NOINLINE void
go_on_as_stream(const Search<Tree>& search, const BeamWalk& beam, Gathered<Tree>& gathered) {
    RayGroup& group = *beam.group;
    const std::size_t first = first_ray(search, group);
    write_singles(group, &search.space.singles[first]);
    add_numbers(search, group, &search.space.singles[first]);
    std::array<std::uint16_t, group_size> numbers;
    std::size_t count = 0;
    for (GroupMask rest = group.followed; rest != 0; rest &= rest - 1)
        numbers[count++] =
            static_cast<std::uint16_t>(first + static_cast<std::size_t>(std::countr_zero(rest)));
    RayStream& stream =
        start_stream(search, gathered.streams++, {numbers.data(), count}, beam.order, false);
    for (std::size_t i = 0; i < beam.size; ++i)
        stream.stack.push(beam.stack[i], stream.left);
    stream.stack.push(beam.next, stream.left);
}

/// Sets the rays that were gathered on their way, and follows all streams.
template <bool any, typename Tree>
HWY_INLINE void follow_gathered(const Search<Tree>& search, Gathered<Tree>& gathered) {
    for (std::size_t octant = 0; octant < octant_count; ++octant)
        for (std::size_t i = 0; i < gathered.counts[octant]; i += stream_size) {
            RayStream& stream = start_stream(
                search,
                gathered.streams++,
                {&gathered.of_octant[octant][i],
                 std::min(stream_size, gathered.counts[octant] - i)},
                octant,
                any);
            stream.stack.push(TreeChild::node(0), stream.left);
        }
    if (gathered.streams > 0)
        follow_streams<any>(search, search.space.streams.data(), gathered.streams);
}

/// Up to rays_at_once rays through the tree; returns in how many groups.
template <typename Tree>
HWY_INLINE std::size_t
follow_to_nearest(const Search<Tree>& search, std::span<const IndexRay> rays) {
    Workspace& space = search.space;
    space.doubtful.clear();
    std::size_t groups = 0;
    std::size_t beams = 0;
    Gathered<Tree> gathered;
    const auto follow = [&]() HWY_ATTR {
        for (std::uint32_t rest = follow_beams(search, beams); rest != 0; rest &= rest - 1)
            go_on_as_stream(
                search, space.beams[static_cast<std::size_t>(std::countr_zero(rest))], gathered);
        beams = 0;
    };
    for (std::size_t first = 0; first < rays.size(); first += group_size) {
        RayGroup& group = space.groups[groups++];
        fetch_rays(rays, first + group_size);
        start_group(
            search.tree, rays.subspan(first, std::min(group_size, rays.size() - first)), group);
        add_rows(search, group);
        if (std::popcount(group.followed) <= few_rays
            || !start_beam(group, stack_of(search, beams), space.beams[beams]))
            gather(search, group, gathered);
        else if (++beams == beams_at_once)
            follow();
    }
    if (beams > 0)
        follow();
    follow_gathered<false>(search, gathered);
    return groups;
}

/// The same for rays of which only is asked whether they meet anything.
template <typename Tree>
HWY_INLINE std::size_t follow_to_any(const Search<Tree>& search, std::span<const IndexRay> rays) {
    std::size_t groups = 0;
    Gathered<Tree> gathered;
    GatheredShafts shafts;
    for (std::size_t first = 0; first < rays.size(); first += group_size) {
        RayGroup& group = search.space.groups[groups++];
        fetch_rays(rays, first + group_size);
        start_group(
            search.tree, rays.subspan(first, std::min(group_size, rays.size() - first)), group);
        add_rows(search, group);
        if constexpr (Tree::shafts)
            if (gather_shaft(search, group, shafts))
                continue;
        gather(search, group, gathered);
    }
    if constexpr (Tree::shafts)
        follow_gathered(search, shafts);
    follow_gathered<true>(search, gathered);
    return groups;
}

/// The nearest hits of the rays. The tree has nodes.
template <typename Tree>
HWY_INLINE void search_nearest_in(
    const Tree& tree,
    std::span<const IndexRay> rays,
    std::span<typename Tree::Hit> hits,
    SearchCounts& counts) {
    const Search<Tree> search = {{tree}, workspace_of_this_thread(tree), counts};
    for (std::size_t first = 0; first < rays.size(); first += rays_at_once<Tree>) {
        const std::size_t count = std::min(rays_at_once<Tree>, rays.size() - first);
        const std::size_t groups = follow_to_nearest(search, rays.subspan(first, count));
        take_hits(search, groups, hits.subspan(first, count));
    }
}

/// Whether the rays meet anything. The tree has nodes.
template <typename Tree>
HWY_INLINE void search_any_in(
    const Tree& tree,
    std::span<const IndexRay> rays,
    std::span<std::uint8_t> met,
    SearchCounts& counts) {
    const Search<Tree> search = {{tree}, workspace_of_this_thread(tree), counts};
    for (std::size_t first = 0; first < rays.size(); first += rays_at_once<Tree>) {
        const std::size_t count = std::min(rays_at_once<Tree>, rays.size() - first);
        const std::size_t groups = follow_to_any(search, rays.subspan(first, count));
        take_met(search, groups, met.subspan(first, count));
    }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
