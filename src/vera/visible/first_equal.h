// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/long_loop.h"
#include "vera/base/unfilled_vector.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Of each of `count` things the number of the first that equals it. hash_of(i) has 64 bits, all of
/// which should differ. Things are parted by their hashes first (radix join: Shatdal, Kant and
/// Naughton 1994): each part fits into a cache, and threads share them. Takes 12 bytes a thing.
/// Throws Cancelled.
template <typename HashOf, typename AreEqual>
UnfilledVector<std::uint32_t> first_equal(
    std::size_t count,
    const HashOf& hash_of,
    const AreEqual& are_equal,
    const CancelFlag* cancel = nullptr) {
    struct Hashed {
        std::uint32_t hash;
        std::uint32_t number;
    };

    constexpr std::size_t most_of_a_part = 4096;
    constexpr std::size_t block = 32768; // things whose parts are counted together
    const int part_bits =
        std::clamp(static_cast<int>(std::bit_width(count / most_of_a_part)), 0, 12);
    const std::size_t parts = std::size_t{1} << part_bits;
    const std::size_t blocks = (count + block - 1) / block;
    const auto part_of = [&](std::uint64_t hash) {
        return part_bits == 0 ? 0 : static_cast<std::size_t>(hash >> (64 - part_bits));
    };
    const auto for_each_in_block = [&](std::size_t number, const auto& visit) {
        stop_if_raised(cancel);
        for (std::size_t i = number * block; i < std::min(count, (number + 1) * block); ++i)
            visit(i, hash_of(i));
    };
    // By part and block within it: each part's things stay in their order.
    std::vector<std::size_t> starts(parts * blocks + 1);
    parallel_ranges(blocks, 1, [&](std::size_t number, std::size_t) {
        for_each_in_block(number, [&](std::size_t, std::uint64_t hash) {
            ++starts[part_of(hash) * blocks + number + 1];
        });
    });
    for (std::size_t i = 1; i < starts.size(); ++i)
        starts[i] += starts[i - 1];
    UnfilledVector<Hashed> parted(count);
    std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
    parallel_ranges(blocks, 1, [&](std::size_t number, std::size_t) {
        for_each_in_block(number, [&](std::size_t i, std::uint64_t hash) {
            parted[next[part_of(hash) * blocks + number]++] = {
                static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(i)};
        });
    });
    UnfilledVector<std::uint32_t> first(count);
    parallel_ranges(parts, 8, [&](std::size_t begin, std::size_t end) {
        constexpr std::uint32_t none = ~std::uint32_t{0};
        std::vector<std::uint32_t> places; // in parted
        for (std::size_t part = begin; part < end; ++part) {
            stop_if_raised(cancel);
            const std::size_t from = starts[part * blocks];
            const std::size_t to = starts[(part + 1) * blocks];
            places.assign(std::bit_ceil(2 * (to - from) + 1), none);
            const std::size_t mask = places.size() - 1;
            for (std::size_t i = from; i < to; ++i) {
                const Hashed& here = parted[i];
                std::size_t place = here.hash & mask;
                while (places[place] != none) {
                    const Hashed& there = parted[from + places[place]];
                    if (there.hash == here.hash && are_equal(there.number, here.number))
                        break;
                    place = (place + 1) & mask;
                }
                if (places[place] == none)
                    places[place] = static_cast<std::uint32_t>(i - from);
                first[here.number] = parted[from + places[place]].number;
            }
        }
    });
    return first;
}

/// Makes of what first_equal() returned consecutive numbers in the order of the first ones;
/// returns the number of each of those.
inline std::vector<std::uint32_t> number_consecutively(std::span<std::uint32_t> first) {
    std::vector<std::uint32_t> firsts;
    for (std::uint32_t i = 0; i < first.size(); ++i) {
        if (first[i] == i) {
            first[i] = static_cast<std::uint32_t>(firsts.size());
            firsts.push_back(i);
        } else {
            first[i] = first[first[i]];
        }
    }
    return firsts;
}

} // namespace vera
