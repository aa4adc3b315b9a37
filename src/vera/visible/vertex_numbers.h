// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/depth_plane.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

inline std::uint64_t hash_of(const ScreenVertex& vertex) {
    std::uint64_t hash = static_cast<std::uint64_t>(vertex.point.x) << 32U
        | static_cast<std::uint32_t>(vertex.point.y);
    hash = (hash ^ hash >> 29U) * 0x9e3779b97f4a7c15U;
    hash = (hash ^ static_cast<std::uint64_t>(vertex.nearness)) * 0xbf58476d1ce4e5b9U;
    return hash ^ hash >> 32U;
}

/// Numbers vertices, equal ones alike.
class VertexNumbers {
public:
    /// Those that are there already keep their numbers.
    explicit VertexNumbers(std::vector<ScreenVertex>& vertices)
        : vertices_(vertices)
        , places_(std::bit_ceil(std::max<std::size_t>(512, 2 * vertices.size())), none) {
        fill();
    }

    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// Of one that is there; none of others.
    std::uint32_t find(const ScreenVertex& vertex) const { return places_[place_of(vertex)]; }

    std::uint32_t number(const ScreenVertex& vertex) {
        if (2 * vertices_.size() >= places_.size())
            grow();
        const std::size_t place = place_of(vertex);
        if (places_[place] == none) {
            places_[place] = static_cast<std::uint32_t>(vertices_.size());
            vertices_.push_back(vertex);
        }
        return places_[place];
    }

private:
    std::size_t place_of(const ScreenVertex& vertex) const {
        std::size_t place = hash_of(vertex) & (places_.size() - 1);
        while (places_[place] != none && vertices_[places_[place]] != vertex)
            place = (place + 1) & (places_.size() - 1);
        return place;
    }

    void grow() {
        places_.assign(2 * places_.size(), none);
        fill();
    }

    void fill() {
        for (std::uint32_t i = 0; i < vertices_.size(); ++i)
            places_[place_of(vertices_[i])] = i;
    }

    std::vector<ScreenVertex>& vertices_;
    std::vector<std::uint32_t> places_;
};

} // namespace vera
