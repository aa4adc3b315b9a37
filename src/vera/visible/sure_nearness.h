// SPDX-License-Identifier: Apache-2.0
// Which of several triangles others surely hide all along a way, whatever else there is: those that
// are farther at both of its ends. Of points in a plane, the ones that others exceed in both
// coordinates (Kung, Luccio and Preparata, On finding the maxima of a set of vectors, 1975).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Between what a triangle's nearness lies at the first and at the last place of a way.
struct SureNearness {
    std::array<double, 2> least = {};
    std::array<double, 2> most = {};

    bool hides(const SureNearness& other) const {
        return least[0] > other.most[0] && least[1] > other.most[1];
    }
};

/// Tells of many at a time; keeps its room from call to call.
class HiddenOfMany {
public:
    /// Of each whether another one hides it, until this is asked again. Takes n log n steps.
    const std::vector<std::uint8_t>& hidden(std::span<const SureNearness> all);

    /// Comparisons of two, in all.
    std::uint64_t steps() const { return steps_; }

private:
    void look_at_pairs(std::span<const SureNearness> all);
    void sweep(std::span<const SureNearness> all);

    std::vector<std::uint8_t> is_hidden_;
    std::vector<std::uint32_t> by_least_; ///< at the first place, the nearest one first
    std::vector<std::uint32_t> by_most_;
    std::uint64_t steps_ = 0;
};

} // namespace vera
