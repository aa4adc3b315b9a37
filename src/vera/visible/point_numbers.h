// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/screen_point.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

inline std::uint64_t hash_of(const RationalPoint& point) {
    std::uint64_t hash = 0;
    const auto mix = [&](std::uint64_t value) {
        hash = (hash ^ value) * 0x9e3779b97f4a7c15U;
        hash ^= hash >> 32U;
    };
    mix(static_cast<std::uint64_t>(point.whole.x) << 32U
        | static_cast<std::uint32_t>(point.whole.y));
    mix(static_cast<std::uint64_t>(point.x_numerator));
    mix(static_cast<std::uint64_t>(point.y_numerator));
    mix(static_cast<std::uint64_t>(point.denominator));
    return hash;
}

/// Numbers points in the order in which they come, equal ones alike.
class PointNumbers {
public:
    /// Of points numbers all that are there before, which differ from each other, and takes those
    /// that follow. There may be no more than `most` in all.
    PointNumbers(std::vector<RationalPoint>& points, std::size_t most)
        : points_(points) {
        std::size_t size = 16;
        while (size < 2 * most)
            size *= 2;
        places_.assign(size, none);
        for (std::uint32_t i = 0; i < points.size(); ++i)
            places_[place_of(points[i])] = i;
    }

    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// Of a point that was numbered; none of others.
    std::uint32_t find(const RationalPoint& point) const { return places_[place_of(point)]; }

    std::uint32_t number(const RationalPoint& point) {
        const std::size_t place = place_of(point);
        if (places_[place] == none) {
            places_[place] = static_cast<std::uint32_t>(points_.size());
            points_.push_back(point);
        }
        return places_[place];
    }

private:
    /// Of an equal point, or where it is to be put.
    std::size_t place_of(const RationalPoint& point) const {
        const std::size_t mask = places_.size() - 1;
        std::size_t place = hash_of(point) & mask;
        while (places_[place] != none && !(points_[places_[place]] == point))
            place = (place + 1) & mask;
        return place;
    }

    std::vector<RationalPoint>& points_;
    std::vector<std::uint32_t> places_;
};

} // namespace vera
