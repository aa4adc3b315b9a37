// SPDX-License-Identifier: Apache-2.0
// Ways through the tree of a mesh: see mesh_search.cpp. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_MESH_WALKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_MESH_WALKS_INL_H
#undef VERA_ACCEL_MESH_WALKS_INL_H
#else
#define VERA_ACCEL_MESH_WALKS_INL_H
#endif

#include "vera/accel/mesh_leaves-inl.h"
#include "vera/accel/mesh_workspace-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Takes what is known of how the beam's rays from i on meet triangle j of a leaf.
template <bool any>
HWY_INLINE void take_meeting(
    const Search& search,
    const TreeChild& leaf,
    std::size_t j,
    RayGroup& group,
    GroupMask lanes,
    std::size_t i,
    const MeshMeeting<Rays>& meeting) {
    const Rays d;
    const GroupMask left = any ? lanes & ~group.met : lanes;
    const auto in_search = in_group(d, left, i);
    const auto sure = hn::And(meeting.sure, in_search);
    const auto may = hn::And(meeting.may, in_search);
    GroupMask doubtful = 0;
    if constexpr (any) {
        const GroupMask met = bits_of(d, sure) << i;
        doubtful = (bits_of(d, may) << i) & ~met;
        group.met |= met;
        hn::BlendedStore(hn::Set(d, -1), in_group(d, met, i), d, group.limit.data() + i);
    } else {
        const hn::RebindToUnsigned<Rays> du;
        const auto nearer = hn::And(sure, hn::Lt(meeting.far, hn::Load(d, group.near.data() + i)));
        const auto limit = hn::Load(d, group.limit.data() + i);
        hn::Store(
            hn::IfThenElse(sure, hn::Min(limit, meeting.far), limit), d, group.limit.data() + i);
        hn::BlendedStore(meeting.near, nearer, d, group.near.data() + i);
        const auto nearer_ints = hn::RebindMask(du, nearer);
        hn::BlendedStore(
            hn::Set(du, static_cast<std::uint32_t>(leaf.first())),
            nearer_ints,
            du,
            group.leaf.data() + i);
        hn::BlendedStore(
            hn::Set(du, place_in_leaf(leaf_size(leaf), j)),
            nearer_ints,
            du,
            group.place.data() + i);
        doubtful = bits_of(d, hn::AndNot(nearer, may)) << i;
    }
    if (HWY_LIKELY(doubtful == 0))
        return;
    const std::uint32_t triangle = triangle_at(
        search.tree, static_cast<std::uint32_t>(leaf.first()), place_in_leaf(leaf_size(leaf), j));
    for (; doubtful != 0; doubtful &= doubtful - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(doubtful));
        if constexpr (any) {
            if (surely_meets(search.tree, group.rays[lane], triangle)) {
                group.met |= GroupMask{1} << lane;
                group.limit[lane] = -1;
            }
        } else {
            doubt(search.space.doubtful, group, lane, triangle);
        }
    }
}

/// Takes how the lanes' rays of the group meet triangle j of a leaf, which meeting(i) tells of
/// those from number i on.
template <bool any, typename MeetingAt>
HWY_INLINE void meet_triangle(
    const Search& search,
    const TreeChild& leaf,
    std::size_t j,
    RayGroup& group,
    GroupMask lanes,
    const MeetingAt& meeting) {
    const Rays d;
    ++search.counts.triangles;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
        take_meeting<any>(search, leaf, j, group, lanes, i, meeting(i));
}

