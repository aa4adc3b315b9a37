// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/packed_point.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// Numbers points in the order in which they come, equal ones alike.
class PointNumbers {
public:
    /// Of points numbers all that are there before, which differ from each other, and takes those
    /// that follow. There may be no more than `most` in all.
    PointNumbers(std::vector<PackedPoint>& points, std::size_t most)
        : points_(points) {
        start(most);
    }

    /// Anew, in the room that there is: numbers what is now among the points.
    void start(std::size_t most) {
        std::size_t size = 16;
        while (size < 2 * most)
            size *= 2;
        places_.assign(size, none);
        for (std::uint32_t i = 0; i < points_.size(); ++i)
            places_[place_of(points_[i])] = i;
    }

    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// Of a point that was numbered; none of others.
    std::uint32_t find(const PackedPoint& point) const { return places_[place_of(point)]; }

    std::uint32_t number(const PackedPoint& point) {
        const std::size_t place = place_of(point);
        if (places_[place] == none) {
            places_[place] = static_cast<std::uint32_t>(points_.size());
            points_.push_back(point);
        }
        return places_[place];
    }

private:
    /// Of an equal point, or where it is to be put.
    std::size_t place_of(const PackedPoint& point) const {
        const std::size_t mask = places_.size() - 1;
        std::size_t place = hash_of(point) & mask;
        while (places_[place] != none && !(points_[places_[place]] == point))
            place = (place + 1) & mask;
        return place;
    }

    std::vector<PackedPoint>& points_;
    std::vector<std::uint32_t> places_;
};

} // namespace vera
