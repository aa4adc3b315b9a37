// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/random.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vera {

/// Numbers regions in ascending order. Most sources are seen in few sets of lights, and are found
/// without hashing; one below the shadows of many lights may be in as many as there are regions.
class RegionNumbers {
public:
    void add(const VisibleMap::Region& region);

    /// All that were added, once. Nothing may be added after that.
    std::vector<VisibleMap::Region> numbered();

    /// Of one that was added, when all are numbered.
    std::uint32_t number(const VisibleMap::Region& region) const;

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    struct Listed {
        LightSet unlit = 0;
        std::uint32_t next = none; ///< of the same source
        std::uint32_t number = 0;
    };

    struct Hash {
        std::size_t operator()(const VisibleMap::Region& region) const {
            return scrambled_bits((std::uint64_t{region.source} << 32U) ^ region.unlit);
        }
    };

    std::vector<std::uint32_t> first_; ///< of each source
    std::vector<Listed> listed_;       ///< the first few of each source
    std::unordered_map<VisibleMap::Region, std::uint32_t, Hash> others_; ///< and their numbers
};

} // namespace vera