/// What the lanes' rays of a beam do at a leaf, which they enter not before near.
template <bool any>
HWY_INLINE void visit_leaf(
    const Search& search, const TreeChild& leaf, float near, GroupMask lanes, BeamWalk& beam) {
    const Rays d;
    const float* const rows = rows_of(search.tree, leaf);
    RayGroup& group = *beam.group;
    const auto in_range = [&](std::size_t i, const auto& passing) HWY_ATTR {
        return meeting_triangle(
            d, passing, hn::Load(d, group.t_min.data() + i), hn::Load(d, group.limit.data() + i));
    };
    if (beam.one_origin) {
        SeenTriangles seen;
        std::uint32_t may = see_triangles(rows, leaf_size(leaf), beam, seen);
        if (may == 0)
            return;
        // More is known of what is near from where rays started than from where they end.
        const bool near_start = group.blur > 0 && near > 0.25F * beam.limit;
        for (; may != 0; may &= may - 1) {
            const auto j = static_cast<std::size_t>(std::countr_zero(may));
            meet_triangle<any>(search, leaf, j, group, lanes, [&](std::size_t i) HWY_ATTR {
                return near_start ? meeting_from_start(d, group, i, rows, leaf_size(leaf), j)
                                  : in_range(i, passing_seen(d, group, i, seen, j));
            });
        }
    } else {
        StoredTriangles stored;
        store_triangles(rows, leaf_size(leaf), stored);
        for (std::size_t j = 0; j < leaf_size(leaf); ++j)
            meet_triangle<any>(search, leaf, j, group, lanes, [&](std::size_t i) HWY_ATTR {
                return in_range(i, passing_stored(d, group, i, stored, j));
            });
    }
    beam.limit = largest_limit(group);
}

/// What a ray that goes alone does at a leaf; true when it is only asked whether it meets anything,
/// and it does.
template <bool any>
HWY_INLINE bool visit_leaf(const Search& search, const TreeChild& leaf, RayWalk& ray) {
    const Triangles d;
    const std::size_t size = leaf_size(leaf);
    const float* const rows = rows_of(search.tree, leaf);
    search.counts.triangles += size;
    std::uint32_t may = 0;
    std::uint32_t sure = 0;
    alignas(64) float near[mesh_leaf_size];
    alignas(64) float far[mesh_leaf_size];
    const auto origin = same_for_all(d, ray.origin);
    const auto direction = same_for_all(d, ray.direction);
    for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
        const auto meeting = meeting_triangle(
            d,
            passing_triangle(
                d, origin, direction, ray.direction_size, ray.blur, sides_at(d, rows, size, i)),
            hn::Set(d, ray.t_min),
            hn::Set(d, ray.limit));
        may |= bits_of(d, meeting.may) << i;
        sure |= bits_of(d, meeting.sure) << i;
        hn::Store(meeting.near, d, near + i);
        hn::Store(meeting.far, d, far + i);
    }
    may &= (std::uint32_t{1} << size) - 1;
    if constexpr (any)
        if ((sure & may) != 0)
            return true;
    const auto first = static_cast<std::uint32_t>(leaf.first());
    for (; may != 0; may &= may - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(may));
        if constexpr (!any) {
            if ((sure >> j & 1U) != 0) {
                ray.limit = std::min(ray.limit, far[j]);
                if (far[j] < ray.near) {
                    ray.near = near[j];
                    ray.leaf = first;
                    ray.place = place_in_leaf(size, j);
                    continue;
                }
            }
        }
        const std::uint32_t triangle = triangle_at(search.tree, first, place_in_leaf(size, j));
        if constexpr (any) {
            if (surely_meets(search.tree, *ray.given, triangle))
                return true;
        } else {
            doubt(search.space.doubtful, *ray.group, ray.lane, triangle);
        }
    }
    return false;
}

template <typename Walker>
HWY_INLINE bool move_on(Walker& walker) {
    if (walker.size == 0)
        return false;
    walker.next = walker.stack[--walker.size];
    return true;
}

HWY_INLINE void fetch(const MeshTree& tree, const TreeChild& child) {
    fetch(tree.nodes.data(), tree.leaves.data(), mesh_leaf_rows * sizeof(float), child);
}

/// Where a beam has taken so many steps, what it meets is smaller than the space between its rays.
constexpr std::uint32_t most_steps = 48;

