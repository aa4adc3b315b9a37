// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/curve.h"
#include "vera/theory/curve_plot.h"
#include "vera/theory/curve_structure.h"

#include <cmath>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The curve of a power of the size, with a bound of another.
Experiment power_experiment(double power, double bound) {
    Experiment experiment;
    experiment.name = "power";
    experiment.family = "plain";
    experiment.counted = "steps";
    experiment.unit = "things";
    experiment.bound = "n^b";
    experiment.source = "nowhere";
    experiment.first = 16;
    experiment.last = 4096;
    experiment.most = 100'000;
    experiment.count = [=](std::size_t size, std::uint64_t seed, const CancelFlag*) {
        const auto n = static_cast<double>(size);
        const double noise = 1 + 0.01 * static_cast<double>(seed % 100) / 100;
        return CountedSize{n, 5 * noise * std::pow(n, power), std::pow(n, bound)};
    };
    return experiment;
}

Curve counted(const Experiment& experiment) {
    return counted_curve(experiment, sizes_up_to(experiment, experiment.last));
}

/// The claims of the paper, and what breaks them.
TEST(Experiments, GrowAsTheirBoundsSay) {
    for (const Experiment& experiment : experiments()) {
        const Curve curve =
            counted_curve(experiment, sizes_up_to(experiment, experiment.last_in_tests));
        const std::string name = full_name(experiment);
        EXPECT_EQ(curve.verdict != Verdict::above, experiment.keeps_bound)
            << name << ": n^" << curve.growth.exponent << " ± " << curve.growth.half_interval
            << ", the bound n^" << curve.bound_growth.exponent;
        EXPECT_LT(curve.excess.uncertainty, 0.25) << name << " tells nothing";
        for (const CountedSize& point : curve.points)
            EXPECT_EQ(point.variables.size(), experiment.variables.size()) << name;
        RecordProperty(name, exponent_text(curve.growth));
    }
}

TEST(Experiments, AreDescribedAndNamedOnce) {
    std::set<std::string> names;
    for (const Experiment& experiment : experiments()) {
        EXPECT_TRUE(names.insert(full_name(experiment)).second) << full_name(experiment);
        for (const std::string& text :
             {experiment.name,
              experiment.family,
              experiment.input,
              experiment.counted,
              experiment.unit,
              experiment.bound,
              experiment.source})
            EXPECT_FALSE(text.empty()) << full_name(experiment);
        EXPECT_EQ(experiment.terms.empty(), experiment.variables.empty());
        for (const std::size_t last : {experiment.last, experiment.last_in_tests})
            EXPECT_EQ(problem_with_sizes(experiment, sizes_up_to(experiment, last)), "");
    }
}

TEST(Experiments, AreTheSameForTheSameSeed) {
    const Experiment& experiment = experiments().front();
    const std::vector<std::size_t> sizes = {20, 30, 40, 50};
    const Curve curve = counted_curve(experiment, sizes, 7);
    const Curve again = counted_curve(experiment, sizes, 7);
    const Curve other = counted_curve(experiment, sizes, 8);
    bool differs = false;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        EXPECT_EQ(curve.points[i].count, again.points[i].count);
        differs = differs || curve.points[i].count != other.points[i].count;
    }
    EXPECT_TRUE(differs);
}

TEST(Curve, IsBelowAlongOrAboveItsBound) {
    EXPECT_EQ(counted(power_experiment(0.6, 0.7)).verdict, Verdict::below);
    EXPECT_EQ(counted(power_experiment(0.7, 0.7)).verdict, Verdict::along);
    EXPECT_EQ(counted(power_experiment(0.8, 0.7)).verdict, Verdict::above);
    const Curve curve = counted(power_experiment(0.8, 0.7));
    EXPECT_NEAR(curve.growth.exponent, 0.8, 0.01);
    EXPECT_NEAR(curve.bound_growth.exponent, 0.7, 1e-9);
    EXPECT_NEAR(curve.excess.exponent, 0.1, 0.01);
    EXPECT_EQ(curve.points.size(), 17U);
    EXPECT_EQ(curve.fitted().size(), 9U);
}

TEST(Curve, OfConstantCountsIsNotAboveAConstantBound) {
    Experiment experiment = power_experiment(0, 0);
    experiment.count = [](std::size_t size, std::uint64_t, const CancelFlag*) {
        return CountedSize{static_cast<double>(size), 3, 1};
    };
    EXPECT_EQ(counted(experiment).verdict, Verdict::along);
}

