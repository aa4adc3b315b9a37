// SPDX-License-Identifier: Apache-2.0
// What the rays of a search of a tree of boxes have met: see float_search-inl.h. Compiled once for
// each instruction set.

#if defined(VERA_ACCEL_FLOAT_HITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_HITS_INL_H
#undef VERA_ACCEL_FLOAT_HITS_INL_H
#else
#define VERA_ACCEL_FLOAT_HITS_INL_H
#endif

#include "vera/accel/float_rays-inl.h"
#include "vera/accel/float_workspace-inl.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The lanes that surely meet something.
HWY_INLINE GroupMask lanes_with_place(const RayGroup& group) {
    const hn::RebindToUnsigned<Rays> d;
    GroupMask lanes = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
        lanes |= bits_of(d, hn::Ne(hn::Load(d, group.place.data() + i), hn::Set(d, no_place))) << i;
    return lanes;
}

/// The hit of a ray that may meet more than it surely meets, if it surely meets anything.
template <typename Tree>
HWY_NOINLINE typename Tree::Hit decide_doubtful(
    const TreeSearch<Tree>& search,
    const std::vector<Doubtful>& doubtful,
    const IndexRay& ray,
    std::uint32_t leaf,
    std::uint32_t place,
    std::uint32_t last_doubtful) {
    auto decider = decider_of(search.tree, ray);
    const auto consider = [&](std::uint32_t of_leaf, std::uint32_t at) {
        decider.consider(
            element_at(search.tree, of_leaf, at), given_numbers(search.tree, of_leaf, at));
    };
    if (place != no_place)
        consider(leaf, place);
    for (std::uint32_t i = last_doubtful; i != no_doubtful; i = doubtful[i].before)
        consider(doubtful[i].leaf, doubtful[i].place);
    return decider.hit();
}

/// The lanes of rays that single precision cannot follow.
HWY_INLINE GroupMask not_followed(const RayGroup& group) {
    return ((GroupMask{1} << group.rays.size()) - 1) & ~group.followed;
}

/// The hits of the groups that were searched for.
template <typename Tree>
HWY_INLINE void
take_hits(const Search<Tree>& search, std::size_t groups, std::span<typename Tree::Hit> hits) {
    const Workspace& space = search.space;
    for (std::size_t i = 0; i < groups; ++i) {
        const RayGroup& group = space.groups[i];
        typename Tree::Hit* const of_group = hits.data() + i * group_size;
        take_sure_hits(search, group, of_group);
        for (GroupMask rest = group.in_doubt; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            of_group[lane] = decide_doubtful(
                search,
                space.doubtful,
                group.rays[lane],
                group.leaf[lane],
                group.place[lane],
                group.doubtful[lane]);
        }
        for (GroupMask rest = not_followed(group); rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            of_group[lane] = nearest_plainly(search.tree, group.rays[lane]);
        }
    }
}

template <typename Tree>
HWY_INLINE void
take_met(const Search<Tree>& search, std::size_t groups, std::span<std::uint8_t> met) {
    for (std::size_t i = 0; i < groups; ++i) {
        const RayGroup& group = search.space.groups[i];
        std::uint8_t* const of_group = met.data() + i * group_size;
        for (std::size_t lane = 0; lane < group.rays.size(); ++lane)
            of_group[lane] = static_cast<std::uint8_t>(group.met >> lane & 1U);
        for (GroupMask rest = not_followed(group); rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            of_group[lane] = meets_any_plainly(search.tree, group.rays[lane]) ? 1 : 0;
        }
    }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
