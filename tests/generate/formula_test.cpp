// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/formula.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

double value(const char* text) {
    return constant_value(text, {{"n", 5}});
}

TEST(Formula, RanksItsOperatorsAsIsUsual) {
    EXPECT_EQ(value("1 + 2*3"), 7);
    EXPECT_EQ(value("(1 + 2)*3"), 9);
    EXPECT_EQ(value("7 - 2 - 1"), 4);
    EXPECT_EQ(value("12 / 3 / 2"), 2);
    EXPECT_EQ(value("2^3^2"), 512);
    EXPECT_EQ(value("-2^2"), -4);
    EXPECT_EQ(value("2^-1"), 0.5);
    EXPECT_EQ(value("--3 - -4"), 7);
    EXPECT_EQ(value(" n * .5e1 "), 25);
    EXPECT_EQ(value("pow(2, 3) + max(1, n) - min(1, n)"), 12);
}

TEST(Formula, KnowsItsFunctions) {
    EXPECT_NEAR(value("sin(pi/6)"), 0.5, 1e-15);
    EXPECT_NEAR(value("cos(pi/3)"), 0.5, 1e-15);
    EXPECT_NEAR(value("tan(pi/4)"), 1, 1e-15);
    EXPECT_NEAR(value("exp(1)"), std::numbers::e, 1e-15);
    EXPECT_NEAR(value("log(e)"), 1, 1e-15);
    EXPECT_EQ(value("sqrt(9)"), 3);
    EXPECT_EQ(value("abs(-4)"), 4);
    EXPECT_NEAR(value("sinh(1)"), std::sinh(1), 1e-15);
    EXPECT_NEAR(value("cosh(1)"), std::cosh(1), 1e-15);
    EXPECT_NEAR(value("tanh(1)"), std::tanh(1), 1e-15);
    EXPECT_NEAR(value("2^0.5"), std::numbers::sqrt2, 1e-15);
    for (const double x : {-1e9, -3.0, -1.0, -0.3, 0.0, 0.1, 0.5, 1.0, 2.0, 7.0, 1e300})
        EXPECT_NEAR(arc_tangent(x), std::atan(x), 4e-16) << x;
    for (const double y : {-2.0, -1.0, 0.0, 1.0, 2.0})
        for (const double x : {-2.0, -1.0, 1.0, 2.0})
            EXPECT_NEAR(angle_of(Jet<double>{y}, Jet<double>{x}).value, std::atan2(y, x), 1e-15)
                << y << ' ' << x;
}

// Closed surfaces are closed to the bit by this.
TEST(Formula, HasNoValueWhereAPartOfItHasNone) {
    EXPECT_EQ(value("atan2(0, 0)"), 0);
    for (const char* text :
         {"atan2(1, sqrt(u))",
          "atan2(sqrt(u), 0)",
          "min(sqrt(u), 1)",
          "min(1, sqrt(u))",
          "max(sqrt(u), 1)",
          "max(1, sqrt(u))",
          "abs(sqrt(u))"})
        EXPECT_TRUE(std::isnan(Formula(text).at(-1, 0).value)) << text;
}

TEST(Formula, HasTheSameRoundingsByIntervalsOfOnePlace) {
    const Formula angle("atan2(u, v)");
    for (const double u : {-3.0, -0.1, 0.0, 0.1, 0.3, 3.0})
        for (const double v : {-3.0, -0.3, -0.1, 0.1, 0.7, 3.0})
            EXPECT_TRUE(angle.at(Interval(u), Interval(v)).value.contains(angle.at(u, v).value))
                << u << ' ' << v;
}

TEST(Formula, HasExactSinesAtWholeTurns) {
    EXPECT_EQ(value("sin(2*pi)"), 0);
    EXPECT_EQ(value("cos(2*pi)"), 1);
    EXPECT_EQ(value("cos(pi/2)"), 0);
    EXPECT_EQ(value("sin(-pi)"), 0);
}

