// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/growth.h"
#include "vera/theory/residual_bootstrap.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

const std::vector<double> four_sizes = {64, 128, 256, 512};

/// Powers of 2 by a half, times factors of few values.
std::vector<double> noisy_counts(std::span<const double> sizes, std::mt19937& random) {
    const double factors[] = {1, 1, 1.25, 0.8, 2};
    std::vector<double> counts;
    for (const double size : sizes)
        counts.push_back(std::sqrt(size) * factors[random() % 5]);
    return counts;
}

/// Of all ways to draw four of four residuals, refitted each; ascending. The leverage of each is
/// by its definition.
std::vector<double>
all_exponents(const std::vector<double>& sizes, const std::vector<double>& counts) {
    const Growth fit = growth(sizes, counts);
    const auto fitted = [&](std::size_t i) {
        return std::log2(fit.factor) + fit.exponent * std::log2(sizes[i]);
    };
    std::vector<double> residuals;
    double mean = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        // The logarithms of the sizes are 1.5 and 0.5 from their mean, with squares of sum 5.
        const double leverage = i == 0 || i == 3 ? 0.25 + 2.25 / 5 : 0.25 + 0.25 / 5;
        residuals.push_back((std::log2(counts[i]) - fitted(i)) / std::sqrt(1 - leverage));
        mean += residuals.back() / 4;
    }
    std::vector<double> exponents;
    for (std::size_t drawn = 0; drawn < 256; ++drawn) {
        std::vector<double> resampled;
        for (std::size_t i = 0; i < 4; ++i)
            resampled.push_back(std::exp2(fitted(i) + residuals[drawn >> (2 * i) & 3] - mean));
        exponents.push_back(growth(sizes, resampled).exponent);
    }
    std::sort(exponents.begin(), exponents.end());
    return exponents;
}

/// Whether as many of all exponents are below as are to be, within what chance makes of 2000.
void expect_quantile(double value, std::span<const double> all, double part) {
    constexpr double chance = 0.015;
    const auto at = [&](double where) {
        return all[static_cast<std::size_t>(
            std::clamp(where, 0.0, 1.0) * static_cast<double>(all.size() - 1))];
    };
    constexpr double rounding = 1e-9;
    EXPECT_GE(value, at(part - chance) - rounding) << part;
    EXPECT_LE(value, at(part + chance) + rounding) << part;
}

TEST(ResidualBootstrap, HasTheQuantilesOfAllResamples) {
    std::mt19937 random(5);
    for (int round = 0; round < 40; ++round) {
        const std::vector<double> counts = noisy_counts(four_sizes, random);
        const std::vector<double> all = all_exponents(four_sizes, counts);
        const ResampledGrowth found = resampled_growth(four_sizes, counts);
        expect_quantile(found.both_ways.lower, all, 0.025);
        expect_quantile(found.both_ways.upper, all, 0.975);
        expect_quantile(found.one_way.lower, all, 0.05);
        expect_quantile(found.one_way.upper, all, 0.95);
        EXPECT_LE(found.both_ways.lower, found.one_way.lower);
        EXPECT_GE(found.both_ways.upper, found.one_way.upper);
    }
}

TEST(ResidualBootstrap, AgreesWithStudentWhereThereAreManySizes) {
    std::mt19937 random(7);
    std::vector<double> sizes;
    for (int i = 0; i < 60; ++i)
        sizes.push_back(64 * std::exp2(i / 8.0));
    const std::vector<double> counts = noisy_counts(sizes, random);
    const Growth fit = growth(sizes, counts);
    const Interval found = resampled_growth(sizes, counts).both_ways;
    EXPECT_NEAR(found.lower, fit.exponent - fit.half_interval, 0.15 * fit.half_interval);
    EXPECT_NEAR(found.upper, fit.exponent + fit.half_interval, 0.15 * fit.half_interval);
}

TEST(ResidualBootstrap, IsNarrowerThanStudentOfFewSizes) {
    const std::vector<double> counts = {8, 14, 17, 20};
    const Growth fit = growth(four_sizes, counts);
    const Interval found = resampled_growth(four_sizes, counts).both_ways;
    EXPECT_LT(found.upper - found.lower, 2 * fit.half_interval);
    EXPECT_LT(found.lower, fit.exponent);
    EXPECT_GT(found.upper, fit.exponent);
}

TEST(ResidualBootstrap, IsTheSameForTheSameSeed) {
    const std::vector<double> counts = {8, 14, 17, 20};
    const Interval once = resampled_growth(four_sizes, counts, 100, 3).both_ways;
    const Interval again = resampled_growth(four_sizes, counts, 100, 3).both_ways;
    const Interval other = resampled_growth(four_sizes, counts, 100, 4).both_ways;
    EXPECT_EQ(once.lower, again.lower);
    EXPECT_EQ(once.upper, again.upper);
    EXPECT_TRUE(once.lower != other.lower || once.upper != other.upper);
}

TEST(ResidualBootstrap, OfAPowerAloneIsAPoint) {
    const std::vector<double> counts = {64, 128, 256, 512};
    const Interval found = resampled_growth(four_sizes, counts).both_ways;
    EXPECT_NEAR(found.lower, 1, 1e-12);
    EXPECT_NEAR(found.upper, 1, 1e-12);
}

TEST(ResidualBootstrap, KnowsThatOneSizeAloneIsFollowed) {
    // Whatever is counted at the last size, the line goes through it: only the others vary.
    const std::vector<double> sizes = {64, 64, 64, 512};
    const std::vector<double> counts = {8, 16, 32, 128};
    const Interval found = resampled_growth(sizes, counts).both_ways;
    // By hand: -1, 0 and 1 are left at the first size, with a leverage of 1/3, and 0 at the last.
    // The line moves most, by 4.5 / 6.75, where the first three have the one and the last the
    // other.
    const double most = std::sqrt(1.5) * 4.5 / 6.75;
    EXPECT_GE(found.lower, 1 - most - 1e-12);
    EXPECT_LE(found.upper, 1 + most + 1e-12);
    EXPECT_LT(found.lower, 1 - most / 2);
    EXPECT_GT(found.upper, 1 + most / 2);
}

TEST(ResidualBootstrap, RefusesTooFewResamples) {
    EXPECT_THROW(resampled_growth(four_sizes, four_sizes, 39), std::invalid_argument);
}

} // namespace
} // namespace vera
