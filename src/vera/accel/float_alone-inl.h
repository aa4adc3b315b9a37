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

    /// Takes the next one if that is a node which is not behind the limit; false where it is not.
    HWY_INLINE bool take_node(float limit, TreeChild& next) {
        if (end == begin || end[-1].is_block() != 0 || !(any || end[-1].near() <= limit))
            return false;
        next = *--end;
        return true;
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

/// What a ray has in common with the one that this thread was asked about before.
struct Likeness {
    /// Then it mostly goes the same ways at first, which are foreseen. What else is foreseen
    /// wrongly costs more than it brings.
    bool starts_near;
    /// It starts near and has nearly the same direction: then nearly all of its way is foreseen.
    /// Others test two nodes at a time, as what is computed of one is waited for anyway.
    bool runs_alike;
};

HWY_INLINE Likeness likeness_to_last(const SingleRay& ray) {
    constexpr float near = 0x1p-6F;

    struct Last {
        std::array<float, 3> origin;
        std::array<float, 3> direction;
    };

    thread_local Last last = {};
    float apart = 0;
    float turned = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        apart = std::max(apart, std::abs(ray.origin[axis] - last.origin[axis]));
        turned = std::max(turned, std::abs(ray.direction[axis] - last.direction[axis]));
        last.origin[axis] = ray.origin[axis];
        last.direction[axis] = ray.direction[axis];
    }
    return {apart < near, std::max(apart, turned) < near};
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
template <typename NearAt, typename FarAt>
HWY_INLINE bool go_to_nearest(
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
    return true;
}

/// A ray as it is tested against the children of nodes, those of a register from number i on.
class RayAtNodes {
public:
    RayAtNodes(const WideNode* nodes, std::size_t octant, const SingleRay& ray)
        : inverse_(same_for_all(Children(), ray.inverse))
        , near_offset_(same_for_all(Children(), ray.near_offset))
        , far_offset_(same_for_all(Children(), ray.far_offset)) {
        for (std::size_t j = 0; j < planes_.size(); ++j)
            planes_[j] = nodes[0].planes[0].data() + plane_places[octant][j];
    }

    /// Where it enters their boxes, and not less than 0.
    HWY_INLINE hn::Vec<Children> near_at(const TreeChild& node, std::size_t i) const {
        return hn::BitCast(
            Children(),
            hn::Max(
                hn::Max(
                    crossing(node, 0, i, inverse_.x, near_offset_.x),
                    crossing(node, 1, i, inverse_.y, near_offset_.y)),
                hn::Max(crossing(node, 2, i, inverse_.z, near_offset_.z), hn::Zero(Bits()))));
    }

    /// Where it leaves them, and not more than the limit.
    HWY_INLINE hn::Vec<Children> far_at(const TreeChild& node, std::size_t i, float limit) const {
        return hn::BitCast(
            Children(),
            hn::Min(
                hn::Min(
                    crossing(node, 3, i, inverse_.x, far_offset_.x),
                    crossing(node, 4, i, inverse_.y, far_offset_.y)),
                hn::Min(
                    crossing(node, 5, i, inverse_.z, far_offset_.z),
                    hn::BitCast(Bits(), hn::Set(Children(), limit)))));
    }

private:
    // As integers, numbers have the same order unless both are negative, which does not matter
    // where they are compared with what is not; and which is larger is sooner known.
    using Bits = hn::RebindToSigned<Children>;

    HWY_INLINE hn::Vec<Bits> crossing(
        const TreeChild& node,
        std::size_t plane,
        std::size_t i,
        hn::Vec<Children> inverse,
        hn::Vec<Children> offset) const {
        const auto* const place = reinterpret_cast<const char*>(planes_[plane] + i);
        const auto* const planes =
            reinterpret_cast<const float*>(place + node.node_number() * sizeof(WideNode));
        return hn::BitCast(Bits(), hn::MulAdd(hn::Load(Children(), planes), inverse, offset));
    }

    Vector<hn::Vec<Children>> inverse_;
    Vector<hn::Vec<Children>> near_offset_;
    Vector<hn::Vec<Children>> far_offset_;
    /// Of the root; where others' are follows by one sum from a node's number.
    std::array<const float*, 6> planes_;
};

/// Puts in place of the node on top of the stack, where it is one, its children that the ray meets.
/// Its numbers are under way then, and computed with, beside those of the node that the ray is at:
/// of one alone, each step waits for the one before.
template <bool any>
HWY_INLINE void test_ahead(
    const WideNode* nodes,
    const RayAtNodes& at_nodes,
    std::size_t octant,
    float limit,
    SingleStack<any>& stack) {
    TreeChild top;
    if (!stack.take_node(limit, top))
        return;
    const WideNode& node = nodes[top.node_number()];
    const auto near_at = [&](std::size_t i) HWY_ATTR { return at_nodes.near_at(top, i); };
    const auto far_at = [&](std::size_t i) HWY_ATTR { return at_nodes.far_at(top, i, limit); };
    if constexpr (any)
        stack.end += put_any_children(node, near_at, far_at, stack.end);
    else
        stack.end += put_met_children(node, octant, near_at, far_at, stack.end).count;
}

/// Follows one ray of an octant down from the root; true when it is only asked whether it meets
/// anything, and it does.
template <bool any, typename Tree>
HWY_INLINE bool follow_single(
    AloneSearch<Tree>& search, std::size_t octant, const Likeness& likeness, SingleRay& ray) {
    const WideNode* const nodes = search.tree.nodes.data();
    const RayAtNodes at_nodes(nodes, octant, ray);
    // Without registers that compress, putting children costs more.
    const bool tests_ahead = !(VERA_AVX512 == 1 ? likeness.runs_alike : likeness.starts_near);
    // What waits stands by levels, the deepest on top. So where a node on top is tested ahead, none
    // of its children's level waits: of each, the children of two nodes are there at most.
    alignas(64) std::byte waiting[2 * waiting_depth(most_tree_levels) * sizeof(TreeChild)];
    SingleStack<any> stack = {
        reinterpret_cast<TreeChild*>(waiting), reinterpret_cast<TreeChild*>(waiting)};
    TreeChild next = TreeChild::node(0);
    while (true) {
        while (next.is_block() == 0) {
            const TreeChild here = next;
            const auto near_at = [&](std::size_t i) HWY_ATTR { return at_nodes.near_at(here, i); };
            const auto far_at = [&](std::size_t i)
                                    HWY_ATTR { return at_nodes.far_at(here, i, ray.limit); };
            if (tests_ahead)
                test_ahead(nodes, at_nodes, octant, ray.limit, stack);
            const Children d;
            std::uint32_t met = 0;
            for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d))
                met |= bits_of(d, hn::Le(near_at(i), far_at(i))) << i;
            const WideNode& node = nodes[here.node_number()];
            const bool foresees = likeness.starts_near;
            bool left = false;
            if constexpr (any)
                left = go_to_first(node, met, foresees, stack, next);
            else
                left = go_to_nearest(
                    node, met, octant, foresees, near_at, far_at, ray.limit, stack, next);
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
    follow_single<false>(search, octant, likeness_to_last(ray), ray);
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
    return follow_single<true>(search, octant, likeness_to_last(ray), ray);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
