// SPDX-License-Identifier: Apache-2.0
// The way of one ray alone through a tree of boxes: see float_search-inl.h. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_FLOAT_ALONE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_ALONE_INL_H
#undef VERA_ACCEL_FLOAT_ALONE_INL_H
#else
#define VERA_ACCEL_FLOAT_ALONE_INL_H
#endif

#include "vera/accel/float_hits-inl.h"
#include "vera/accel/float_walks-inl.h"
#include "vera/accel/float_workspace-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What waits for one ray; the next one is on top. Where it is only asked whether it meets
/// anything, nothing that waits is ever behind the limit.
template <bool any>
struct SingleStack {
    TreeChild* begin;
    TreeChild* end;

    /// Takes the next one that is not behind the limit; false when there is none.
    HWY_INLINE bool take(float limit, TreeChild& next) {
        while (end != begin) {
            next = *--end;
            if (any || next.near() <= limit)
                return true;
        }
        return false;
    }
};

/// What one ray alone is searched for with: a Workspace only where there is doubt.
template <typename Tree>
struct AloneSearch : TreeSearch<Tree> {
    Workspace* space = nullptr;
    std::uint32_t last_doubtful = no_doubtful;
};

/// Notes that the ray may meet the element at this place of this leaf.
template <typename Tree>
HWY_NOINLINE void
doubt(AloneSearch<Tree>& search, const SingleRay&, std::uint32_t leaf, std::uint32_t place) {
    if (search.space == nullptr) {
        search.space = &workspace_of_this_thread(search.tree);
        search.space->doubtful.clear();
    }
    std::vector<Doubtful>& all = search.space->doubtful;
    all.push_back({leaf, place, search.last_doubtful});
    search.last_doubtful = static_cast<std::uint32_t>(all.size() - 1);
}

/// Whether double precision says that the ray meets the element at this place of this leaf.
template <typename Tree>
HWY_NOINLINE bool surely_meets(
    const AloneSearch<Tree>& search,
    const SingleRay& ray,
    std::uint32_t leaf,
    std::uint32_t place) {
    return !ruled_out(search, ray, leaf, place)
        && surely_meets(search.tree, *ray.given, leaf, place);
}

/// What the ray does at a leaf; true when it is only asked whether it meets anything, and it does.
template <bool any, typename Tree>
HWY_INLINE bool visit_leaf(AloneSearch<Tree>& search, const TreeChild& leaf, SingleRay& ray) {
    const LeafLanes d;
    const std::size_t size = leaf_size(leaf);
    const float* const rows = rows_of(search.tree, leaf);
    for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
        // The same twice, which is computed once: as a variable, it would go through memory.
        const auto elements = [&]() HWY_ATTR { return elements_at(search, d, rows, size, i); };
        // Rays that ask for anything mostly start on a face, whose outline they pass through.
        if constexpr (!any)
            if ((passed_through(elements(), ray) & ((std::uint32_t{1} << (size - i)) - 1)) == 0)
                continue;
        if (take_meetings<any>(search, leaf, i, meeting_single(elements(), ray), ray))
            return true;
    }
    return false;
}

/// Whether the ray starts near the one that this thread was asked about before: then it mostly goes
/// the same ways at first, which are foreseen. What else is foreseen wrongly costs more than it
/// brings.
HWY_INLINE bool starts_near_last(const SingleRay& ray) {
    constexpr float near = 0x1p-6F;
    thread_local std::array<float, 3> last = {};
    float apart = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        apart = std::max(apart, std::abs(ray.origin[axis] - last[axis]));
        last[axis] = ray.origin[axis];
    }
    return apart < near;
}

// Where a ray goes on from a node of which it meets some children, as bits; false when nothing is
// left. With jumps, which the processor follows before it knows, it has the memory of what is next
// under way. Of most nodes one child is met, which need not wait on the stack.

/// At the first one.
HWY_INLINE bool go_to_first(
    const WideNode& node,
    std::uint32_t met,
    bool foresees,
    SingleStack<true>& stack,
    TreeChild& next) {
    if (met == 0)
        return stack.take(0, next);
    const auto first = static_cast<std::size_t>(std::countr_zero(met));
    next = node.children[foresees ? foreseen(first) : first];
    std::uint32_t others = met & (met - 1);
    stack.end += std::popcount(others);
    for (TreeChild* top = stack.end; others != 0; others &= others - 1)
        *--top = node.children[static_cast<std::size_t>(std::countr_zero(others))];
    return true;
}

/// At the nearest one; near_at and far_at as in put_met_children().
template <typename Tree, typename NearAt, typename FarAt>
HWY_INLINE bool go_to_nearest(
    const Tree& tree,
    const WideNode& node,
    std::uint32_t met,
    std::size_t octant,
    bool foresees,
    const NearAt& near_at,
    const FarAt& far_at,
    float limit,
    SingleStack<false>& stack,
    TreeChild& next) {
    // One jump for all that there may be: none, several, or which one.
    constexpr std::size_t none = tree_width;
    constexpr std::size_t several = tree_width + 1;
    const auto first = static_cast<std::size_t>(std::countr_zero(met | 1U << none));
    std::size_t way = (met & (met - 1)) != 0 ? several : first;
    if (foresees)
        way = foreseen(way);
    if (way == none)
        return stack.take(limit, next);
    if (way != several) {
        next = node.children[way];
        return true;
    }
    const PutChildren put = put_met_children(node, octant, near_at, far_at, stack.end);
    next = node.children[foresees ? foreseen(put.first) : put.first];
    stack.end += put.count - 1;
    fetch(tree, stack.end[-1]);
    return true;
}

