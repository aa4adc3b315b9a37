// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/formula.h"

#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

void expect_holds(const Interval& interval, double value, const std::string& what) {
    // What is not defined at the number is not of interest.
    EXPECT_TRUE(!std::isfinite(value) || interval.contains(value))
        << what << ": " << value << " is not in " << interval.lower << " to " << interval.upper;
}

TEST(Interval, HoldsWhatFormulasAndTheirDerivativesAreAtAnyPlaceInIt) {
    const char* const formulas[] = {
        "u + v",
        "u - 2*v",
        "u*v",
        "u/v",
        "u^2",
        "u^3 - v^4",
        "u^-2",
        "abs(u)^1.5",
        "2^u",
        "sin(u*v)",
        "cos(3*u - v)",
        "tan(u)",
        "exp(u - v)",
        "log(abs(u) + v^2)",
        "sqrt(u^2 + v^2)",
        "abs(u - v)",
        "atan(u*v)",
        "atan2(u, v)",
        "min(u, v)",
        "max(u^2, v)",
        "sinh(u)*cosh(v)",
        "tanh(u + v)",
        "1/(1 + u^2)",
        "exp(-u^2)*sin(7*v)",
    };
    // Few values, so that intervals begin and end at zeros, poles and turns.
    const double values[] = {
        -3.141592653589793, -2, -1, -0.5, 0, 1e-3, 0.5, 1, 1.5707963267948966, 4};
    std::mt19937 random(1988);
    const auto pick = [&] { return values[random() % std::size(values)]; };
    for (const char* const text : formulas) {
        const Formula formula(text);
        for (int round = 0; round < 300; ++round) {
            const double u0 = pick();
            const double v0 = pick();
            const double width = round % 3 == 0 ? 0 : round % 3 == 1 ? 0.01 : 1;
            const Interval u = {u0, u0 + width};
            const Interval v = {v0, v0 + width};
            const Jet<Interval> all = formula.at(u, v);
            for (int sample = 0; sample < 9; ++sample) {
                const double at_u = u.lower + (u.upper - u.lower) * (sample % 3) / 2;
                const double at_v = v.lower + (v.upper - v.lower) * (sample / 3) / 2;
                const Jet<double> one = formula.at(at_u, at_v);
                const std::string what =
                    std::string(text) + " at " + std::to_string(at_u) + " " + std::to_string(at_v);
                expect_holds(all.value, one.value, what);
                expect_holds(all.u, one.u, what + ", u");
                expect_holds(all.v, one.v, what + ", v");
                expect_holds(all.uu, one.uu, what + ", uu");
                expect_holds(all.uv, one.uv, what + ", uv");
                expect_holds(all.vv, one.vv, what + ", vv");
            }
        }
    }
}

// The formulas' functions are compared with the library's in long double.
TEST(Interval, HoldsTheTrueValuesOfFunctions) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> numbers(-50, 50);
    const auto holds = [](const Interval& interval, long double value) {
        return static_cast<long double>(interval.lower) <= value
            && value <= static_cast<long double>(interval.upper);
    };
    for (int round = 0; round < 20'000; ++round) {
        const double x = numbers(random);
        const auto exact = static_cast<long double>(x);
        EXPECT_TRUE(holds(sine(Interval(x)), std::sin(exact))) << x;
        EXPECT_TRUE(holds(cosine(Interval(x)), std::cos(exact))) << x;
        EXPECT_TRUE(holds(exponential(Interval(x)), std::exp(exact))) << x;
        EXPECT_TRUE(holds(arc_tangent(Interval(x)), std::atan(exact))) << x;
        EXPECT_TRUE(holds(square(Interval(x)), exact * exact)) << x;
        EXPECT_TRUE(holds(reciprocal(Interval(x)), 1 / exact)) << x;
        const double size = std::abs(x);
        EXPECT_TRUE(holds(logarithm(Interval(size)), std::log(std::abs(exact)))) << x;
        EXPECT_TRUE(holds(square_root(Interval(size)), std::sqrt(std::abs(exact)))) << x;
    }
}

TEST(Interval, IsTightEnoughToBeOfUse) {
    const Interval result = Formula("sin(u)").at(Interval(1, 1.1), Interval(0)).value;
    EXPECT_NEAR(result.lower, std::sin(1), 1e-12);
    EXPECT_NEAR(result.upper, std::sin(1.1), 1e-12);
    EXPECT_EQ(sine(Interval(1, 2)).upper, 1);
    EXPECT_EQ(square(Interval(-2, 1)).lower, 0);
}

} // namespace
} // namespace vera