/// Follows the beams down from the root, a step each in turn; returns the numbers, as bits, of
/// those that have taken too many to go on like this.
template <bool any>
HWY_NOINLINE std::uint32_t follow_beams(const Search& search, std::size_t count) {
    const MeshTree& tree = search.tree;
    std::uint32_t under_way = (std::uint32_t{1} << count) - 1;
    std::uint32_t fanned_out = 0;
    while (under_way != 0) {
        for (std::uint32_t rest = under_way; rest != 0; rest &= rest - 1) {
            const auto number = static_cast<std::size_t>(std::countr_zero(rest));
            BeamWalk& beam = search.space.beams[number];
            if (HWY_UNLIKELY(++beam.steps > most_steps)) {
                fanned_out |= std::uint32_t{1} << number;
                under_way &= ~(std::uint32_t{1} << number);
                continue;
            }
            if (beam.next.is_block() != 0) {
                const float before = beam.limit;
                visit_leaf<any>(search, beam.next, beam.next.near(), beam.group->followed, beam);
                if (beam.limit < before)
                    beam.size = beam.limit < 0 ? 0 : drop_behind(beam.stack, beam.size, beam.limit);
            } else {
                ++search.counts.nodes;
                add_met_children(tree.nodes[beam.next.first()], beam);
            }
            if (move_on(beam))
                fetch(tree, beam.next);
            else
                under_way &= ~(std::uint32_t{1} << number);
        }
    }
    return fanned_out;
}

/// So few rays go on alone.
constexpr int few_rays = 6;

/// So much may be left for each of them.
constexpr std::uint32_t most_left = 4 * tree_width;

/// Which of a group's rays go alone already, and as which number.
struct AloneNumbers {
    std::array<std::uint8_t, group_size> number = {};
    GroupMask lanes = 0;
};

/// Leaves a child for each of the lanes' rays to visit alone later; false when too much waits for
/// one of them.
template <bool any>
HWY_INLINE bool leave_for_later(
    const Search& search,
    RayGroup& group,
    const WaitingGroup& left,
    AloneNumbers& numbers,
    std::size_t& alone) {
    for (GroupMask rest = left.lanes & numbers.lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        if (search.space.alone[numbers.number[lane]].walk.size == most_left)
            return false;
    }
    for (GroupMask rest = left.lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        if ((numbers.lanes >> lane & 1U) == 0) {
            start_alone(group, lane, any, stack_of(search, alone), search.space.alone[alone]);
            numbers.number[lane] = static_cast<std::uint8_t>(alone++);
        }
        Walk& walk = search.space.alone[numbers.number[lane]].walk;
        // A way along an axis is less than twice as long as t here.
        walk.stack[walk.size++] = TreeChild::waiting(left.child, 0.5F * left.near);
    }
    numbers.lanes |= left.lanes;
    return true;
}

/// The lanes whose limits are not before a way along the axis.
HWY_INLINE GroupMask reaching(const RayGroup& group, float near) {
    const Rays d;
    GroupMask lanes = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
        lanes |=
            bits_of(
                d,
                hn::Ge(
                    hn::Mul(
                        hn::Load(d, group.limit.data() + i), hn::Load(d, group.largest.data() + i)),
                    hn::Set(d, near * (1 - 0x1p-20F))))
            << i;
    return lanes;
}

