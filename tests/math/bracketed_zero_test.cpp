// SPDX-License-Identifier: Apache-2.0
#include "vera/math/bracketed_zero.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

struct Search {
    std::string name;
    std::function<double(double)> function;
    double low = 0;
    double high = 1;
    int usual_steps = 12;
};

TEST(BracketedZero, FindsTheChangeOfSignInFewSteps) {
    const std::vector<Search> searches = {
        {"line", [](double v) { return v - 0.3; }},
        {"falling line", [](double v) { return 0.3 - v; }},
        {"cubic", [](double v) { return v * v * v - 0.2; }},
        {"root at its steep end", [](double v) { return std::sqrt(v) - 1e-3; }, 0, 1, 40},
        {"flat at its zero", [](double v) { return (v - 0.7) * (v - 0.7) * (v - 0.7); }, 0, 1, 130},
        {"step", [](double v) { return v < 0.6 ? -1.0 : 1.0; }, 0, 1, 60},
        {"zero at the end", [](double v) { return v - 1; }},
        {"zero at the start", [](double v) { return v; }},
        {"far from 0", [](double v) { return v * v - 2e12; }, 1e6, 2e6},
        {"on both sides of 0", [](double v) { return v * v * v + v - 1e-5; }, -3, 2, 20},
    };
    for (const Search& search : searches) {
        int steps = 0;
        const double zero = bracketed_zero(
            search.low,
            search.function(search.low),
            search.high,
            search.function(search.high),
            [&](double v) {
                ++steps;
                return search.function(v);
            });
        EXPECT_LE(steps, search.usual_steps) << search.name;
        EXPECT_GE(zero, search.low) << search.name;
        EXPECT_LE(zero, search.high) << search.name;
        const double near = 4e-16 * std::abs(zero);
        const double before = search.function(zero - near);
        const double after = search.function(zero + near);
        EXPECT_TRUE(search.function(zero) == 0 || (before <= 0) != (after <= 0))
            << search.name << " at " << zero;
    }
}

} // namespace
} // namespace vera
