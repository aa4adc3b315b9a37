// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/box_tree.h"
#include "vera/accel/simd_level.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

using detail::BoxReference;
using detail::BoxTree;
using detail::build_box_tree;
using detail::FloatBox;
using detail::TreeChild;
using detail::TreeEffort;
using detail::WideNode;

constexpr std::array both_efforts = {TreeEffort::usual, TreeEffort::high};
constexpr float infinite = std::numeric_limits<float>::infinity();

FloatBox box_of(const WideNode& node, std::size_t child) {
    FloatBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = node.planes[axis][child];
        box.upper[axis] = node.planes[3 + axis][child];
    }
    return box;
}

bool holds(const FloatBox& outer, const FloatBox& inner) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(outer.lower[axis] <= inner.lower[axis] && inner.upper[axis] <= outer.upper[axis]))
            return false;
    return true;
}

bool is_empty(const FloatBox& box) {
    return box.lower[0] > box.upper[0];
}

/// Twice where the middle of a child's box is along the diagonal of an octant; 0 where it is
/// nowhere.
float place(const WideNode& node, std::size_t child, std::size_t octant) {
    float sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float middle = node.planes[axis][child] + node.planes[3 + axis][child];
        sum += (octant >> axis & 1U) != 0 ? -middle : middle;
    }
    constexpr float most = std::numeric_limits<float>::max() / 2;
    return std::isnan(sum) ? 0 : std::clamp(sum, -most, most);
}

/// The last three digits do not count, nor what is as good as 0.
bool is_not_before(float a, float b) {
    return a >= b - 0x1p-20F * std::max(std::abs(a), std::abs(b)) - 0x1p-98F;
}

/// Goes through a tree from the root and complains of whatever is not as box_tree.h says.
class Inspection {
public:
    Inspection(const BoxTree& tree, std::size_t leaf_size)
        : tree_(tree)
        , leaf_size_(leaf_size)
        , times_in_leaves_(tree.references.size()) {}

    void inspect() {
        if (tree_.nodes.empty()) {
            EXPECT_TRUE(tree_.references.empty());
            EXPECT_EQ(tree_.leaves, 0U);
            EXPECT_EQ(tree_.levels, 0U);
            return;
        }
        inspect_node(0, 1, {{-infinite, -infinite, -infinite}, {infinite, infinite, infinite}});
        EXPECT_EQ(nodes_, tree_.nodes.size());
        EXPECT_EQ(leaves_, tree_.leaves);
        EXPECT_EQ(levels_, tree_.levels);
        EXPECT_LE(levels_, detail::most_tree_levels);
        EXPECT_TRUE(std::all_of(times_in_leaves_.begin(), times_in_leaves_.end(), [](int times) {
            return times == 1;
        })) << "a reference is in no leaf or in several";
    }

private:
    /// What rays find in a part of the tree, by the boxes of its references, and what it costs: the
    /// surfaces of its nodes and leaves.
    struct Part {
        double content = 0;
        double cost = 0;
    };

    Part inspect_node(std::size_t number, std::size_t level, const FloatBox& outer) {
        EXPECT_LT(number, tree_.nodes.size());
        if (number >= tree_.nodes.size())
            return {};
        const WideNode& node = tree_.nodes[number];
        ++nodes_;
        levels_ = std::max(levels_, level);
        std::size_t count = 0;
        while (count < detail::tree_width && !is_empty(box_of(node, count)))
            ++count;
        EXPECT_GE(count, number == 0 ? 1U : 2U);
        for (std::size_t i = count; i < detail::tree_width; ++i)
            EXPECT_TRUE(is_empty(box_of(node, i)));
        Part whole;
        Part before = {HUGE_VAL, 1};
        for (std::size_t i = 0; i < count; ++i) {
            const FloatBox box = box_of(node, i);
            EXPECT_TRUE(holds(outer, box));
            Part part = node.children[i].is_block() != 0
                ? inspect_leaf(node.children[i], box)
                : inspect_node(node.children[i].first(), level + 1, box);
            part.cost += static_cast<double>(surface(box));
            EXPECT_TRUE(may_follow(before, part)) << before.content << " " << part.content;
            before = part;
            whole.content += part.content;
            whole.cost += part.cost;
        }
        inspect_orders(node, count);
        return whole;
    }

    /// Whether rays that ask for anything may come to the second part after the first, since they
    /// find no more there for what it costs: but for what is rounded, and where it is too much or
    /// too little for floats.
    static bool may_follow(const Part& first, const Part& second) {
        constexpr double most = 1e36;
        constexpr double least = 1e-36;
        for (const Part& part : {first, second})
            if (!(part.cost < most && part.cost > least))
                return true;
        return second.content / second.cost <= first.content / first.cost * 1.001;
    }

