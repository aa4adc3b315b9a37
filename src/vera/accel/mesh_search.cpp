// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/mesh_crossing.h"
#include "vera/accel/mesh_tree.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/mesh_search.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/mesh_hits-inl.h"
#include "vera/accel/mesh_walks-inl.h"
#include "vera/accel/mesh_workspace-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Up to rays_at_once rays through the tree; returns in how many groups.
template <bool any>
HWY_INLINE std::size_t search_rays(const Search& search, std::span<const MeshRay> rays) {
    Workspace& space = search.space;
    space.doubtful.clear();
    std::size_t groups = 0;
    std::size_t narrow = 0;
    std::size_t alone = 0;
    for (std::size_t first = 0; first < rays.size(); first += group_size) {
        RayGroup& group = space.groups[groups++];
        start_group(
            search.tree, rays.subspan(first, std::min(group_size, rays.size() - first)), group);
        BeamWalk& beam = space.beams[narrow];
        if (std::popcount(group.followed) > few_rays
            && start_beam(group, any, stack_of(search, rays_at_once + narrow), beam)) {
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
    if (narrow > 0)
        for (std::uint32_t rest = follow_beams<any>(search, narrow); rest != 0; rest &= rest - 1)
            follow_apart<any>(
                search, space.beams[static_cast<std::size_t>(std::countr_zero(rest))], alone);
    if (alone > 0)
        follow_alone<any>(search, alone);
    return groups;
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
    const std::size_t depth = waiting_depth(tree.statistics.levels) + most_left;
    if (space.depth < depth) {
        space.waiting.resize((rays_at_once + groups_at_once) * depth);
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
