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

/// The largest of the finite numbers in the rows of which is_asked(row) is true, without its sign.
template <std::size_t Count, typename IsAsked>
float largest_number(std::span<const std::array<float, Count>> rows, const IsAsked& is_asked) {
    std::atomic<std::uint32_t> largest = 0; // of positive numbers, the bits have the same order
    parallel_ranges(rows.size(), float_tree_grain, [&](std::size_t first, std::size_t last) {
        float of_part = 0;
        for (std::size_t i = first; i < last; ++i)
            if (is_asked(rows[i]))
                for (const float number : rows[i])
                    if (std::isfinite(number))
                        of_part = std::max(of_part, std::abs(number));
        const auto bits = std::bit_cast<std::uint32_t>(of_part);
        std::uint32_t before = largest.load();
        while (before < bits && !largest.compare_exchange_weak(before, bits)) {
        }
    });
    return std::bit_cast<float>(largest.load());
}

/// Every number of those rows can be had back from what it becomes.
template <std::size_t Count, typename IsAsked>
bool scales_exactly(
    std::span<const std::array<float, Count>> rows, const IsAsked& is_asked, int exponent) {
    const FloatScale scale(exponent);
    const FloatScale back(-exponent);
    std::atomic<bool> exact = true;
    parallel_ranges(rows.size(), float_tree_grain, [&](std::size_t first, std::size_t last) {
        bool all = true;
        for (std::size_t i = first; i < last; ++i)
            if (is_asked(rows[i]))
                for (const float number : rows[i])
                    all = all && (back(scale(number)) == number || !std::isfinite(number));
        if (!all)
            exact = false;
    });
    return exact;
}

/// Sets how the tree's numbers are scaled: so that those of the rows that are asked, times the
/// reach, become less than 1. What is left out of the tree is not to be asked: it may be huge.
template <std::size_t Count, typename IsAsked>
void set_scale(
    FloatTree& tree,
    std::span<const std::array<float, Count>> rows,
    const IsAsked& is_asked,
    double reach) {
    const double largest = reach * static_cast<double>(largest_number(rows, is_asked));
    if (largest > 0) {
        int exponent = 0;
        std::frexp(largest, &exponent);
        tree.exponent = -exponent;
    }
    tree.scale = FloatScale(tree.exponent);
    tree.scale_back = FloatScale(-tree.exponent);
    tree.exact = scales_exactly(rows, is_asked, tree.exponent);
}

/// The boxes of so many elements; those of which box_of(number) is empty are left out.
template <typename BoxOf>
std::vector<BoxReference> float_references(std::size_t count, const BoxOf& box_of) {
    std::vector<BoxReference> references(count);
    std::atomic<bool> some_are_empty = false;
    parallel_ranges(count, float_tree_grain, [&](std::size_t first, std::size_t last) {
        bool empty = false;
        for (std::size_t i = first; i < last; ++i) {
            const FloatBox box = box_of(i);
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

/// Makes the tree of the references, which is scaled already; contents as in build_box_tree();
/// numbers_of(element) is an array of what stands of it in a leaf's rows, but for the last. Returns
/// how many leaves there are.
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
    prefer_large_pages(tree.leaves.data(), numbers * sizeof(float));
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
    prefer_large_pages(tree.nodes.data(), tree.nodes.size() * sizeof(WideNode));
    return boxes.leaves;
}

/// Bytes of the tree itself.
template <typename Tree>
std::size_t bytes_of(const Tree& tree) {
    return sizeof(Tree) + tree.nodes.capacity() * sizeof(WideNode)
        + tree.leaves.capacity() * sizeof(float);
}

} // namespace vera::detail