    Part inspect_leaf(TreeChild leaf, const FloatBox& box) {
        ++leaves_;
        const std::size_t size = leaf.kind() + 1;
        EXPECT_EQ(leaf.count(), 1U);
        EXPECT_LE(size, leaf_size_);
        EXPECT_LE(leaf.first() + size, tree_.references.size());
        if (leaf.first() + size > tree_.references.size())
            return {};
        Part part;
        for (std::size_t i = leaf.first(); i < leaf.first() + size; ++i) {
            EXPECT_TRUE(holds(box, tree_.references[i].box()));
            EXPECT_EQ(tree_.references[i].kind, tree_.references[leaf.first()].kind);
            ++times_in_leaves_[i];
            part.content += static_cast<double>(surface(tree_.references[i].box()));
        }
        return part;
    }

    /// In each order every child is named once, and those that are there before the others; in that
    /// of an octant, those come later that lie farther along its diagonal.
    static void inspect_orders(const WideNode& node, std::size_t count) {
        for (std::size_t order = 0; order <= detail::any_order; ++order) {
            std::vector<std::size_t> numbers;
            for (std::size_t place = 0; place < detail::tree_width; ++place)
                numbers.push_back(waiting_at(node, place, order));
            // Absent children are not met, wherever they stand in the order of all numbers.
            EXPECT_TRUE(
                order == detail::any_order
                || std::all_of(
                    numbers.begin(),
                    numbers.begin() + static_cast<std::ptrdiff_t>(count),
                    [&](std::size_t number) { return number < count; }));
            for (std::size_t i = 1; order < detail::octant_count && i < count; ++i)
                EXPECT_TRUE(is_not_before(
                    place(node, numbers[i - 1], order), place(node, numbers[i], order)));
            std::sort(numbers.begin(), numbers.end());
            for (std::size_t i = 0; i < numbers.size(); ++i)
                EXPECT_EQ(numbers[i], i);
        }
    }

    const BoxTree& tree_;
    std::size_t leaf_size_;
    std::vector<int> times_in_leaves_;
    std::size_t nodes_ = 0;
    std::size_t leaves_ = 0;
    std::size_t levels_ = 0;
};

auto key(const BoxReference& reference) {
    return std::tuple(reference.element, reference.kind, reference.lower, reference.upper);
}

void expect_good_tree(
    const std::vector<BoxReference>& references, std::size_t leaf_size, TreeEffort effort) {
    SCOPED_TRACE("leaves of " + std::to_string(leaf_size));
    const BoxTree tree = build_box_tree(references, leaf_size, nullptr, effort);
    auto expected = references;
    auto sorted = tree.references;
    const auto before = [](const auto& a, const auto& b) { return key(a) < key(b); };
    std::sort(expected.begin(), expected.end(), before);
    std::sort(sorted.begin(), sorted.end(), before);
    EXPECT_TRUE(std::equal(
        expected.begin(),
        expected.end(),
        sorted.begin(),
        sorted.end(),
        [](const auto& a, const auto& b) { return key(a) == key(b); }));
    Inspection(tree, leaf_size).inspect();
}

void expect_good_trees(const std::vector<BoxReference>& references, const std::string& what) {
    for (const TreeEffort effort : both_efforts) {
        SCOPED_TRACE(what + (effort == TreeEffort::high ? ", high effort" : ", usual effort"));
        for (const std::size_t leaf_size : {1U, 4U, 8U})
            expect_good_tree(references, leaf_size, effort);
    }
}

/// Of all nodes and leaves: how much lines have to do with the tree.
double sum_of_surfaces(const BoxTree& tree) {
    double sum = 0;
    for (const WideNode& node : tree.nodes)
        for (std::size_t i = 0; i < detail::tree_width; ++i)
            if (const FloatBox box = box_of(node, i); !is_empty(box))
                sum += static_cast<double>(surface(box));
    return sum;
}

/// References drawn from few values, so that many coincide, are flat, or lie in a line.
std::vector<BoxReference> drawn_references(
    std::uint32_t seed,
    std::size_t count,
    const std::vector<float>& places,
    const std::vector<float>& sizes,
    std::uint32_t kinds) {
    std::mt19937 random(seed);
    const auto draw = [&](const std::vector<float>& values) {
        return values[random() % values.size()];
    };
    std::vector<BoxReference> references(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            references[i].lower[axis] = draw(places);
            references[i].upper[axis] = references[i].lower[axis] + draw(sizes);
        }
        references[i].element = static_cast<std::uint32_t>(i);
        references[i].kind = static_cast<std::uint32_t>(random() % kinds);
    }
    return references;
}

