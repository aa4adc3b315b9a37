// SPDX-License-Identifier: Apache-2.0
#include "vera/math/bounded_least_squares.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

double square_off(const BoundedLeastSquares& problem, const std::vector<double>& x) {
    double sum = 0;
    for (std::size_t row = 0; row < problem.right.size(); ++row) {
        double off = -problem.right[row];
        for (std::size_t i = 0; i < problem.columns; ++i)
            off += problem.matrix[row * problem.columns + i] * x[i];
        sum += off * off;
    }
    return sum;
}

/// Goes from column to column to the best x there, which for such a problem leads to the only best
/// one. Slow, and plain.
std::vector<double> by_turns(const BoundedLeastSquares& problem) {
    std::vector<double> x = problem.least;
    for (int turn = 0; turn < 20000; ++turn)
        for (std::size_t i = 0; i < problem.columns; ++i) {
            double pull = 0;
            double size = 0;
            for (std::size_t row = 0; row < problem.right.size(); ++row) {
                double left = problem.right[row];
                for (std::size_t j = 0; j < problem.columns; ++j)
                    left -= problem.matrix[row * problem.columns + j] * x[j];
                const double a = problem.matrix[row * problem.columns + i];
                pull += a * left;
                size += a * a;
            }
            x[i] = std::clamp(x[i] + pull / size, problem.least[i], problem.most[i]);
        }
    return x;
}

/// Numbers from few values, so that columns are alike, bounds touch and pulls are 0.
BoundedLeastSquares random_problem(std::mt19937& random) {
    const double values[] = {-1, 0, 0, 0.5, 1, 2};
    const auto value = [&] { return values[random() % 6]; };
    BoundedLeastSquares problem;
    problem.columns = 1 + random() % 4;
    const std::size_t wishes = random() % 5;
    for (std::size_t i = 0; i < problem.columns; ++i) {
        const double a = value();
        const double b = value();
        problem.least.push_back(std::min(a, b));
        problem.most.push_back(std::max(a, b));
    }
    for (std::size_t row = 0; row < wishes + problem.columns; ++row) {
        problem.right.push_back(value());
        for (std::size_t i = 0; i < problem.columns; ++i)
            problem.matrix.push_back(row < wishes ? value() : row - wishes == i ? 0.5 : 0);
    }
    return problem;
}

TEST(BoundedLeastSquares, AgreesWithGoingFromColumnToColumn) {
    std::mt19937 random(1995);
    for (int round = 0; round < 150; ++round) {
        const BoundedLeastSquares problem = random_problem(random);
        const std::vector<double> x = solution(problem);
        const std::vector<double> expected = by_turns(problem);
        for (std::size_t i = 0; i < problem.columns; ++i) {
            ASSERT_GE(x[i], problem.least[i]);
            ASSERT_LE(x[i], problem.most[i]);
            ASSERT_NEAR(x[i], expected[i], 1e-9) << round;
        }
        ASSERT_LE(square_off(problem, x), square_off(problem, expected) + 1e-9);
    }
}

TEST(BoundedLeastSquares, MeetsWishesThatCanBeMet) {
    // Two equations in three unknowns, and a weak wish that they be 1.
    const double weak = 1e-6;
    BoundedLeastSquares problem;
    problem.columns = 3;
    problem.matrix = {2, 1, 0, 0, 1, 4, weak, 0, 0, 0, weak, 0, 0, 0, weak};
    problem.right = {5, 3, weak, weak, weak};
    problem.least = {0, 0, 0};
    problem.most = {9, 9, 9};
    const std::vector<double> x = solution(problem);
    EXPECT_NEAR(2 * x[0] + x[1], 5, 1e-9);
    EXPECT_NEAR(x[1] + 4 * x[2], 3, 1e-9);
    problem.most[0] = 1.5;
    const std::vector<double> bounded = solution(problem);
    EXPECT_EQ(bounded[0], 1.5);
    EXPECT_NEAR(bounded[1], 2, 1e-5);
}

} // namespace
} // namespace vera