TEST(Formula, DerivesExactly) {
    const struct {
        const char* text;
        double (*function)(double, double);
    } formulas[] = {
        {"u*v + u/v", [](double u, double v) { return u * v + u / v; }},
        {"sin(u)*cos(v)", [](double u, double v) { return std::sin(u) * std::cos(v); }},
        {"u^3 - v^-2", [](double u, double v) { return u * u * u - 1 / (v * v); }},
        {"u^v", [](double u, double v) { return std::pow(u, v); }},
        {"u^1.5*v", [](double u, double v) { return std::pow(u, 1.5) * v; }},
        {"exp(u*v)*log(v)", [](double u, double v) { return std::exp(u * v) * std::log(v); }},
        {"sqrt(u + v)", [](double u, double v) { return std::sqrt(u + v); }},
        {"atan(u*v)", [](double u, double v) { return std::atan(u * v); }},
        {"atan2(u, v)", [](double u, double v) { return std::atan2(u, v); }},
        {"atan2(u, -v)", [](double u, double v) { return std::atan2(u, -v); }},
        {"tan(u) + tanh(v)", [](double u, double v) { return std::tan(u) + std::tanh(v); }},
        {"abs(u - v)*max(u, 2*v)",
         [](double u, double v) { return std::abs(u - v) * std::fmax(u, 2 * v); }},
    };

    constexpr double h = 1e-4;
    for (const auto& [text, f] : formulas)
        for (const double u : {0.4, 0.9, 1.3})
            for (const double v : {0.5, 0.7, 1.1}) {
                const Jet<double> jet = Formula(text).at(u, v);
                EXPECT_NEAR(jet.value, f(u, v), 1e-13) << text;
                EXPECT_NEAR(jet.u, (f(u + h, v) - f(u - h, v)) / (2 * h), 1e-5) << text;
                EXPECT_NEAR(jet.v, (f(u, v + h) - f(u, v - h)) / (2 * h), 1e-5) << text;
                EXPECT_NEAR(jet.uu, (f(u + h, v) - 2 * f(u, v) + f(u - h, v)) / (h * h), 1e-4)
                    << text;
                EXPECT_NEAR(jet.vv, (f(u, v + h) - 2 * f(u, v) + f(u, v - h)) / (h * h), 1e-4)
                    << text;
                EXPECT_NEAR(
                    jet.uv,
                    (f(u + h, v + h) - f(u + h, v - h) - f(u - h, v + h) + f(u - h, v - h))
                        / (4 * h * h),
                    1e-4)
                    << text;
            }
}

TEST(Formula, SaysWhereItIsWrongAndWhatToDo) {
    const struct {
        const char* text;
        std::size_t offset;
        const char* problem;
    } wrong[] = {
        {"", 0, "expected a number, a name or '(', found the end"},
        {"1 +", 3, "expected a number, a name or '(', found the end"},
        {"2u", 1, "expected an operator, found 'u'"},
        {"sin(u", 5, "expected ')' or an operator, found the end"},
        {"sin u", 4, "expected '(' behind sin, found 'u'"},
        {"3 * sine(u)", 4, "there is no 'sine'; did you mean 'sin'?"},
        {"atan2(u)", 7, "expected ',' and another argument of atan2, found ')'"},
        {"u & v", 2, "expected an operator, found '&'"},
        {"u \u00d7 v", 2, "expected an operator, found '\u00d7'"},
        {"2*\u03c0", 2, "expected a number, a name or '(', found '\u03c0'"},
        {"u \xff", 2, "expected an operator, found a byte that is not UTF-8"},
        {"1e999", 0, "this number is too large or too small"},
    };

    for (const auto& [text, offset, problem] : wrong)
        try {
            const Formula formula(text);
            ADD_FAILURE() << text;
        } catch (const FormulaError& error) {
            EXPECT_STREQ(error.what(), problem) << text;
            EXPECT_EQ(error.offset, offset) << text;
        }
    EXPECT_THROW(Formula(std::string(300, '(')), FormulaError);
    EXPECT_THROW(constant_value("u"), FormulaError);
    EXPECT_THROW(constant_value("1/0"), FormulaError);
}

TEST(Formula, TakesNamesThatHaveNoMeaningYet) {
    FormulaNames names;
    define_name("n=5", names);
    define_name(" half = n/2", names);
    EXPECT_EQ(Formula("half*n", names).at(0, 0).value, 12.5);
    for (const char* wrong : {"n=6", "sin=1", "u=2", "pi=3", "=1", "5=5", "m", "m=", "m=v"})
        EXPECT_THROW(define_name(wrong, names), FormulaError) << wrong;
}

} // namespace
} // namespace vera
