// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/line_fit.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// The integral of cos^power from 0 to the angle, by Simpson's rule.
double integral_of_cosine(double power, double angle) {
    constexpr int steps = 2000;
    double sum = 0;
    for (int i = 0; i <= steps; ++i) {
        const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
        sum += weight * std::pow(std::abs(std::cos(angle * i / steps)), power);
    }
    return sum * angle / steps / 3;
}

/// How likely Student's t lies within so much of 0: with t = sqrt(freedom) tan u, its density is
/// cos^(freedom - 1) u but for a factor.
double probability_within(double t, double freedom) {
    return integral_of_cosine(freedom - 1, std::atan(t / std::sqrt(freedom)))
        / integral_of_cosine(freedom - 1, std::numbers::pi / 2);
}

TEST(LineFit, IsThatOfAnscombesFirstSet) {
    // Anscombe 1973: the line y = 3 + x / 2 to three digits, and R^2 = 0.67.
    const std::vector<double> xs = {10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5};
    const std::vector<double> ys = {
        8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
    const LineFit fit = line_fit(xs, ys);
    EXPECT_NEAR(fit.slope, 0.5000909, 1e-7);
    EXPECT_NEAR(fit.at(0), 3.0000909, 1e-7);
    EXPECT_NEAR(fit.left, 13.76269, 1e-5);
    EXPECT_NEAR(1 - fit.left / fit.total, 0.6665425, 1e-7);
    EXPECT_EQ(fit.spread, 110);
}

TEST(LineFit, LeavesNothingOfPointsOnALine) {
    const LineFit fit = line_fit(std::vector<double>{1, 2, 4}, std::vector<double>{5, 7, 11});
    EXPECT_NEAR(fit.slope, 2, 1e-14);
    EXPECT_NEAR(fit.left, 0, 1e-28);
}

TEST(LineFit, TakesPointsOfDifferentX) {
    EXPECT_THROW(
        line_fit(std::vector<double>{0.1, 0.1, 0.1}, std::vector<double>{1, 2, 3}),
        std::invalid_argument);
}

TEST(LineFit, KnowsStudentsDistribution) {
    for (std::size_t freedom = 1; freedom <= 30; ++freedom) {
        const auto v = static_cast<double>(freedom);
        EXPECT_NEAR(probability_within(student_both_ways(freedom), v), 0.95, 5e-5) << freedom;
        EXPECT_NEAR(probability_within(student_one_way(freedom), v), 0.90, 1e-4) << freedom;
    }
    EXPECT_EQ(student_both_ways(1000), student_both_ways(30));
}

} // namespace
} // namespace vera