/// Follows a beam on from where it is, with an eye on which of its rays meet a box. Where few are
/// left, each is left to go on alone: those are added to the ones that go alone.
template <bool any>
HWY_NOINLINE void follow_apart(const Search& search, BeamWalk& beam, std::size_t& alone) {
    const MeshTree& tree = search.tree;
    RayGroup& group = *beam.group;
    BoxTestedGroup tested;
    fill_offsets(group, tested);
    AloneNumbers numbers;
    const std::size_t first_alone = alone;
    WaitingGroup* const stack = search.space.waiting_groups.data();
    std::size_t size = 0;
    for (std::uint32_t i = 0; i < beam.size; ++i)
        stack[size++] = {beam.stack[i], group.followed, beam.stack[i].near()};
    WaitingGroup next = {beam.next, group.followed & ~group.met, 0};
    while (true) {
        if (next.lanes == 0
            || (std::popcount(next.lanes) <= few_rays
                && leave_for_later<any>(search, group, next, numbers, alone))) {
            // on to the next one
        } else if (next.child.is_block() != 0) {
            visit_leaf<any>(search, next.child, next.near, next.lanes, beam);
        } else {
            ++search.counts.nodes;
            size += put_met_children(
                tree.nodes[next.child.first()], beam, tested, next.lanes, stack + size);
            if (size > 0)
                fetch(tree, stack[size - 1].child);
        }
        if (size == 0)
            break;
        next = stack[--size];
        next.lanes &= reaching(group, next.near) & ~group.met;
    }
    for (std::size_t i = first_alone; i < alone; ++i) {
        RayWalk& ray = search.space.alone[i];
        ray.limit = group.limit[ray.lane];
        ray.near = group.near[ray.lane];
        ray.leaf = group.leaf[ray.lane];
        ray.place = group.place[ray.lane];
        ray.walk.size = drop_behind(ray.walk.stack, ray.walk.size, ray.limit);
        // The first that was left is to be the next.
        std::reverse(ray.walk.stack, ray.walk.stack + ray.walk.size);
    }
}

/// Follows the rays that go alone down from the root, a step each in turn, so that what each needs
/// next arrives while the others work.
template <bool any>
HWY_NOINLINE void follow_alone(const Search& search, std::size_t count) {
    const MeshTree& tree = search.tree;
    std::uint64_t at_node = 0;
    std::uint64_t at_leaf = 0;
    const auto go_on = [&](std::size_t number, const TreeChild& next) HWY_ATTR {
        fetch(tree, next);
        const auto is_leaf = static_cast<std::uint64_t>(next.is_block());
        at_leaf |= is_leaf << number;
        at_node |= (1 - is_leaf) << number;
    };
    for (std::size_t i = 0; i < count; ++i) {
        RayWalk& ray = search.space.alone[i];
        if ((ray.group->met >> ray.lane & 1U) == 0 && move_on(ray.walk))
            go_on(i, ray.walk.next);
    }
    while ((at_node | at_leaf) != 0) {
        std::uint64_t rest = at_node;
        at_node = 0;
        search.counts.nodes += static_cast<std::uint64_t>(std::popcount(rest));
        for (; rest != 0; rest &= rest - 1) {
            const auto number = static_cast<std::size_t>(std::countr_zero(rest));
            RayWalk& ray = search.space.alone[number];
            add_met_children(tree.nodes[ray.walk.next.first()], ray.limit, ray.walk);
            if (move_on(ray.walk))
                go_on(number, ray.walk.next);
        }
        rest = at_leaf;
        at_leaf = 0;
        for (; rest != 0; rest &= rest - 1) {
            const auto number = static_cast<std::size_t>(std::countr_zero(rest));
            RayWalk& ray = search.space.alone[number];
            const float before = ray.limit;
            if (visit_leaf<any>(search, ray.walk.next, ray)) {
                ray.group->met |= GroupMask{1} << ray.lane;
                continue;
            }
            if (ray.limit < before)
                ray.walk.size = drop_behind(ray.walk.stack, ray.walk.size, ray.limit);
            if (move_on(ray.walk))
                go_on(number, ray.walk.next);
        }
    }
    if constexpr (!any)
        for (std::size_t i = 0; i < count; ++i) {
            const RayWalk& ray = search.space.alone[i];
            ray.group->leaf[ray.lane] = ray.leaf;
            ray.group->place[ray.lane] = ray.place;
        }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
