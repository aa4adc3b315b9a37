// SPDX-License-Identifier: Apache-2.0
// The way of one ray alone through a tree of boxes: see float_search-inl.h. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_FLOAT_ALONE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_ALONE_INL_H
#undef VERA_ACCEL_FLOAT_ALONE_INL_H
#else
#define VERA_ACCEL_FLOAT_ALONE_INL_H
#endif

#include "vera/accel/float_walks-inl.h"
#include "vera/accel/float_workspace-inl.h"

#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What waits for one ray; the next one is on top.
struct SingleStack {
    TreeChild* children;
    std::size_t size;

    /// Takes the next one that is not behind the limit; false when there is none.
    bool take(float limit, TreeChild& next) {
        while (size > 0) {
            next = children[--size];
            if (next.near() <= limit)
                return true;
        }
        return false;
    }
};

/// Follows one ray of an octant down from the root; true when it is only asked whether it meets
/// anything, and it does.
template <bool any, typename Tree>
HWY_INLINE bool follow_single(const Search<Tree>& search, std::size_t octant, SingleRay& ray) {
    const Tree& tree = search.tree;
    const Children d;
    const auto all = [&](float number) HWY_ATTR { return hn::Set(d, number); };
    const auto places = plane_places[octant];
    const auto inverse_x = all(ray.inverse[0]);
    const auto inverse_y = all(ray.inverse[1]);
    const auto inverse_z = all(ray.inverse[2]);
    const auto near_x = all(ray.near_offset[0]);
    const auto near_y = all(ray.near_offset[1]);
    const auto near_z = all(ray.near_offset[2]);
    const auto far_x = all(ray.far_offset[0]);
    const auto far_y = all(ray.far_offset[1]);
    const auto far_z = all(ray.far_offset[2]);
    SingleStack stack = {stack_of(search, 0), 0};
    TreeChild next = TreeChild::node(0);
    while (true) {
        while (next.is_block() == 0) {
            ++search.counts.nodes;
            const WideNode& node = tree.nodes[next.first()];
            const float* const planes = node.planes[0].data();
            const auto plane = [&](std::size_t j, std::size_t i)
                                   HWY_ATTR { return hn::Load(d, planes + places[j] + i); };
            const auto near_at = [&](std::size_t i) HWY_ATTR {
                return hn::Max(
                    hn::Max(
                        hn::MulAdd(plane(0, i), inverse_x, near_x),
                        hn::MulAdd(plane(1, i), inverse_y, near_y)),
                    hn::Max(hn::MulAdd(plane(2, i), inverse_z, near_z), hn::Zero(d)));
            };
            const auto far_at = [&](std::size_t i) HWY_ATTR {
                return hn::Min(
                    hn::Min(
                        hn::MulAdd(plane(3, i), inverse_x, far_x),
                        hn::MulAdd(plane(4, i), inverse_y, far_y)),
                    hn::Min(hn::MulAdd(plane(5, i), inverse_z, far_z), all(ray.limit)));
            };
            std::uint32_t met = 0;
            for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d))
                met |= bits_of(d, hn::Le(near_at(i), far_at(i))) << i;
            // With branches, which the processor follows before it knows, it has the memory of what
            // is next under way. Of most nodes one child is met, which need not wait on the stack.
            if (met == 0) {
                if (!stack.take(ray.limit, next))
                    return false;
                continue;
            }
            const auto first = static_cast<std::size_t>(std::countr_zero(met));
            if ((met & (met - 1)) == 0) {
                next = node.children[first];
                continue;
            }
            if constexpr (any) {
                next = node.children[first];
                for (met &= met - 1; met != 0; met ^= std::bit_floor(met))
                    stack.children[stack.size++] = TreeChild::waiting(
                        node.children[static_cast<std::size_t>(std::bit_width(met) - 1)], 0);
            } else {
                const PutChildren put =
                    put_met_children(node, octant, near_at, far_at, stack.children + stack.size);
                next = put.first;
                stack.size += put.count - 1;
                fetch(tree, stack.children[stack.size - 1]);
            }
        }
        if (visit_leaf<any>(search, next, ray))
            return true;
        if (!stack.take(ray.limit, next))
            return false;
    }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
