// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/mesh_crossing.h"
#include "vera/accel/mesh_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/mesh_search.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/mesh_leaves-inl.h"
#include "vera/accel/mesh_rays-inl.h"
#include "vera/accel/tree_children-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Groups that are searched for together, so that they can take steps in turn.
constexpr std::size_t groups_at_once = 2;
constexpr std::size_t rays_at_once = groups_at_once * group_size;

/// Rays that go alone at a time.
constexpr std::size_t alone_at_once = 2 * group_size;

/// No number of a Doubtful.
constexpr std::uint32_t no_doubtful = ~std::uint32_t{0};

/// A triangle that a ray may meet, of which single precision cannot tell.
struct Doubtful {
    std::uint32_t triangle = no_triangle;
    std::uint32_t before = no_doubtful; ///< the number of the same ray's one before
};

/// What a search holds; each thread keeps one.
struct Workspace {
    std::array<RayGroup, groups_at_once> groups;
    std::array<BeamWalk, groups_at_once> beams;
    std::array<RayWalk, alone_at_once> alone;
    std::size_t depth = 0;          ///< of a stack
    std::vector<TreeChild> waiting; ///< a stack for each ray, then for each group
    std::vector<WaitingGroup> waiting_groups;
    std::vector<Doubtful> doubtful;
};

/// Notes that the lane's ray may meet the triangle.
HWY_INLINE void doubt(
    std::vector<Doubtful>& all, RayGroup& group, std::size_t lane, std::uint32_t triangle) {
    const GroupMask bit = GroupMask{1} << lane;
    const std::uint32_t before = (group.in_doubt & bit) != 0 ? group.doubtful[lane] : no_doubtful;
    group.in_doubt |= bit;
    group.doubtful[lane] = static_cast<std::uint32_t>(all.size());
    all.push_back({triangle, before});
}

struct Search {
    const MeshTree& tree;
    Workspace& space;
    MeshQueryCounts& counts;
};

HWY_INLINE TreeChild* stack_of(const Search& search, std::size_t number) {
    return search.space.waiting.data() + number * search.space.depth;
}

HWY_INLINE const float* rows_of(const MeshTree& tree, const TreeChild& leaf) {
    return tree.leaves.data() + mesh_leaf_rows * leaf.first();
}

HWY_INLINE std::uint32_t
triangle_at(const MeshTree& tree, std::uint32_t leaf, std::uint32_t place) {
    const std::size_t size = place >> 8U;
    return std::bit_cast<std::uint32_t>(
        tree.leaves[mesh_leaf_rows * leaf + mesh_number_row * size + (place & 0xffU)]);
}

HWY_NOINLINE bool surely_meets(const MeshTree& tree, const MeshRay& ray, std::uint32_t triangle) {
    return crossing_with(tree.mesh, prepared_mesh_ray(ray), triangle).has_value();
}

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

/// Takes how the lanes' rays of the group meet triangle j of a leaf, which meeting(i) tells of those
/// from number i on.
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

