// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/box_tree.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace vera::detail {

/// A box for registers: the lower corner, and then the upper one negated, so that a minimum of all
/// eight numbers makes a box that holds two. The fourth and the last mean nothing.
struct alignas(32) RegisterBox {
    std::array<float, 8> numbers;

    float lower(std::size_t axis) const { return numbers[axis]; }

    float upper(std::size_t axis) const { return -numbers[4 + axis]; }

    FloatBox box() const {
        return {{lower(0), lower(1), lower(2)}, {upper(0), upper(1), upper(2)}};
    }
};

constexpr RegisterBox empty_box = [] {
    RegisterBox box = {};
    box.numbers.fill(std::numeric_limits<float>::infinity());
    return box;
}();

/// Grows the box by another.
inline void include(RegisterBox& box, const RegisterBox& more) {
    for (std::size_t i = 0; i < 8; ++i)
        box.numbers[i] = std::min(box.numbers[i], more.numbers[i]);
}

constexpr std::size_t most_bins = 16;

/// Into which bin, along each axis, a doubled middle falls.
struct alignas(16) Binning {
    std::array<float, 4> start = {};
    std::array<float, 4> bins_per_unit = {}; ///< 0 along an axis where all are in one place
    std::size_t count = 0;                   ///< of the bins: at most most_bins

    /// For so many references, of which the middles lie in a box.
    Binning(std::size_t references, const RegisterBox& middles)
        // Few are told apart by fewer bins nearly as well.
        : count(std::min(most_bins, 4 + references / 16)) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            start[axis] = middles.lower(axis);
            const float length = middles.upper(axis) - start[axis];
            bins_per_unit[axis] = length > 0 ? static_cast<float>(count) / length : 0;
        }
        // Fourth are the numbers of elements, as floats so small that some processors are slow at
        // multiplying them.
        start[3] = 1;
    }
};

/// The references of a range sorted by their middles: of each bin, along each axis, the box of
/// those that fall into it, and how many they are.
struct Bins {
    std::array<std::array<RegisterBox, 3>, most_bins> boxes;
    std::array<std::array<std::int32_t, 4>, most_bins> counts;
};

/// A cut before a bin of an axis, and the boxes on its sides.
struct Cut {
    std::size_t axis = 3; ///< 3 where there is none
    std::size_t bin = 0;
    RegisterBox left = empty_box;
    RegisterBox right = empty_box;
};

/// What holds the middles of those on each side of a cut, and how many are on the left.
struct Sides {
    RegisterBox left = empty_box;
    RegisterBox right = empty_box;
    std::size_t left_count = 0;
};

/// Grows the boxes by those of the references and by their doubled middles.
void include(std::span<const BoxReference> references, RegisterBox& box, RegisterBox& middles);

/// Sorts the references into the first bins, as many as there are; they need not be filled in
/// before.
void fill_bins(std::span<const BoxReference> references, const Binning& binning, Bins& bins);

/// The cut with the least sum of its sides' surfaces, each times what is on the side.
Cut best_cut(const Bins& bins, const Binning& binning);

/// Brings the references on the left of the cut to the front.
Sides take_sides(std::span<BoxReference> references, const Binning& binning, const Cut& cut);

} // namespace vera::detail