/// Small boxes anywhere between -1 and 1.
std::vector<BoxReference> scattered_references(std::uint32_t seed, std::size_t count) {
    std::mt19937 random(seed);
    std::vector<float> places(1009);
    for (float& place : places)
        place = static_cast<float>(random() % 2000) * 1e-3F - 1;
    return drawn_references(seed + 1, count, places, {0, 0.001F, 0.01F, 0.02F}, 1);
}

TEST(BoxTree, OfNothingHasNoNodes) {
    expect_good_trees({}, "nothing");
}

TEST(BoxTree, HoldsFewReferences) {
    for (std::size_t count = 1; count <= 20; ++count) {
        expect_good_trees(scattered_references(1, count), std::to_string(count) + " scattered");
        expect_good_trees(
            drawn_references(2, count, {0, 1}, {0, 1}, 3),
            std::to_string(count) + " of few values");
    }
}

TEST(BoxTree, HoldsManyReferences) {
    expect_good_trees(scattered_references(3, 30000), "scattered");
    expect_good_trees(drawn_references(4, 3000, {-1, 0, 1, 2}, {0, 0.5F, 3}, 7), "of few values");
}

TEST(BoxTree, HoldsReferencesThatNoCutTellsApart) {
    expect_good_trees(drawn_references(5, 3000, {1}, {0}, 1), "one point");
    expect_good_trees(drawn_references(6, 3000, {1}, {0.5F}, 7), "one box of many kinds");
}

TEST(BoxTree, HoldsReferencesInALine) {
    std::vector<BoxReference> references = scattered_references(7, 3000);
    for (BoxReference& reference : references)
        for (const std::size_t axis : {0U, 2U})
            reference.lower[axis] = reference.upper[axis] = 1;
    expect_good_trees(references, "in a line");
}

TEST(BoxTree, HoldsReferencesOfEverySize) {
    expect_good_trees(
        drawn_references(8, 3000, {-infinite, 0, 1, 3e38F, -3e38F}, {0, 1, 3e38F}, 2),
        "up to infinite");
    expect_good_trees(
        drawn_references(9, 3000, {-3e38F, 1e-45F, -1e-38F, 0, 1e-30F}, {0, 1e-45F, infinite}, 2),
        "very small and infinite");
    std::vector<BoxReference> references = scattered_references(10, 3000);
    for (std::size_t i = 0; i < references.size(); i += 3)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            references[i].lower[axis] = -infinite;
            references[i].upper[axis] = infinite;
        }
    expect_good_trees(references, "some hold everything");
}

TEST(BoxTree, BoundsItsDepthWhereSizesShrinkWithoutEnd) {
    std::vector<BoxReference> references(80);
    float size = 1;
    for (BoxReference& reference : references) {
        reference.element = static_cast<std::uint32_t>(&reference - references.data());
        reference.lower = {size, 0, 0};
        reference.upper = {1.3F * size, size, size};
        size /= 3;
    }
    expect_good_trees(references, "shrinking");
}

TEST(BoxTree, BoundsItsDepthWhereBoxesLieInEachOther) {
    std::vector<BoxReference> references(2000);
    for (std::uint32_t i = 0; i < references.size(); ++i) {
        references[i].element = i;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            references[i].lower[axis] = -1 - static_cast<float>(i);
            references[i].upper[axis] = 1 + static_cast<float>(i);
        }
    }
    expect_good_trees(references, "in each other");
}

TEST(BoxTree, CutsManySmallBoxesIntoPartsThatHardlyOverlap) {
    const BoxTree tree = build_box_tree(scattered_references(18, 300000), 8, nullptr);
    float sum = 0;
    for (std::size_t i = 0; i < detail::tree_width; ++i) {
        const FloatBox box = box_of(tree.nodes[0], i);
        if (is_empty(box))
            continue;
        float volume = 1;
        for (std::size_t axis = 0; axis < 3; ++axis)
            volume *= box.upper[axis] - box.lower[axis];
        sum += volume;
    }
    EXPECT_LT(sum, 1.1F * 8);
}

void expect_same(const BoxTree& tree, const BoxTree& expected, const std::string& what) {
    SCOPED_TRACE(what);
    EXPECT_EQ(tree.levels, expected.levels);
    EXPECT_EQ(tree.leaves, expected.leaves);
    ASSERT_EQ(tree.nodes.size(), expected.nodes.size());
    const std::size_t bytes = tree.nodes.size() * sizeof(WideNode);
    EXPECT_EQ(std::memcmp(tree.nodes.data(), expected.nodes.data(), bytes), 0);
    ASSERT_EQ(tree.references.size(), expected.references.size());
    EXPECT_TRUE(std::equal(
        tree.references.begin(),
        tree.references.end(),
        expected.references.begin(),
        [](const auto& a, const auto& b) { return key(a) == key(b); }));
}