TEST(Curve, HasSizesThatGrowByTwoOrItsRoot) {
    Experiment experiment = power_experiment(1, 1);
    EXPECT_THAT(sizes_up_to(experiment, 64), ElementsAre(16, 23, 32, 45, 64));
    EXPECT_THAT(sizes_up_to(experiment, 50), ElementsAre(16, 23, 32, 45));
    EXPECT_THAT(sizes_up_to(experiment, 15), ElementsAre());
    experiment.sizes_a_doubling = 1;
    EXPECT_THAT(sizes_up_to(experiment, 64), ElementsAre(16, 32, 64));
}

TEST(Curve, IsRefusedWhereInputsComeOutTheSameSize) {
    Experiment experiment = power_experiment(1, 1);
    experiment.count = [](std::size_t size, std::uint64_t, const CancelFlag*) {
        const auto even = static_cast<double>(size / 2 * 2);
        return CountedSize{even, even, even};
    };
    const std::vector<std::size_t> sizes = {16, 32, 33, 64};
    try {
        counted_curve(experiment, sizes);
        FAIL() << "not refused";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(
            error.what(),
            "power/plain makes inputs of one size of both 32 and 33 things: name sizes that lie "
            "farther apart");
    }
    const std::vector<double> equal = {1, 2, 2, 4};
    EXPECT_THROW(local_exponents(equal, equal), std::invalid_argument);
}

TEST(Curve, AsksForSizesThatAreEnough) {
    for (const int a_doubling : {1, 2}) {
        Experiment experiment = power_experiment(1, 1);
        experiment.sizes_a_doubling = a_doubling;
        const std::size_t asked = a_doubling == 1 ? 128 : 45;
        const auto too_few = sizes_up_to(experiment, asked - 1);
        EXPECT_THAT(
            problem_with_sizes(experiment, too_few),
            HasSubstr(" " + std::to_string(asked) + " at"));
        EXPECT_EQ(problem_with_sizes(experiment, sizes_up_to(experiment, asked)), "");
    }
}

