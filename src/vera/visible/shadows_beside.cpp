// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/shadows_beside.h"

#include "vera/visible/seen_beside.h"

#include <algorithm>

namespace vera {

void ShadowsBeside::start() {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    covering_.assign(keys_.size(), {});
    sources_.clear();
    for (std::uint32_t i = 0; i < keys_.size(); ++i)
        if (i == 0 || keys_[i].source != keys_[i - 1].source)
            sources_.push_back({keys_[i].source, i});
    sources_.push_back({no_source, static_cast<std::uint32_t>(keys_.size())});
    parted_ = 0;
}

/// The source, or an end where no shadow on it was expected.
std::size_t ShadowsBeside::place_of(std::uint32_t source) const {
    const auto place =
        std::partition_point(sources_.begin(), sources_.end() - 1, [&](const Source& one) {
            ++steps_;
            return one.source < source;
        });
    return place->source == source ? static_cast<std::size_t>(place - sources_.begin())
                                   : sources_.size() - 1;
}

void ShadowsBeside::change(const ScreenTriangle& triangle, std::uint8_t sides, std::int32_t more) {
    const std::size_t place = place_of(triangle.source);
    if (place + 1 == sources_.size())
        return;
    Source& source = sources_[place];
    parted_ -= source.is_parted() ? 1 : 0;
    if (triangle.is_shadow()) {
        std::uint32_t key = source.first;
        for (; keys_[key].light != triangle.light; ++key)
            ++steps_;
        std::array<std::int32_t, 2>& covering = covering_[key];
        const auto is_parted = [&] { return (covering[0] > 0) != (covering[1] > 0) ? 1 : 0; };
        source.parted -= is_parted();
        covering[0] += (sides & left_side) != 0 ? more : 0;
        covering[1] += (sides & right_side) != 0 ? more : 0;
        source.parted += is_parted();
    } else {
        source.surfaces += more;
    }
    parted_ += source.is_parted() ? 1 : 0;
}

LightSet ShadowsBeside::lights(std::uint32_t source, std::uint8_t side) const {
    const std::size_t place = place_of(source);
    LightSet lights = 0;
    if (place + 1 == sources_.size())
        return lights;
    for (std::uint32_t key = sources_[place].first; key < sources_[place + 1].first;
         ++key, ++steps_)
        if (covering_[key][side == left_side ? 0 : 1] > 0)
            lights |= LightSet{1} << keys_[key].light;
    return lights;
}

} // namespace vera
