// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/tree_structures.h"
#include "vera/base/parallel.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vera::detail {

/// A box in single precision; empty as it begins.
struct FloatBox {
    std::array<float, 3> lower = {
        std::numeric_limits<float>::infinity(),
        std::numeric_limits<float>::infinity(),
        std::numeric_limits<float>::infinity()};
    std::array<float, 3> upper = {
        -std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()};
};

/// Half the surface: lines meet a convex box with a probability in proportion to it.
inline float surface(const FloatBox& box) {
    const float x = box.upper[0] - box.lower[0];
    const float y = box.upper[1] - box.lower[1];
    const float z = box.upper[2] - box.lower[2];
    return x * y + y * z + z * x;
}

/// What a tree of boxes is made of: something in a box. In memory, what is neither of the box's
/// corners stands behind each: registers of four numbers are loaded.
struct alignas(16) BoxReference {
    std::array<float, 3> lower = FloatBox{}.lower;
    std::uint32_t element = 0;
    std::array<float, 3> upper = FloatBox{}.upper;
    /// Only what is of one kind stands together in a leaf.
    std::uint32_t kind = 0;

    FloatBox box() const { return {lower, upper}; }
};

/// A tree whose leaves are blocks of references that follow each other: a block's first() is the
/// number of its first reference, and its kind() is how many there are, less one.
struct BoxTree {
    std::vector<WideNode> nodes; ///< the first is the root; none where there are no references
    std::vector<BoxReference> references;
    std::size_t leaves = 0;
    std::size_t levels = 0;
};

/// How much work is put into a tree.
enum class TreeEffort : std::uint8_t {
    usual,
    high ///< what does not stand well where cuts have put it is moved
};

/// Puts the references into a tree with leaves of at most leaf_size (1 to 8) of them: the same
/// whatever the number of threads. contents are half of the surface of each element, by its number,
/// which tells how likely a ray meets it; where there are none, that of its box is taken. Throws
/// Cancelled; std::length_error where there are too many references for TreeChild.
BoxTree build_box_tree(
    std::vector<BoxReference> references,
    std::size_t leaf_size,
    const CancelFlag* cancel,
    TreeEffort effort = TreeEffort::usual,
    std::span<const float> contents = {});

} // namespace vera::detail
