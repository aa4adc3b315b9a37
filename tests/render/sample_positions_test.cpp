// SPDX-License-Identifier: Apache-2.0
#include "vera/render/sample_positions.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(SamplePositions, HoldOneInEveryElementaryRectangle) {
    for (const std::uint64_t pixel : {0ULL, 1ULL, 77ULL, 262143ULL, 1ULL << 40})
        for (std::uint32_t digits = 1; digits <= 8; ++digits)
            for (std::uint32_t across_digits = 0; across_digits <= digits; ++across_digits) {
                const std::uint32_t columns = 1U << across_digits;
                const std::uint32_t rows = 1U << (digits - across_digits);
                std::vector<int> count(std::size_t{columns} * rows);
                for (std::uint32_t i = 0; i < (1U << digits); ++i) {
                    const SamplePosition position = SampleNet(pixel)[i];
                    ASSERT_GE(position.across, 0);
                    ASSERT_LT(position.across, 1);
                    ASSERT_GE(position.down, 0);
                    ASSERT_LT(position.down, 1);
                    const auto column = static_cast<std::uint32_t>(position.across * columns);
                    const auto row = static_cast<std::uint32_t>(position.down * rows);
                    ++count[row * columns + column];
                }
                ASSERT_EQ(std::count(count.begin(), count.end(), 1), columns * rows)
                    << "pixel " << pixel << ", " << columns << " x " << rows;
            }
}

TEST(SamplePositions, DifferFromPixelToPixel) {
    EXPECT_NE(SampleNet(0)[0].across, SampleNet(1)[0].across);
    EXPECT_NE(SampleNet(0)[0].down, SampleNet(1)[0].down);
}

TEST(SamplePositions, OfAPixelFillItsSquareOnAverage) {
    double across = 0;
    double down = 0;
    double product = 0;
    constexpr int pixels = 20000;
    for (int pixel = 0; pixel < pixels; ++pixel) {
        const SamplePosition position = SampleNet(static_cast<std::uint64_t>(pixel))[3];
        across += position.across / pixels;
        down += position.down / pixels;
        product += (position.across - 0.5) * (position.down - 0.5) / pixels;
    }
    EXPECT_NEAR(across, 0.5, 0.01);
    EXPECT_NEAR(down, 0.5, 0.01);
    EXPECT_NEAR(product, 0, 0.005);
}

/// Whether 40 probes of neighbours in that direction leave no gap of 0.1 in what they probe.
bool leaves_no_gap(std::size_t step_x, std::size_t step_y, double SamplePosition::*coordinate) {
    std::vector<double> values = {0, 1};
    for (std::size_t i = 0; i < 40; ++i)
        values.push_back(probe_position(100 + i * step_x, 200 + i * step_y).*coordinate);
    std::sort(values.begin(), values.end());
    for (std::size_t i = 1; i < values.size(); ++i)
        if (values[i] - values[i - 1] > 0.1)
            return false;
    return true;
}

TEST(ProbePositions, AreSpreadEvenlyAlongRowsColumnsAndDiagonals) {
    EXPECT_TRUE(leaves_no_gap(1, 0, &SamplePosition::down));
    EXPECT_TRUE(leaves_no_gap(1, 0, &SamplePosition::across));
    EXPECT_TRUE(leaves_no_gap(0, 1, &SamplePosition::down));
    EXPECT_TRUE(leaves_no_gap(0, 1, &SamplePosition::across));
    EXPECT_TRUE(leaves_no_gap(1, 1, &SamplePosition::down));
    EXPECT_TRUE(leaves_no_gap(1, 1, &SamplePosition::across));
}

} // namespace
} // namespace vera
