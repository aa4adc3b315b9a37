// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace vera {

/// A place in a pixel, as parts of its width from the left and of its height from the top.
struct SamplePosition {
    double across = 0.5;
    double down = 0.5;
};

/// The samples of a pixel. The first 2^k of them are a (0, k, 2)-net for each k: every rectangle of
/// 2^a by 2^b equal parts, a + b = k, holds one. Each pixel has a net of its own.
class SampleNet {
public:
    explicit SampleNet(std::uint64_t pixel);

    SamplePosition operator[](std::uint32_t i) const;

private:
    std::uint64_t across_seed_;
    std::uint64_t down_seed_;
};

/// One place in each pixel, so that those of neighbours along rows, columns and diagonals are
/// spread evenly.
SamplePosition probe_position(std::size_t x, std::size_t y);

} // namespace vera