TEST(Curve, IsRefusedAtSizesThatTellNothing) {
    const Experiment experiment = power_experiment(1, 1);
    const auto problem = [&](const std::vector<std::size_t>& sizes) {
        return problem_with_sizes(experiment, sizes);
    };
    EXPECT_EQ(problem({2, 4, 8, 16}), "");
    EXPECT_EQ(
        problem({16, 32, 64}),
        "power/plain is counted at 3 sizes, and an exponent takes 4 or more: name more sizes, or "
        "let them go on to 45 at least");
    EXPECT_EQ(
        problem({16, 32, 32, 64}),
        "the size 32 stands behind 32: name sizes in ascending order, each once");
    EXPECT_EQ(problem({1, 2, 3, 4}), "the size 1 is too small: 2 is the least");
    EXPECT_EQ(
        problem({16, 32, 64, 100'001}),
        "power/plain takes at most 100000 things, and 100001 are more than it could count in a "
        "reasonable time: name smaller sizes");
    std::vector<std::size_t> many(65);
    for (std::size_t i = 0; i < many.size(); ++i)
        many[i] = i + 2;
    EXPECT_EQ(
        problem(many), "power/plain is counted at 65 sizes, and 64 are the most: leave some out");
    EXPECT_THROW(
        counted_curve(experiment, std::vector<std::size_t>{16, 32}), std::invalid_argument);
}

TEST(Curve, TellsHowFarItIsAndCanBeStopped) {
    const Experiment experiment = power_experiment(1, 1);
    const auto sizes = sizes_up_to(experiment, 128);
    double last = 0;
    counted_curve(experiment, sizes, 1, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(counted_curve(experiment, sizes, 1, {}, &cancel), Cancelled);
}

TEST(Curve, HasABoundThatIsTheSumOfItsTerms) {
    const std::vector<BoundTerm> terms = {
        {"a", [](std::span<const double> ab) { return 3 * ab[0]; }},
        {"b", [](std::span<const double> ab) { return ab[0] * ab[1]; }}};
    const CountedSize point = counted_by_terms(7, 11, {2, 5}, terms);
    EXPECT_EQ(point.size, 7);
    EXPECT_EQ(point.count, 11);
    EXPECT_EQ(point.bound, 16);
    EXPECT_THAT(point.variables, ElementsAre(2, 5));
}

TEST(Curve, IsCheckedByABootstrap) {
    const Curve below = counted(power_experiment(0.6, 0.7));
    EXPECT_EQ(below.resampled_verdict, Verdict::below);
    EXPECT_FALSE(below.is_contradicted());
    EXPECT_LT(below.resampled.both_ways.lower, below.growth.exponent);
    EXPECT_GT(below.resampled.both_ways.upper, below.growth.exponent);
    EXPECT_LT(below.resampled_excess.one_way.upper, 0);
    // Of four points that rise but for a little, t is not certain, and residuals as small as these
    // have never been larger.
    const Experiment experiment = power_experiment(1, 1);
    const Curve unsure = fitted_curve(
        experiment, 1, {{16, 100, 100}, {32, 107, 100}, {64, 106, 100}, {128, 113, 100}});
    EXPECT_EQ(unsure.verdict, Verdict::above);
    const Curve more = fitted_curve(
        experiment, 1, {{16, 100, 100}, {32, 108, 100}, {64, 103, 100}, {128, 111, 100}});
    EXPECT_EQ(more.verdict, Verdict::along);
    EXPECT_EQ(more.resampled_verdict, Verdict::above);
    EXPECT_TRUE(more.is_contradicted());
}

TEST(Curve, TellsWhichFormulaItFollows) {
    const Curve curve = counted(power_experiment(0.8, 0.7));
    EXPECT_EQ(followed_text(curve), "c n^0.80");
    EXPECT_EQ(followed_text(counted(power_experiment(1, 0.7))), "c n^1.00, or c n");
}

/// Counts that are made of n and k with those coefficients, k being n^1.5 or n^2.
Experiment two_terms(const char* family, double of_n, double of_k, double power_of_k) {
    Experiment experiment = power_experiment(1, 1);
    experiment.family = family;
    experiment.variables = {"n", "k"};
    experiment.terms = {
        {"n", [](std::span<const double> nk) { return nk[0]; }},
        {"k", [](std::span<const double> nk) { return nk[1]; }}};
    experiment.count =
        [=, terms = experiment.terms](std::size_t size, std::uint64_t seed, const CancelFlag*) {
            const auto n = static_cast<double>(size);
            const double k = std::pow(n, power_of_k);
            const double noise = 1 + 0.001 * static_cast<double>(seed % 100) / 100;
            return counted_by_terms(n, noise * (of_n * n + of_k * k), {n, k}, terms);
        };
    return experiment;
}

TEST(CurveStructure, TellsWhetherFamiliesHaveOneCoefficient) {
    const Experiment first = two_terms("first", 5, 2, 1.5);
    const Experiment second = two_terms("second", 5, 3, 2);
    const Experiment without = power_experiment(1, 1);
    Experiment other = without;
    other.name = "another";
    const std::vector<Curve> curves = {counted(first), counted(second), counted(other)};
    const std::vector<CurveStructure> found = structures(curves);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(structure_text(*found[0].experiment), "c1 n + c2 k");
    EXPECT_THAT(found[0].families, ElementsAre("first", "second"));
    EXPECT_NEAR(found[0].fits[0].coefficients[0]->value, 5, 0.02);
    EXPECT_NEAR(found[0].fits[0].coefficients[1]->value, 2, 0.01);
    EXPECT_NEAR(found[0].fits[1].coefficients[1]->value, 3, 0.01);
    EXPECT_THAT(found[0].same, ElementsAre(true, false));
    EXPECT_GT(found[0].together->error, 10 * found[0].fits[0].error);
    EXPECT_EQ(coefficient_text(TermCoefficient{1.5, 1, 2.25}), "1.5 (1 to 2.25)");
    EXPECT_EQ(coefficient_text(TermCoefficient{0, 0, 0}), "0 (else negative)");
    EXPECT_EQ(coefficient_text(std::nullopt), "not told");
}

TEST(CurvePlot, ShowsEachCurveAndItsExponent) {
    const Experiment plain = power_experiment(0.6, 0.7);
    Experiment other = power_experiment(0.8, 0.7);
    other.family = "steep & high";
    const std::vector<Curve> curves = {counted(plain), counted(other)};
    const std::string svg = curve_plot(curves);
    EXPECT_THAT(svg, HasSubstr("steep &amp; high"));
    EXPECT_THAT(svg, HasSubstr("above the bound n<tspan"));
    EXPECT_THAT(svg, HasSubstr("<tspan dy=\"-4.2\" font-size=\"9\">0.80</tspan>"));
    std::size_t points = 0;
    for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at)
        ++points;
    EXPECT_EQ(points, 2 * (17U + 16U + 1)); // and local exponents, and the legend
    EXPECT_THAT(svg, HasSubstr("exponent from size to size"));
    EXPECT_EQ(svg, curve_plot(curves));
}

} // namespace
} // namespace vera
