// SPDX-License-Identifier: Apache-2.0
// What a search of a tree of boxes holds: see float_search-inl.h. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_FLOAT_WORKSPACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_WORKSPACE_INL_H
#undef VERA_ACCEL_FLOAT_WORKSPACE_INL_H
#else
#define VERA_ACCEL_FLOAT_WORKSPACE_INL_H
#endif

#include "vera/accel/float_beams-inl.h"
#include "vera/accel/float_rays-inl.h"
#include "vera/accel/float_shafts-inl.h"
#include "vera/accel/float_singles-inl.h"
#include "vera/accel/float_streams-inl.h"
#include "vera/accel/float_tree.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The rays of so many groups are searched for together, so that their streams are full, and take
/// steps in turn; and at most of so many, whatever the tree.
template <typename Tree>
constexpr std::size_t rays_at_once = Tree::groups_at_once* group_size;
constexpr std::size_t most_groups = 32;

constexpr std::size_t beams_at_once = 8;

/// As many as there are groups, or octants with a stream that is not full.
constexpr std::size_t streams_at_once = most_groups + octant_count;

/// So few rays of a group do not make a beam.
constexpr int few_rays = 6;

/// No number of a Doubtful.
constexpr std::uint32_t no_doubtful = ~std::uint32_t{0};

/// An element that a ray may meet, of which single precision cannot tell.
struct Doubtful {
    std::uint32_t leaf = 0;             ///< TreeChild::first() of its leaf
    std::uint32_t place = 0;            ///< in the leaf: see place_in_leaf()
    std::uint32_t before = no_doubtful; ///< the number of the same ray's one before
};

/// What a search holds; each thread keeps one.
struct Workspace {
    std::array<RayGroup, most_groups> groups;
    std::array<BeamWalk, beams_at_once> beams;
    std::array<SingleRay, most_groups * group_size> singles;
    std::size_t depth = 0;          ///< of a stack
    std::vector<TreeChild> waiting; ///< a stack for each beam; the first is that of one ray as well
    std::array<RayStream, streams_at_once> streams;
    std::array<RayShaft, most_groups> shafts;
    std::array<ShaftStream, streams_at_once> shaft_streams;
    std::vector<TreeChild> stream_children;
    std::vector<std::uint64_t> stream_waiting;
    std::vector<Doubtful> doubtful;
};

/// The one of this thread.
HWY_NOINLINE inline Workspace& workspace_of_this_thread(const FloatTree& tree) {
    thread_local Workspace space;
    const std::size_t depth = waiting_depth(tree.levels);
    if (space.depth < depth) {
        space.waiting.resize(beams_at_once * depth);
        space.stream_children.resize(streams_at_once * depth);
        space.stream_waiting.resize(streams_at_once * depth);
        space.depth = depth;
    }
    return space;
}

/// Notes that the lane's ray may meet the element at this place of this leaf.
HWY_INLINE void doubt(
    std::vector<Doubtful>& all,
    RayGroup& group,
    std::size_t lane,
    std::uint32_t leaf,
    std::uint32_t place) {
    const GroupMask bit = GroupMask{1} << lane;
    const std::uint32_t before = (group.in_doubt & bit) != 0 ? group.doubtful[lane] : no_doubtful;
    group.in_doubt |= bit;
    group.doubtful[lane] = static_cast<std::uint32_t>(all.size());
    all.push_back({leaf, place, before});
}

/// What is searched through: see FloatTree.
template <typename Tree>
struct TreeSearch {
    const Tree& tree;
};

/// A search for many rays, and what is counted meanwhile.
template <typename Tree>
struct Search : TreeSearch<Tree> {
    Workspace& space;
    SearchCounts& counts;
};

template <typename Tree>
HWY_INLINE TreeChild* stack_of(const Search<Tree>& search, std::size_t number) {
    return search.space.waiting.data() + number * search.space.depth;
}

template <typename Tree>
HWY_INLINE const float* rows_of(const Tree& tree, const TreeChild& leaf) {
    return tree.leaves.data() + Tree::leaf_rows * leaf.first();
}

/// Where the numbers of an element begin, by its leaf and its place there: each further one stands
/// the leaf's size, place >> 8, behind.
template <typename Tree>
HWY_INLINE const float* numbers_at(const Tree& tree, std::uint32_t leaf, std::uint32_t place) {
    return tree.leaves.data() + Tree::leaf_rows * leaf + (place & 0xffU);
}

template <typename Tree>
HWY_INLINE std::uint32_t element_at(const Tree& tree, std::uint32_t leaf, std::uint32_t place) {
    const std::size_t size = place >> 8U;
    return std::bit_cast<std::uint32_t>(
        numbers_at(tree, leaf, place)[(Tree::leaf_rows - 1) * size]);
}

/// The numbers of an element as the caller gave them, of a tree that is exact, as it is where rays
/// are followed. They are taken from the leaf, which is at hand.
template <typename Tree>
HWY_INLINE auto given_numbers(const Tree& tree, std::uint32_t leaf, std::uint32_t place) {
    const float* const numbers = numbers_at(tree, leaf, place);
    const std::size_t size = place >> 8U;
    std::array<float, Tree::leaf_rows - 1> given;
    for (std::size_t row = 0; row < given.size(); ++row)
        given[row] = tree.scale_back(numbers[row * size]);
    return given;
}

template <typename Tree>
HWY_NOINLINE bool
surely_meets(const Tree& tree, const IndexRay& ray, std::uint32_t leaf, std::uint32_t place) {
    return decider_of(tree, ray).meets(given_numbers(tree, leaf, place));
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