/// Follows one ray of an octant down from the root; true when it is only asked whether it meets
/// anything, and it does.
template <bool any, typename Tree>
HWY_INLINE bool
follow_single(AloneSearch<Tree>& search, std::size_t octant, bool foresees, SingleRay& ray) {
    const Tree& tree = search.tree;
    const Children d;
    const auto all = [&](float number) HWY_ATTR { return hn::Set(d, number); };
    // As integers, numbers have the same order unless both are negative, which does not matter
    // where they are compared with what is not; and which is larger is sooner known.
    const hn::RebindToSigned<Children> di;
    const auto bits = [&](hn::Vec<Children> numbers) HWY_ATTR { return hn::BitCast(di, numbers); };
    const auto inverse_x = all(ray.inverse[0]);
    const auto inverse_y = all(ray.inverse[1]);
    const auto inverse_z = all(ray.inverse[2]);
    const auto near_x = all(ray.near_offset[0]);
    const auto near_y = all(ray.near_offset[1]);
    const auto near_z = all(ray.near_offset[2]);
    const auto far_x = all(ray.far_offset[0]);
    const auto far_y = all(ray.far_offset[1]);
    const auto far_z = all(ray.far_offset[2]);
    const WideNode* const nodes = tree.nodes.data();
    // Those of the root; where the others' are follows by one sum from a node's number.
    const auto planes_at = [&](std::size_t j) {
        return reinterpret_cast<const char*>(nodes[0].planes[0].data() + plane_places[octant][j]);
    };
    const char* const planes_near_x = planes_at(0);
    const char* const planes_near_y = planes_at(1);
    const char* const planes_near_z = planes_at(2);
    const char* const planes_far_x = planes_at(3);
    const char* const planes_far_y = planes_at(4);
    const char* const planes_far_z = planes_at(5);
    alignas(64) std::byte waiting[waiting_depth(most_tree_levels) * sizeof(TreeChild)];
    SingleStack<any> stack = {
        reinterpret_cast<TreeChild*>(waiting), reinterpret_cast<TreeChild*>(waiting)};
    TreeChild next = TreeChild::node(0);
    while (true) {
        while (next.is_block() == 0) {
            const WideNode& node = nodes[next.node_number()];
            const std::size_t node_place = next.node_number() * sizeof(WideNode);
            const auto met_at = [&](const char* planes,
                                    std::size_t i,
                                    hn::Vec<Children> inverse,
                                    hn::Vec<Children> offset) HWY_ATTR {
                return hn::MulAdd(
                    hn::Load(d, reinterpret_cast<const float*>(planes + node_place) + i),
                    inverse,
                    offset);
            };
            const auto near_at = [&](std::size_t i) HWY_ATTR {
                return hn::BitCast(
                    d,
                    hn::Max(
                        hn::Max(
                            bits(met_at(planes_near_x, i, inverse_x, near_x)),
                            bits(met_at(planes_near_y, i, inverse_y, near_y))),
                        hn::Max(bits(met_at(planes_near_z, i, inverse_z, near_z)), hn::Zero(di))));
            };
            const auto far_at = [&](std::size_t i) HWY_ATTR {
                return hn::BitCast(
                    d,
                    hn::Min(
                        hn::Min(
                            bits(met_at(planes_far_x, i, inverse_x, far_x)),
                            bits(met_at(planes_far_y, i, inverse_y, far_y))),
                        hn::Min(
                            bits(met_at(planes_far_z, i, inverse_z, far_z)),
                            bits(all(ray.limit)))));
            };
            std::uint32_t met = 0;
            for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d))
                met |= bits_of(d, hn::Le(near_at(i), far_at(i))) << i;
            bool left = false;
            if constexpr (any)
                left = go_to_first(node, met, foresees, stack, next);
            else
                left = go_to_nearest(
                    tree, node, met, octant, foresees, near_at, far_at, ray.limit, stack, next);
            if (!left)
                return false;
        }
        if (visit_leaf<any>(search, next, ray))
            return true;
        if (!stack.take(ray.limit, next))
            return false;
    }
}

/// The nearest hit of one ray.
template <typename Tree>
HWY_INLINE void
search_nearest_alone_in(const Tree& tree, const IndexRay& given, typename Tree::Hit& hit) {
    SingleRay ray;
    std::size_t octant = 0;
    float per_t_scale = 1;
    if (HWY_UNLIKELY(!start_single(tree, given, ray, octant, per_t_scale))) {
        hit = nearest_plainly(tree, given);
        return;
    }
    AloneSearch<Tree> search = {{tree}};
    add_numbers(search, ray);
    follow_single<false>(search, octant, starts_near_last(ray), ray);
    if (HWY_UNLIKELY(search.space != nullptr))
        hit = decide_doubtful(
            search, search.space->doubtful, given, ray.leaf, ray.place, search.last_doubtful);
    else if (ray.place == no_place)
        hit = {};
    else
        hit = sure_hit(search, ray, per_t_scale);
}

/// Whether one ray meets anything.
template <typename Tree>
HWY_INLINE bool search_any_alone_in(const Tree& tree, const IndexRay& given) {
    SingleRay ray;
    std::size_t octant = 0;
    float per_t_scale = 1;
    if (HWY_UNLIKELY(!start_single(tree, given, ray, octant, per_t_scale)))
        return meets_any_plainly(tree, given);
    AloneSearch<Tree> search = {{tree}};
    add_numbers(search, ray);
    return follow_single<true>(search, octant, starts_near_last(ray), ray);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
