// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image_difference.h"

#include "vera/base/check.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace vera {

namespace {

using Samples = std::vector<std::uint8_t>;

const Samples& samples_of(const Image& image) {
    VERA_CHECK(sample_type(image) == SampleType::integer8);
    return std::get<Samples>(image.samples);
}

constexpr int most_levels = 256;
constexpr int largest_factor = 16;

/// The largest power of two that makes at most 1 of 10 differences too large to be shown, given
/// how often each difference occurs.
int amplification(const std::array<std::size_t, most_levels>& counts) {
    std::size_t differing = 0;
    for (std::size_t level = 1; level < counts.size(); ++level)
        differing += counts[level];
    int factor = 1;
    while (differing > 0 && factor < largest_factor) {
        std::size_t clipped = 0;
        for (int level = most_levels / (2 * factor); level < most_levels; ++level)
            clipped += counts[static_cast<std::size_t>(level)];
        if (clipped * 10 > differing)
            break;
        factor *= 2;
    }
    return factor;
}

} // namespace

ImageDifference difference(const Image& first, const Image& second) {
    const Samples& before = samples_of(first);
    const Samples& after = samples_of(second);
    VERA_CHECK(first.width == second.width && first.height == second.height);

    ImageDifference result;
    result.image = {first.width, first.height, Samples(before.size())};
    auto& samples = std::get<Samples>(result.image.samples);
    std::array<std::size_t, most_levels> counts = {};
    std::size_t sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const int apart = std::abs(before[i] - after[i]);
        samples[i] = static_cast<std::uint8_t>(apart);
        ++counts[static_cast<std::size_t>(apart)];
        sum += static_cast<std::size_t>(apart);
        result.largest = std::max(result.largest, apart);
    }
    for (std::size_t i = 0; i < samples.size(); i += 3)
        if (samples[i] != 0 || samples[i + 1] != 0 || samples[i + 2] != 0)
            ++result.changed_pixels;
    if (!samples.empty())
        result.mean = static_cast<double>(sum) / static_cast<double>(samples.size());
    result.factor = amplification(counts);
    for (std::uint8_t& sample : samples)
        sample = static_cast<std::uint8_t>(std::min(sample * result.factor, most_levels - 1));
    return result;
}

} // namespace vera
