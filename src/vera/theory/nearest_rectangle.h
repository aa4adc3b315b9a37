// SPDX-License-Identifier: Apache-2.0
// What searches for the first rectangle on a ray know, whatever trees they go through: what is
// found, and so what need not be looked at.
#pragma once

#include "vera/theory/iso_rectangle.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

namespace vera {

/// What is known of a node's rectangles.
struct NearnessOfNode {
    std::int32_t lowest_z = 0;
    std::int32_t highest_z = 0;
    std::uint32_t least_number = 0;
};

NearnessOfNode
nearness_of(std::span<const IsoRectangle> rectangles, std::span<const std::uint32_t> numbers);

/// The first one of those that were taken.
class NearestRectangle {
public:
    NearestRectangle(std::span<const IsoRectangle> rectangles, const WholeRay& ray)
        : rectangles_(rectangles)
        , ray_(ray) {}

    /// Whether the node may have one that comes before.
    bool may_be_in(const NearnessOfNode& node) const {
        if (!is_ahead(ray_, ray_.direction[2] > 0 ? node.highest_z : node.lowest_z))
            return false;
        return !number_ || comes_before(nearest_z(node), node.least_number);
    }

    /// Whether the ray comes to what is ahead of the first node before that of the second.
    bool is_nearer_in(const NearnessOfNode& first, const NearnessOfNode& second) const {
        return is_nearer(ray_, nearest_z(first), nearest_z(second));
    }

    /// Of one that the ray meets.
    void take(std::uint32_t number) {
        if (!number_ || comes_before(rectangles_[number].z, number))
            number_ = number;
    }

    std::optional<std::uint32_t> number() const { return number_; }

private:
    std::int32_t nearest_z(const NearnessOfNode& node) const {
        return ray_.direction[2] > 0 ? std::max(node.lowest_z, ray_.origin[2])
                                     : std::min(node.highest_z, ray_.origin[2]);
    }

    bool comes_before(std::int32_t z, std::uint32_t number) const {
        const std::int32_t z_of_first = rectangles_[*number_].z;
        return is_nearer(ray_, z, z_of_first) || (z == z_of_first && number < *number_);
    }

    std::span<const IsoRectangle> rectangles_;
    WholeRay ray_;
    std::optional<std::uint32_t> number_;
};

} // namespace vera