TEST(BoxTree, IsTheSameWhateverTheNumberOfThreads) {
    const std::vector<BoxReference> references = scattered_references(11, 200000);
    for (const TreeEffort effort : both_efforts) {
        const BoxTree expected = [&] {
            const ThreadLimit limit(1);
            return build_box_tree(references, 8, nullptr, effort);
        }();
        Inspection(expected, 8).inspect();
        for (const std::size_t threads : {2U, 7U}) {
            const ThreadLimit limit(threads);
            const BoxTree tree = build_box_tree(references, 8, nullptr, effort);
            expect_same(tree, expected, std::to_string(threads) + " threads");
        }
    }
}

TEST(BoxTree, IsTheSameWithEveryInstructionSet) {
    for (const std::vector<BoxReference>& references :
         {scattered_references(13, 20000),
          drawn_references(14, 3000, {-1, 0, 1, 2}, {0, 0.5F, 3}, 2),
          drawn_references(15, 3000, {-infinite, 0, 1, 3e38F, -3e38F}, {0, 1, 3e38F}, 1)}) {
        const BoxTree expected = build_box_tree(references, 4, nullptr);
        for (const std::string& level : simd_levels()) {
            ASSERT_TRUE(limit_simd(level));
            expect_same(build_box_tree(references, 4, nullptr), expected, level);
        }
        EXPECT_TRUE(limit_simd(""));
    }
}

/// Cubes in as many rows along each axis, which do not touch.
std::vector<BoxReference> cubes(std::uint32_t rows) {
    std::vector<BoxReference> references(std::size_t{rows} * rows * rows);
    for (std::uint32_t i = 0; i < references.size(); ++i) {
        references[i].element = i;
        const std::array<std::uint32_t, 3> place = {i % rows, i / rows % rows, i / rows / rows};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            references[i].lower[axis] = static_cast<float>(place[axis]);
            references[i].upper[axis] = references[i].lower[axis] + 0.5F;
        }
    }
    return references;
}

TEST(BoxTree, FillsItsNodes) {
    for (const TreeEffort effort : both_efforts) {
        EXPECT_EQ(build_box_tree(cubes(2), 1, nullptr, effort).nodes.size(), 1U);
        EXPECT_EQ(build_box_tree(cubes(4), 1, nullptr, effort).nodes.size(), 9U);
        EXPECT_EQ(build_box_tree(cubes(8), 1, nullptr, effort).nodes.size(), 73U);
        EXPECT_EQ(build_box_tree(cubes(8), 8, nullptr, effort).nodes.size(), 9U);
    }
}

TEST(BoxTree, PutsWhatRaysRatherHitFirst) {
    // The boxes are all alike: what is in them decides.
    const std::vector<float> contents = {0.25F, 0.5F, 0.25F, 1, 0, 0.5F, 2, std::nanf("")};
    const BoxTree tree = build_box_tree(cubes(2), 1, nullptr, TreeEffort::usual, contents);
    ASSERT_EQ(tree.nodes.size(), 1U);
    std::vector<float> found;
    for (const TreeChild child : tree.nodes[0].children)
        found.push_back(contents[tree.references[child.first()].element]);
    // What is no number counts as nothing.
    std::replace_if(
        found.begin(), found.end(), [](float value) { return std::isnan(value); }, 0);
    EXPECT_EQ(found, std::vector<float>({2, 1, 0.5F, 0.5F, 0.25F, 0.25F, 0, 0}));
}

TEST(BoxTree, IsBetterWithHighEffort) {
    // Large boxes among small ones: cuts can only be good for either.
    std::vector<BoxReference> references = scattered_references(16, 20000);
    for (const BoxReference& large :
         drawn_references(17, 500, {-1, -0.5F, 0, 0.3F}, {0.1F, 0.7F}, 1))
        references.push_back(large);
    const BoxTree usual = build_box_tree(references, 8, nullptr, TreeEffort::usual);
    const BoxTree high = build_box_tree(references, 8, nullptr, TreeEffort::high);
    EXPECT_LT(sum_of_surfaces(high), 0.97 * sum_of_surfaces(usual));
}

TEST(BoxTree, CanBeInterrupted) {
    CancelFlag cancel;
    cancel.raise();
    for (const TreeEffort effort : both_efforts)
        EXPECT_THROW(build_box_tree(scattered_references(12, 1000), 4, &cancel, effort), Cancelled);
}

} // namespace
} // namespace vera
