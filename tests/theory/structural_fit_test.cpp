// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/line_fit.h"
#include "vera/theory/structural_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr std::size_t terms = 3;

/// Of few values, among which terms are often 0, equal, or multiples of each other.
std::vector<TermRow> rows_of_few_values(std::mt19937& random) {
    std::vector<TermRow> rows;
    for (std::size_t i = 0; i < 5; ++i) {
        TermRow row = {1 + static_cast<double>(random() % 4), {}};
        for (std::size_t term = 0; term < terms; ++term)
            row.terms.push_back(static_cast<double>(random() % 4));
        rows.push_back(row);
    }
    return rows;
}

/// The sum of the squares of the relative errors.
double square_left(std::span<const TermRow> rows, const std::array<double, terms>& c) {
    double sum = 0;
    for (const TermRow& row : rows) {
        double rest = 1;
        for (std::size_t term = 0; term < terms; ++term)
            rest -= c.at(term) * row.terms[term] / row.count;
        sum += rest * rest;
    }
    return sum;
}

double scaled_dot(std::span<const TermRow> rows, std::size_t a, std::size_t b) {
    double sum = 0;
    for (const TermRow& row : rows)
        sum += row.terms[a] * row.terms[b] / (row.count * row.count);
    return sum;
}

double scaled_sum(std::span<const TermRow> rows, std::size_t a) {
    double sum = 0;
    for (const TermRow& row : rows)
        sum += row.terms[a] / row.count;
    return sum;
}

