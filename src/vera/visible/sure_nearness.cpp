// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/sure_nearness.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace vera {

const std::vector<std::uint8_t>& HiddenOfMany::hidden(std::span<const SureNearness> all) {
    constexpr std::size_t few = 16; // for which sorting takes longer
    is_hidden_.assign(all.size(), 0);
    if (all.size() <= few)
        look_at_pairs(all);
    else
        sweep(all);
    return is_hidden_;
}

void HiddenOfMany::look_at_pairs(std::span<const SureNearness> all) {
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = 0; j < all.size() && is_hidden_[i] == 0; ++j, ++steps_)
            is_hidden_[i] = all[j].hides(all[i]) ? 1 : 0;
}

/// Those that are nearer than one at the first place are a beginning of the list by the least
/// nearness there; one of them hides it if the nearest of them at the last place does.
void HiddenOfMany::sweep(std::span<const SureNearness> all) {
    by_least_.resize(all.size());
    std::iota(by_least_.begin(), by_least_.end(), 0U);
    by_most_ = by_least_;
    std::sort(by_least_.begin(), by_least_.end(), [&](std::uint32_t a, std::uint32_t b) {
        ++steps_;
        return all[a].least[0] > all[b].least[0];
    });
    std::sort(by_most_.begin(), by_most_.end(), [&](std::uint32_t a, std::uint32_t b) {
        ++steps_;
        return all[a].most[0] > all[b].most[0];
    });
    double nearest = -std::numeric_limits<double>::infinity(); // at the last place
    std::size_t next = 0;
    for (const std::uint32_t i : by_most_) {
        for (; next < all.size() && all[by_least_[next]].least[0] > all[i].most[0];
             ++next, ++steps_)
            nearest = std::max(nearest, all[by_least_[next]].least[1]);
        is_hidden_[i] = nearest > all[i].most[1] ? 1 : 0;
    }
}

} // namespace vera
