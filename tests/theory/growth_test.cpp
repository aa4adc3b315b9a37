// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/growth.h"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

const std::vector<double> doubled = {128, 256, 512, 1024, 2048, 4096};

TEST(Growth, IsThatOfAPowerAndTellsOneAboveTheBound) {
    std::vector<double> counts;
    for (const double size : doubled)
        counts.push_back(3 * std::pow(size, 0.75) * (counts.size() % 2 == 0 ? 1.01 : 1));
    const Growth found = growth(doubled, counts);
    EXPECT_NEAR(found.exponent, 0.75, 0.01);
    EXPECT_NEAR(found.factor, 3, 0.1);
    EXPECT_GT(found.exponent - found.uncertainty, 0.695);
    EXPECT_GT(found.uncertainty, 0);
    EXPECT_GT(found.half_interval, found.uncertainty);
    EXPECT_GT(found.r_squared, 0.99);
    EXPECT_LT(found.r_squared, 1);
}

TEST(Growth, HasTheIntervalOfStudentsDistribution) {
    // By hand: the logarithms to base 2 are 0, 1, 2 and 0, 1, 1. So the slope is 1/2, what is left
    // is 1/6, and with one degree of freedom the error is sqrt(1/6 / 1 / 2) = 0.2887.
    const Growth found = growth(std::vector<double>{1, 2, 4}, std::vector<double>{1, 2, 2});
    EXPECT_NEAR(found.exponent, 0.5, 1e-12);
    EXPECT_NEAR(found.uncertainty, 6.314 * 0.288675, 1e-4);
    EXPECT_NEAR(found.half_interval, 12.706 * 0.288675, 1e-4);
    EXPECT_NEAR(found.r_squared, 0.75, 1e-12);
}

TEST(Growth, OfWhatStaysIsNothing) {
    const Growth found = growth(doubled, std::vector<double>(doubled.size(), 7));
    EXPECT_NEAR(found.exponent, 0, 1e-15);
    EXPECT_NEAR(found.uncertainty, 0, 1e-12);
    EXPECT_EQ(found.r_squared, 1);
}

TEST(Growth, HasAnExponentFromEachSizeToTheNext) {
    EXPECT_THAT(
        local_exponents(std::vector<double>{2, 4, 16}, std::vector<double>{5, 20, 20}),
        ::testing::ElementsAre(::testing::DoubleNear(2, 1e-12), ::testing::DoubleNear(0, 1e-12)));
}

TEST(Growth, RefusesWhatTellsNothing) {
    const auto refused = [](const std::vector<double>& sizes, const std::vector<double>& counts) {
        try {
            growth(sizes, counts);
        } catch (const std::invalid_argument& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refused({1, 2}, {1, 2}), "growth is told by 3 sizes or more");
    EXPECT_EQ(refused({2, 2, 2}, {1, 2, 3}), "growth is told by different sizes");
    EXPECT_EQ(refused({1, 2, 3}, {1, 2}), "growth is that of as many counts as sizes");
    EXPECT_EQ(
        refused({1, 2, 3}, {1, 0, 2}),
        "growth is that of positive counts over positive sizes; number 2 is not");
}

} // namespace
} // namespace vera
