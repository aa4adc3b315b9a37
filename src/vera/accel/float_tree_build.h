// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/float_tree.h"
#include "vera/base/large_pages.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace vera::detail {

/// Ranges that the threads take.
constexpr std::size_t float_tree_grain = 4096;

/// The largest size_of(number) of so many elements, of which none is negative; 0 of none.
template <typename SizeOf>
float largest_size(std::size_t count, const SizeOf& size_of) {
    std::atomic<std::uint32_t> largest = 0; // of positive numbers, the bits have the same order
    parallel_ranges(count, float_tree_grain, [&](std::size_t first, std::size_t last) {
        float of_part = 0;
        for (std::size_t i = first; i < last; ++i)
            of_part = std::max(of_part, size_of(i));
        const auto bits = std::bit_cast<std::uint32_t>(of_part);
        std::uint32_t before = largest.load();
        while (before < bits && !largest.compare_exchange_weak(before, bits)) {
        }
    });
    return std::bit_cast<float>(largest.load());
}

/// Sets how the tree's numbers are scaled: so that what is as large as this becomes less than 1.
/// What is left out of the tree, as numbers that no element has, is not to be counted: it may be
/// huge, and what is much smaller than 1 is not settled in single precision.
inline void set_scale(FloatTree& tree, double largest) {
    if (largest > 0) {
        int exponent = 0;
        std::frexp(largest, &exponent);
        tree.exponent = -exponent;
    }
    tree.scale = FloatScale(tree.exponent);
    tree.scale_back = FloatScale(-tree.exponent);
}

/// Whether each of the numbers can be had back from what it becomes.
template <std::size_t Count>
bool scales_exactly(const FloatTree& tree, const std::array<float, Count>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [&](float number) {
        return tree.scale_back(tree.scale(number)) == number || !std::isfinite(number);
    });
}

/// Whether that holds for each of so many numbers.
template <typename Holds>
bool holds_for_all(std::size_t count, const Holds& holds) {
    std::atomic<bool> all = true;
    parallel_ranges(count, float_tree_grain, [&](std::size_t first, std::size_t last) {
        bool of_part = true;
        for (std::size_t i = first; i < last; ++i)
            of_part = of_part && holds(i);
        if (!of_part)
            all = false;
    });
    return all;
}

/// The box, enlarged by its part of what is rounded.
inline FloatBox with_rounding(FloatBox box) {
    float largest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(box.lower[axis]), std::abs(box.upper[axis])});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] -= box_rounding * largest;
        box.upper[axis] += box_rounding * largest;
    }
    return box;
}

/// The boxes of so many elements, enlarged; those of which box_of(number) is empty are left out.
template <typename BoxOf>
std::vector<BoxReference> float_references(std::size_t count, const BoxOf& box_of) {
    std::vector<BoxReference> references(count);
    std::atomic<bool> some_are_empty = false;
    parallel_ranges(count, float_tree_grain, [&](std::size_t first, std::size_t last) {
        bool empty = false;
        for (std::size_t i = first; i < last; ++i) {
            const FloatBox box = with_rounding(box_of(i));
            references[i] = {box.lower, static_cast<std::uint32_t>(i), box.upper, 0};
            empty = empty || !(box.lower[0] <= box.upper[0]);
        }
        if (empty)
            some_are_empty = true;
    });
    if (some_are_empty)
        std::erase_if(references, [](const BoxReference& reference) {
            return !(reference.lower[0] <= reference.upper[0]);
        });
    return references;
}

/// Makes the tree of the references, whose boxes are scaled already; contents as in
/// build_box_tree(); numbers_of(element) is an array of what stands of it, scaled, in a leaf's
/// rows, but for the last. Returns how many leaves there are.
template <typename Tree, typename NumbersOf>
std::size_t grow_float_tree(
    Tree& tree,
    std::vector<BoxReference> references,
    IndexQuality quality,
    const CancelFlag* cancel,
    std::span<const float> contents,
    const NumbersOf& numbers_of) {
    const TreeEffort effort = quality == IndexQuality::high ? TreeEffort::high : TreeEffort::usual;
    BoxTree boxes = build_box_tree(std::move(references), most_in_leaf, cancel, effort, contents);
    // Whole registers are loaded of the last rows.
    const std::size_t numbers = Tree::leaf_rows * boxes.references.size() + 2 * most_in_leaf;
    tree.leaves.reserve(numbers);
    prefer_large_pages(tree.leaves.data(), numbers * sizeof(float), Written::nothing);
    tree.leaves.resize(numbers);
    const auto fill = [&](const TreeChild& leaf) {
        const std::size_t size = leaf_size(leaf);
        float* const rows = tree.leaves.data() + Tree::leaf_rows * leaf.first();
        for (std::size_t i = 0; i < size; ++i) {
            const std::uint32_t element = boxes.references[leaf.first() + i].element;
            const auto values = numbers_of(element);
            static_assert(values.size() == Tree::leaf_rows - 1);
            for (std::size_t row = 0; row < values.size(); ++row)
                rows[row * size + i] = values[row];
            rows[(Tree::leaf_rows - 1) * size + i] = std::bit_cast<float>(element);
        }
    };
    parallel_ranges(boxes.nodes.size(), 256, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            for (const TreeChild& child : boxes.nodes[i].children)
                if (child.is_block() != 0)
                    fill(child);
    });
    tree.levels = boxes.levels;
    tree.nodes = std::move(boxes.nodes);
    prefer_large_pages(tree.nodes.data(), tree.nodes.size() * sizeof(WideNode), Written::all);
    return boxes.leaves;
}

/// Bytes of the tree itself.
template <typename Tree>
std::size_t bytes_of(const Tree& tree) {
    return sizeof(Tree) + tree.nodes.capacity() * sizeof(WideNode)
        + tree.leaves.capacity() * sizeof(float);
}

} // namespace vera::detail
