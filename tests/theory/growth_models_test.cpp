// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/experiment.h"
#include "vera/theory/growth.h"
#include "vera/theory/growth_models.h"

#include <cmath>
#include <functional>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using Formula = std::function<double(double)>;

std::vector<CountedSize> points_of(const Formula& count, const Formula& bound) {
    std::vector<CountedSize> points;
    for (double size = 16; size <= 4096; size *= 2)
        points.push_back({size, count(size), bound(size)});
    return points;
}

double n_log_n(double n) {
    return n * std::log2(n);
}

double square(double n) {
    return n * n;
}

std::vector<ModelKind> kinds(std::span<const ModelFit> models) {
    std::vector<ModelKind> found;
    for (const ModelFit& model : models)
        found.push_back(model.kind);
    return found;
}

TEST(GrowthModels, AreComparedAsByHand) {
    // To base 2 the sizes are 0 to 3, and the counts 0, 1, 1, 2. c n leaves 1/4 four times, a power
    // (of 3/5) 0.2 in all; so Akaike's criteria are 4 ln(1/4) + 4 and 4 ln(0.05) + 6. Of the first
    // two points, both say 4 and 8 where 2 and 4 are counted.
    const std::vector<CountedSize> points = {{1, 1, 1}, {2, 2, 16}, {4, 2, 16}, {8, 4, 16}};
    const std::vector<ModelFit> models = model_fits(points);
    ASSERT_THAT(
        kinds(models),
        ::testing::ElementsAre(ModelKind::linear, ModelKind::power, ModelKind::bound));
    EXPECT_NEAR(models[1].exponent, 0.6, 1e-12);
    EXPECT_NEAR(models[1].factor, std::exp2(1 - 0.6 * 1.5), 1e-12);
    EXPECT_NEAR(models[0].factor, std::exp2(-0.5), 1e-12);
    EXPECT_EQ(models[1].information, 0);
    EXPECT_NEAR(models[0].information, 4 * std::log(0.25) + 4 - (4 * std::log(0.05) + 6), 1e-9);
    EXPECT_NEAR(models[0].prediction_error, 1, 1e-12);
    EXPECT_NEAR(models[1].prediction_error, 1, 1e-12);
    // The bound's logarithms are 0, 4, 4, 4: 3 from the counts on average, and of the first two
    // points 3/2; it foretells 4 - 3/2 where 1 and 2 are counted.
    EXPECT_NEAR(models[2].prediction_error, std::exp2(std::sqrt((2.25 + 0.25) / 2)) - 1, 1e-12);
    EXPECT_EQ(&best_model(models), &models[1]);
}

TEST(GrowthModels, AreTheFormulaThatMadeTheCounts) {
    const auto best = [](const Formula& count, const Formula& bound) {
        // Little noise, by turns.
        int turn = 0;
        const std::vector<ModelFit> models = model_fits(
            points_of([&](double n) { return count(n) * (++turn % 3 == 0 ? 1.002 : 1); }, bound));
        EXPECT_LT(best_model(models).prediction_error, 0.01);
        return model_text(best_model(models), "the bound");
    };
    EXPECT_EQ(best([](double n) { return 7 * n; }, square), "c n");
    EXPECT_EQ(best([](double n) { return 7 * n_log_n(n); }, square), "c n log n");
    EXPECT_EQ(best([](double n) { return std::pow(n, 1.3); }, square), "c n^1.30");
    EXPECT_EQ(
        best(
            [](double n) { return 3 * n_log_n(n) * std::log2(n); },
            [](double n) { return n_log_n(n) * std::log2(n); }),
        "c (the bound)");
}

TEST(GrowthModels, LeaveOutABoundThatIsAmongThem) {
    for (const Formula& bound : {Formula([](double n) { return 5 * n; }), Formula(n_log_n)})
        EXPECT_THAT(
            kinds(model_fits(points_of(square, bound))),
            ::testing::ElementsAre(
                ModelKind::linear, ModelKind::linear_by_logarithm, ModelKind::power));
    EXPECT_EQ(kinds(model_fits(points_of(square, square))).size(), 4U);
}

TEST(GrowthModels, ForetellByTheUpperHalfOfWhatIsBefore) {
    // Nine sizes: without the last two, the fit is to the last four of seven. What is before these
    // does not matter.
    std::vector<CountedSize> points = points_of(square, square);
    ASSERT_EQ(points.size(), 9U);
    const double error = model_fits(points).front().prediction_error;
    points[2].count = 1;
    EXPECT_EQ(model_fits(points).front().prediction_error, error);
    points[3].count = 1;
    EXPECT_NE(model_fits(points).front().prediction_error, error);
    EXPECT_EQ(first_to_fit(9), 4U);
    EXPECT_EQ(first_to_fit(7), 3U);
    EXPECT_EQ(first_to_fit(2), 0U);
}

TEST(GrowthModels, AreNotToldOfThreeSizes) {
    const std::vector<CountedSize> points = {{1, 1, 1}, {2, 2, 16}, {4, 2, 16}};
    EXPECT_THROW(model_fits(points), std::invalid_argument);
}

} // namespace
} // namespace vera