/// Least squares of those terms that are not held at 0, by Cramer's rule; nothing where they depend
/// on each other.
std::optional<std::array<double, terms>>
free_solution(std::span<const TermRow> rows, unsigned free) {
    std::array<std::array<double, terms>, terms> matrix = {};
    std::array<double, terms> right = {};
    for (std::size_t a = 0; a < terms; ++a) {
        for (std::size_t b = 0; b < terms; ++b)
            matrix.at(a).at(b) = (free >> a & free >> b & 1U) != 0 ? scaled_dot(rows, a, b)
                : a == b                                           ? 1
                                                                   : 0;
        right.at(a) = (free >> a & 1U) != 0 ? scaled_sum(rows, a) : 0;
    }
    const auto determinant = [](const auto& m) {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    const double whole = determinant(matrix);
    if (std::abs(whole) < 1e-9)
        return std::nullopt;
    std::array<double, terms> found = {};
    for (std::size_t a = 0; a < terms; ++a) {
        auto replaced = matrix;
        for (std::size_t b = 0; b < terms; ++b)
            replaced.at(b).at(a) = right.at(b);
        found.at(a) = determinant(replaced) / whole;
    }
    return found;
}

/// The reference: of all sets of terms above 0 that have a solution without a negative one, the one
/// that leaves least.
std::array<double, terms> best_of_all_sets(std::span<const TermRow> rows) {
    std::array<double, terms> best = {};
    for (unsigned free = 1; free < 1U << terms; ++free)
        if (const auto found = free_solution(rows, free); found
            && *std::min_element(found->begin(), found->end()) >= 0
            && square_left(rows, *found) < square_left(rows, best))
            best = *found;
    return best;
}

TEST(StructuralFit, IsTheBestOfAllSetsOfTermsAbove0) {
    std::mt19937 random(11);
    int told = 0;
    int at_0 = 0;
    for (int round = 0; round < 3000; ++round) {
        const std::vector<TermRow> rows = rows_of_few_values(random);
        const auto fit = structural_fit(rows);
        const std::array<double, terms> best = best_of_all_sets(rows);
        if (!fit) {
            EXPECT_EQ(square_left(rows, best), static_cast<double>(rows.size())); // all terms are 0
            continue;
        }
        EXPECT_NEAR(fit->error, std::sqrt(square_left(rows, best) / 5), 1e-7) << round;
        if (!free_solution(rows, 7))
            continue;
        for (std::size_t term = 0; term < terms; ++term) {
            ASSERT_TRUE(fit->coefficients[term].has_value()) << round;
            const TermCoefficient& found = *fit->coefficients[term];
            EXPECT_NEAR(found.value, best.at(term), 1e-7) << round;
            EXPECT_LE(found.lower, found.value);
            EXPECT_GE(found.upper, found.value);
            EXPECT_GE(found.lower, 0);
            ++told;
            at_0 += found.value == 0 ? 1 : 0;
        }
    }
    EXPECT_GT(at_0, 500);
    EXPECT_GT(told - at_0, 500);
}

TEST(StructuralFit, HasTheIntervalsOfTheInverseMatrix) {
    std::mt19937 random(13);
    int compared = 0;
    while (compared < 200) {
        std::vector<TermRow> rows = rows_of_few_values(random);
        for (TermRow& row : rows)
            row.terms[2] = 0;
        const double aa = scaled_dot(rows, 0, 0);
        const double ab = scaled_dot(rows, 0, 1);
        const double bb = scaled_dot(rows, 1, 1);
        const double determinant = aa * bb - ab * ab;
        const auto best = free_solution(rows, 3);
        if (!best || best->at(0) <= 0 || best->at(1) <= 0)
            continue;
        const auto fit = structural_fit(rows);
        ASSERT_TRUE(fit.has_value());
        EXPECT_FALSE(fit->coefficients[2].has_value());
        const double variance = square_left(rows, *best) / 3;
        for (const auto& [term, inverse] :
             {std::pair{0U, bb / determinant}, std::pair{1U, aa / determinant}}) {
            const double half = student_both_ways(3) * std::sqrt(variance * inverse);
            EXPECT_NEAR(fit->coefficients[term]->upper, best->at(term) + half, 1e-6);
            EXPECT_NEAR(fit->coefficients[term]->lower, std::max(best->at(term) - half, 0.0), 1e-6);
        }
        ++compared;
    }
}

TEST(StructuralFit, IsRelativeAsByHand) {
    // Terms by counts are 1, 2 and 1: c = 4/6 leaves 1/3, -1/3 and 1/3. So the variance is 1/6, the
    // error of c 1/6, and t with two degrees of freedom 4.303.
    const std::vector<TermRow> rows = {{1, {1}}, {1, {2}}, {2, {2}}};
    const auto fit = structural_fit(rows);
    ASSERT_TRUE(fit.has_value());
    EXPECT_NEAR(fit->coefficients[0]->value, 2.0 / 3, 1e-12);
    EXPECT_EQ(fit->coefficients[0]->lower, 0);
    EXPECT_NEAR(fit->coefficients[0]->upper, 2.0 / 3 + 4.303 / 6, 1e-12);
    EXPECT_NEAR(fit->error, 1.0 / 3, 1e-12);
}

TEST(StructuralFit, TellsNothingOfTermsThatAreMadeUpOfOthers) {
    // The second is twice the first, the third 0 everywhere.
    const std::vector<TermRow> rows = {
        {6, {1, 2, 0, 1}}, {8, {2, 4, 0, 1}}, {12, {4, 8, 0, 1}}, {20, {8, 16, 0, 1}}};
    const auto fit = structural_fit(rows);
    ASSERT_TRUE(fit.has_value());
    EXPECT_FALSE(fit->coefficients[0].has_value());
    EXPECT_FALSE(fit->coefficients[1].has_value());
    EXPECT_FALSE(fit->coefficients[2].has_value());
    EXPECT_NEAR(fit->coefficients[3]->value, 4, 1e-9);
    EXPECT_NEAR(fit->error, 0, 1e-9);
    // Made up but for rounding: the last is a tenth of the first and a third of the second.
    std::vector<TermRow> rounded;
    for (const auto& [a, b] : {std::pair{1.1, 2.3}, {3.7, 0.9}, {0.3, 5.1}, {2.9, 2.2}, {7.7, 0.1}})
        rounded.push_back({a + 2 * b, {a, b, a / 10 + b / 3}});
    const auto of_rounded = structural_fit(rounded);
    ASSERT_TRUE(of_rounded.has_value());
    for (const auto& coefficient : of_rounded->coefficients)
        EXPECT_FALSE(coefficient.has_value());
    EXPECT_NEAR(of_rounded->error, 0, 1e-9);
}

TEST(StructuralFit, TakesMoreRowsThanTerms) {
    EXPECT_FALSE(structural_fit(std::vector<TermRow>{{1, {1, 2}}, {2, {2, 3}}}).has_value());
    EXPECT_FALSE(structural_fit(std::vector<TermRow>{}).has_value());
    EXPECT_FALSE(structural_fit(std::vector<TermRow>{{1, {0}}, {2, {0}}}).has_value());
}

TEST(StructuralFit, RefusesWhatIsNoCountOrNoTerm) {
    EXPECT_THROW(structural_fit(std::vector<TermRow>{{0, {1}}, {1, {1}}}), std::invalid_argument);
    EXPECT_THROW(structural_fit(std::vector<TermRow>{{1, {-1}}, {1, {1}}}), std::invalid_argument);
    EXPECT_THROW(
        structural_fit(std::vector<TermRow>{{1, {1}}, {1, {1, 2}}}), std::invalid_argument);
}

TEST(StructuralFit, HasOneCoefficientWhereAllIntervalsOverlap) {
    const auto fit = [](std::optional<TermCoefficient> coefficient) {
        return StructuralFit{{coefficient}, 0};
    };
    const StructuralFit low = fit(TermCoefficient{2, 1, 3});
    const StructuralFit touching = fit(TermCoefficient{4, 3, 5});
    const StructuralFit high = fit(TermCoefficient{7, 4, 9});
    const StructuralFit untold = fit(std::nullopt);
    const auto one = [](std::vector<StructuralFit> fits) { return has_one_coefficient(fits, 0); };
    EXPECT_EQ(one({low, touching}), true);
    EXPECT_EQ(one({touching, high, untold}), true);
    EXPECT_EQ(one({low, touching, high}), false); // the first and the last do not
    EXPECT_EQ(one({low, untold}), std::nullopt);
}

} // namespace
} // namespace vera