/// What the lanes' rays of a beam do at a leaf.
template <bool any>
HWY_INLINE void
visit_leaf(const Search& search, const TreeChild& leaf, GroupMask lanes, BeamWalk& beam) {
    const Rays d;
    const float* const rows = rows_of(search.tree, leaf);
    RayGroup& group = *beam.group;
    const auto in_range = [&](std::size_t i, const auto& passing) HWY_ATTR {
        return meeting_triangle(
            d,
            passing,
            hn::Load(d, group.t_min.data() + i),
            hn::Load(d, group.limit.data() + i));
    };
    if (beam.one_origin) {
        SeenTriangles seen;
        std::uint32_t may = see_triangles(rows, leaf_size(leaf), beam, seen);
        if (may == 0)
            return;
        // More is known of what is near from where rays started than from where they end.
        const bool near_start = group.blur > 0 && leaf.near() > 0.25F * beam.limit;
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

/// Follows the beams down from the root, a step each in turn.
template <bool any>
HWY_NOINLINE void follow_beams(const Search& search, std::size_t count) {
    const MeshTree& tree = search.tree;
    std::uint32_t under_way = (std::uint32_t{1} << count) - 1;
    while (under_way != 0) {
        for (std::uint32_t rest = under_way; rest != 0; rest &= rest - 1) {
            const auto number = static_cast<std::size_t>(std::countr_zero(rest));
            BeamWalk& beam = search.space.beams[number];
            if (beam.next.is_block() != 0) {
                const float before = beam.limit;
                visit_leaf<any>(search, beam.next, beam.group->followed, beam);
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
}

/// So few rays go on alone.
constexpr int few_rays = 3;

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
        if (search.space.alone[numbers.number[lane]].walk.size == tree_width)
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

/// Follows a beam down from the root, with an eye on which of its rays meet a box. Where few are
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
    WaitingGroup next = {TreeChild::node(0), group.followed, 0};
    while (true) {
        if (next.lanes == 0
            || (std::popcount(next.lanes) <= few_rays
                && leave_for_later<any>(search, group, next, numbers, alone))) {
            // on to the next one
        } else if (next.child.is_block() != 0) {
            visit_leaf<any>(search, next.child, next.lanes, beam);
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

/// Up to rays_at_once rays through the tree; returns in how many groups.
template <bool any>
HWY_INLINE std::size_t search_rays(const Search& search, std::span<const MeshRay> rays) {
    Workspace& space = search.space;
    space.doubtful.clear();
    std::size_t groups = 0;
    std::size_t narrow = 0;
    std::size_t alone = 0;
    for (std::size_t first = 0; first < rays.size(); first += group_size) {
        if (alone + group_size > alone_at_once) {
            follow_alone<any>(search, alone);
            alone = 0;
        }
        RayGroup& group = space.groups[groups++];
        start_group(
            search.tree, rays.subspan(first, std::min(group_size, rays.size() - first)), group);
        BeamWalk& beam = space.beams[narrow];
        if (std::popcount(group.followed) > few_rays
            && start_beam(group, any, stack_of(search, alone_at_once + narrow), beam)) {
            if (beam.narrow)
                ++narrow;
            else
                follow_apart<any>(search, beam, alone);
            continue;
        }
        for (GroupMask rest = group.followed; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            RayWalk& ray = space.alone[alone];
            start_alone(group, lane, any, stack_of(search, alone++), ray);
            ray.walk.stack[ray.walk.size++] = TreeChild::node(0);
        }
    }
#ifndef SKIP_FOLLOW
    if (narrow > 0)
        follow_beams<any>(search, narrow);
#endif
    if (alone > 0)
        follow_alone<any>(search, alone);
    return groups;
}

using Doubles = hn::CappedTag<double, group_size>;

template <typename D>
HWY_INLINE hn::Vec<D> dot_in_order(const Vector<hn::Vec<D>>& a, const Vector<hn::Vec<D>>& b, D) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <typename D>
HWY_INLINE Vector<hn::Vec<D>>
cross_in_order(const Vector<hn::Vec<D>>& a, const Vector<hn::Vec<D>>& b, D) {
    return {
        hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
        hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
        hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// The corners of a triangle for each lane.
using CornerRows = std::array<std::array<GroupRow<float>, 3>, 3>;

struct HitRows {
    GroupRow<float> t;
    GroupRow<float> u;
    GroupRow<float> v;
};

/// mesh_hit() of plane_crossing(), to the bit: what is multiplied here by a power of two is divided
/// by it. That of a MeshHit that is none for lanes that do not meet their triangles.
HWY_INLINE void
cross_planes(const RayGroup& group, const CornerRows& corners, GroupMask met, HitRows& hits) {
    const Doubles d;
    const MeshHit none;
    const hn::Rebind<float, Doubles> f;
    using V = hn::Vec<Doubles>;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const auto row = [&](const GroupRow<float>& values)
                             HWY_ATTR { return hn::PromoteTo(d, hn::Load(f, values.data() + i)); };
        const auto vector = [&](const auto& rows) HWY_ATTR {
            return Vector<V>{row(rows[0]), row(rows[1]), row(rows[2])};
        };
        const Vector<V> a = vector(corners[0]);
        const Vector<V> direction = vector(group.direction);
        const Vector<V> e = difference(vector(corners[1]), a);
        const Vector<V> g = difference(vector(corners[2]), a);
        const Vector<V> to_a = difference(a, vector(group.origin));
        const Vector<V> normal = cross_in_order(e, g, d);
        const Vector<V> moment = cross_in_order(to_a, direction, d);
        const V one = hn::Set(d, 1);
        const V per_speed = hn::Div(one, dot_in_order(normal, direction, d));
        const std::uint8_t bits[8] = {static_cast<std::uint8_t>(met >> i)};
        const auto counts = hn::LoadMaskBits(f, bits);
        const auto part = [&](V value) HWY_ATTR {
            return hn::IfThenElseZero(
                counts,
                hn::DemoteTo(f, hn::Add(hn::Min(hn::Max(value, hn::Zero(d)), one), hn::Zero(d))));
        };
        const V t = hn::Mul(dot_in_order(normal, to_a, d), per_speed);
        hn::Store(
            hn::IfThenElse(
                counts,
                hn::Add(hn::DemoteTo(f, hn::Mul(t, row(group.per_t_scale))), hn::Zero(f)),
                hn::Set(f, none.t)),
            f,
            hits.t.data() + i);
        hn::Store(part(hn::Mul(dot_in_order(moment, g, d), per_speed)), f, hits.u.data() + i);
        hn::Store(
            part(hn::Neg(hn::Mul(dot_in_order(moment, e, d), per_speed))), f, hits.v.data() + i);
    }
}

/// The lanes that surely meet something.
HWY_INLINE GroupMask lanes_with_place(const RayGroup& group) {
    const hn::RebindToUnsigned<Rays> d;
    GroupMask lanes = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
        lanes |= bits_of(d, hn::Ne(hn::Load(d, group.place.data() + i), hn::Set(d, no_place))) << i;
    return lanes;
}

/// The hits of what was surely met, and nothing elsewhere.
HWY_INLINE void take_sure_hits(const MeshTree& tree, const RayGroup& group, MeshHit* hits) {
    const Rays d;
    const GroupMask met = lanes_with_place(group);
    if (met == 0) {
        std::fill(hits, hits + group.rays.size(), MeshHit{});
        return;
    }
    CornerRows corners;
    GroupRow<float> triangles; // the bits of their numbers
    for (GroupMask rest = met; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const std::uint32_t place = group.place[lane];
        const std::size_t size = place >> 8U;
        const float* const rows =
            tree.leaves.data() + mesh_leaf_rows * group.leaf[lane] + (place & 0xffU);
        corners[0][0][lane] = rows[0];
        corners[0][1][lane] = rows[size];
        corners[0][2][lane] = rows[2 * size];
        corners[1][0][lane] = rows[3 * size];
        corners[1][1][lane] = rows[4 * size];
        corners[1][2][lane] = rows[5 * size];
        corners[2][0][lane] = rows[6 * size];
        corners[2][1][lane] = rows[7 * size];
        corners[2][2][lane] = rows[8 * size];
        triangles[lane] = rows[mesh_number_row * size];
    }
    HitRows found;
    cross_planes(group, corners, met, found);
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const auto numbers = hn::Load(d, triangles.data() + i);
        const auto none = hn::BitCast(d, hn::Set(hn::RebindToUnsigned<Rays>(), no_triangle));
        hn::Store(hn::IfThenElse(in_group(d, met, i), numbers, none), d, triangles.data() + i);
    }
    if (group.rays.size() < group_size) {
        for (std::size_t lane = 0; lane < group.rays.size(); ++lane)
            hits[lane] = {
                found.t[lane],
                std::bit_cast<std::uint32_t>(triangles[lane]),
                found.u[lane],
                found.v[lane]};
        return;
    }
    static_assert(sizeof(MeshHit) == 4 * sizeof(float));
    for (std::size_t lane = 0; lane < group_size; lane += 4)
        transpose(
            {&found.t[lane], &triangles[lane], &found.u[lane], &found.v[lane]},
            {&hits[lane].t, &hits[lane + 1].t, &hits[lane + 2].t, &hits[lane + 3].t});
}

/// The hit of a ray that may meet more than it surely meets, if it surely meets anything.
HWY_NOINLINE MeshHit decide_doubtful(
    const Search& search,
    const MeshRay& ray,
    std::uint32_t leaf,
    std::uint32_t place,
    std::uint32_t last_doubtful) {
    const PreparedRay prepared = prepared_mesh_ray(ray);
    NearestCrossing nearest;
    const auto consider = [&](std::uint32_t triangle) {
        if (const auto crossing = crossing_with(search.tree.mesh, prepared, triangle))
            nearest.add(*crossing, triangle);
    };
    if (place != no_place)
        consider(triangle_at(search.tree, leaf, place));
    for (std::uint32_t i = last_doubtful; i != no_doubtful; i = search.space.doubtful[i].before)
        consider(search.space.doubtful[i].triangle);
    return nearest.hit();
}

/// The hits of the groups that were searched for.
HWY_INLINE void take_hits(const Search& search, std::size_t groups, std::span<MeshHit> hits) {
    const Workspace& space = search.space;
    for (std::size_t i = 0; i < groups; ++i) {
        const RayGroup& group = space.groups[i];
        MeshHit* const of_group = hits.data() + i * group_size;
        take_sure_hits(search.tree, group, of_group);
        for (GroupMask rest = group.in_doubt; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            of_group[lane] = decide_doubtful(
                search,
                group.rays[lane],
                group.leaf[lane],
                group.place[lane],
                group.doubtful[lane]);
        }
        for (std::size_t lane = 0; lane < group.rays.size(); ++lane)
            if ((group.followed >> lane & 1U) == 0)
                of_group[lane] = nearest_plainly(search.tree, group.rays[lane]);
    }
}

HWY_INLINE void take_met(const Search& search, std::size_t groups, std::span<std::uint8_t> met) {
    for (std::size_t i = 0; i < groups; ++i) {
        const RayGroup& group = search.space.groups[i];
        std::uint8_t* const of_group = met.data() + i * group_size;
        for (std::size_t lane = 0; lane < group.rays.size(); ++lane) {
            of_group[lane] = (group.met >> lane & 1U) != 0 ? 1 : 0;
            if ((group.followed >> lane & 1U) == 0)
                of_group[lane] = meets_any_plainly(search.tree, group.rays[lane]) ? 1 : 0;
        }
    }
}

/// Follows one ray down from the root; true when it is only asked whether it meets anything, and it
/// does.
template <bool any>
HWY_INLINE bool follow_single(const Search& search, RayWalk& ray) {
    const MeshTree& tree = search.tree;
    Walk& walk = ray.walk;
    TreeChild next = TreeChild::node(0);
    while (true) {
        if (next.is_block() != 0) {
            const float before = ray.limit;
            if (visit_leaf<any>(search, next, ray))
                return true;
            if (ray.limit < before)
                walk.size = drop_behind(walk.stack, walk.size, ray.limit);
        } else {
            ++search.counts.nodes;
            add_met_children(tree.nodes[next.first()], ray.limit, walk);
        }
        if (walk.size == 0)
            return false;
        next = walk.stack[--walk.size];
    }
}

/// The hit of a ray that was followed alone.
HWY_INLINE MeshHit hit_of_single(const Search& search, const RayWalk& ray, float per_t_scale) {
    const MeshTree& tree = search.tree;
    const RayGroup& group = *ray.group;
    if (HWY_UNLIKELY(group.in_doubt != 0))
        return decide_doubtful(search, *ray.given, ray.leaf, ray.place, group.doubtful[0]);
    if (ray.place == no_place)
        return {};
    const std::size_t size = ray.place >> 8U;
    const float* const rows = tree.leaves.data() + mesh_leaf_rows * ray.leaf + (ray.place & 0xffU);
    const auto corner = [&](std::size_t number) {
        return in_double(
            {rows[3 * number * size],
             rows[(3 * number + 1) * size],
             rows[(3 * number + 2) * size]});
    };
    // As cross_planes() does it.
    MeshCrossing crossing = plane_crossing(
        in_double({ray.origin[0], ray.origin[1], ray.origin[2]}),
        in_double({ray.direction[0], ray.direction[1], ray.direction[2]}),
        corner(0),
        corner(1),
        corner(2));
    crossing.t *= static_cast<double>(per_t_scale);
    return mesh_hit(crossing, std::bit_cast<std::uint32_t>(rows[mesh_number_row * size]));
}

Workspace& workspace_of_this_thread(const MeshTree& tree) {
    thread_local Workspace space;
    const std::size_t depth = waiting_depth(tree.statistics.levels);
    if (space.depth < depth) {
        space.waiting.resize((alone_at_once + groups_at_once) * depth);
        space.waiting_groups.resize(depth);
        space.depth = depth;
    }
    return space;
}

void search_nearest_kernel(
    const MeshTree& tree,
    std::span<const MeshRay> rays,
    std::span<MeshHit> hits,
    MeshQueryCounts& counts) {
    const Search search = {tree, workspace_of_this_thread(tree), counts};
    if (rays.size() == 1) {
        search.space.doubtful.clear();
        RayWalk& ray = search.space.alone.front();
        float per_t_scale = 1;
        ray.group = &search.space.groups.front();
        ray.group->in_doubt = 0;
        if (start_single(tree, rays[0], false, stack_of(search, 0), ray, per_t_scale)) {
            follow_single<false>(search, ray);
            hits[0] = hit_of_single(search, ray, per_t_scale);
        } else {
            hits[0] = nearest_plainly(tree, rays[0]);
        }
        return;
    }
    for (std::size_t first = 0; first < rays.size(); first += rays_at_once) {
        const std::size_t count = std::min(rays_at_once, rays.size() - first);
        const std::size_t groups = search_rays<false>(search, rays.subspan(first, count));
        take_hits(search, groups, hits.subspan(first, count));
    }
}

void search_any_kernel(
    const MeshTree& tree,
    std::span<const MeshRay> rays,
    std::span<std::uint8_t> met,
    MeshQueryCounts& counts) {
    const Search search = {tree, workspace_of_this_thread(tree), counts};
    if (rays.size() == 1) {
        RayWalk& ray = search.space.alone.front();
        float per_t_scale = 1;
        const bool meets = start_single(tree, rays[0], true, stack_of(search, 0), ray, per_t_scale)
            ? follow_single<true>(search, ray)
            : meets_any_plainly(tree, rays[0]);
        met[0] = meets ? 1 : 0;
        return;
    }
    for (std::size_t first = 0; first < rays.size(); first += rays_at_once) {
        const std::size_t count = std::min(rays_at_once, rays.size() - first);
        const std::size_t groups = search_rays<true>(search, rays.subspan(first, count));
        take_met(search, groups, met.subspan(first, count));
    }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(search_nearest_kernel);
HWY_EXPORT(search_any_kernel);

void search_nearest(
    const MeshTree& tree,
    std::span<const MeshRay> rays,
    std::span<MeshHit> hits,
    MeshQueryCounts& counts) {
    if (tree.nodes.empty()) {
        std::fill(hits.begin(), hits.end(), MeshHit{});
        return;
    }
    HWY_DYNAMIC_DISPATCH(search_nearest_kernel)(tree, rays, hits, counts);
}

void search_any(
    const MeshTree& tree,
    std::span<const MeshRay> rays,
    std::span<std::uint8_t> met,
    MeshQueryCounts& counts) {
    if (tree.nodes.empty()) {
        std::fill(met.begin(), met.end(), std::uint8_t{0});
        return;
    }
    HWY_DYNAMIC_DISPATCH(search_any_kernel)(tree, rays, met, counts);
}

} // namespace vera::detail

#endif
