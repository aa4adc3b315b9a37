// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace vera {

/// The numbers from 0 on in sets, each alone at first, that are joined two by two. A set is told by
/// its smallest number. Ways to it are halved whenever they are gone (Tarjan and van Leeuwen 1984).
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count)
        : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), std::uint32_t{0});
    }

    /// The smallest number of the set that this one is in.
    std::uint32_t first_of(std::uint32_t number) {
        while (parents_[number] != number)
            number = parents_[number] = parents_[parents_[number]];
        return number;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t first = first_of(a);
        const std::uint32_t second = first_of(b);
        parents_[std::max(first, second)] = std::min(first, second);
    }

private:
    std::vector<std::uint32_t> parents_;
};

} // namespace vera
