// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_numbers.h"

#include <algorithm>

namespace vera {

void RegionNumbers::add(const VisibleMap::Region& region) {
    constexpr std::size_t few = 8;
    if (region.source >= first_.size())
        first_.resize(region.source + std::size_t{1}, none);
    std::size_t count = 0;
    for (std::uint32_t i = first_[region.source]; i != none; i = listed_[i].next, ++count)
        if (listed_[i].unlit == region.unlit)
            return;
    if (count >= few) {
        others_.emplace(region, 0);
        return;
    }
    listed_.push_back({region.unlit, first_[region.source]});
    first_[region.source] = static_cast<std::uint32_t>(listed_.size() - 1);
}

std::vector<VisibleMap::Region> RegionNumbers::numbered() {
    std::vector<VisibleMap::Region> others;
    others.reserve(others_.size());
    for (const auto& [region, number] : others_)
        others.push_back(region);
    std::sort(others.begin(), others.end());
    auto next_other = others.begin();
    std::vector<VisibleMap::Region> regions;
    regions.reserve(listed_.size() + others.size());
    for (std::uint32_t source = 0; source < first_.size(); ++source) {
        const auto of_source = static_cast<std::ptrdiff_t>(regions.size());
        for (std::uint32_t i = first_[source]; i != none; i = listed_[i].next)
            regions.push_back({source, listed_[i].unlit});
        for (; next_other != others.end() && next_other->source == source; ++next_other)
            regions.push_back(*next_other);
        const auto begin = regions.begin() + of_source;
        std::sort(begin, regions.end());
        for (std::uint32_t i = first_[source]; i != none; i = listed_[i].next) {
            const VisibleMap::Region region = {source, listed_[i].unlit};
            const auto found = std::lower_bound(begin, regions.end(), region);
            listed_[i].number = static_cast<std::uint32_t>(found - regions.begin());
        }
    }
    for (auto& [region, number] : others_) {
        const auto found = std::lower_bound(regions.begin(), regions.end(), region);
        number = static_cast<std::uint32_t>(found - regions.begin());
    }
    return regions;
}

std::uint32_t RegionNumbers::number(const VisibleMap::Region& region) const {
    for (std::uint32_t i = first_[region.source]; i != none; i = listed_[i].next)
        if (listed_[i].unlit == region.unlit)
            return listed_[i].number;
    return others_.at(region);
}

} // namespace vera
