// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/gradient.h"
#include "vera/visible/gradient_fit.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double tolerance = 1.0 / 255;

std::vector<ColorSample> samples_of(const ColorField& field, double within = 0.001) {
    std::vector<DrawingPoint> points;
    for (int y = 0; y <= 20; ++y)
        for (int x = 0; x <= 20; ++x)
            points.push_back({100.0 + 2 * x, 50.0 + 2 * y});
    return color_samples(points, field, within);
}

double largest_error(const FittedPaint& paint, const ColorField& field) {
    double error = 0;
    for (double x = 100; x <= 140; x += 0.7)
        for (double y = 50; y <= 90; y += 0.7) {
            const Color expected = field({x, y});
            const Color shown = paint.gradient
                ? color_at(*paint.gradient, {x, y})
                : Color{paint.color.r / 255.0, paint.color.g / 255.0, paint.color.b / 255.0};
            error = std::max(
                {error,
                 std::abs(shown.r - expected.r),
                 std::abs(shown.g - expected.g),
                 std::abs(shown.b - expected.b)});
        }
    return error;
}

TEST(GradientFit, OfOneColorIsThatColor) {
    const auto samples = samples_of([](DrawingPoint) { return Color{0.2, 0.4, 1}; });
    const FittedPaint paint = flat_fit(samples);
    EXPECT_EQ(paint.color, (DrawingColor{51, 102, 255}));
    EXPECT_FALSE(paint.gradient);
    EXPECT_LT(paint.error, 1e-12);
    // In the middle of what there is.
    const FittedPaint middle = flat_fit(samples_of([](DrawingPoint at) {
        return Color{at.x / 255, 0.5, at.y / 255};
    }));
    EXPECT_EQ(middle.color, (DrawingColor{120, 128, 70}));
    EXPECT_NEAR(middle.error, 20.0 / 255, 1e-2 / 255);
}

TEST(GradientFit, FindsAnyDirection) {
    for (int degrees = 0; degrees < 360; degrees += 15) {
        const double angle = degrees * 0.017453292519943295;
        const ColorField field = [&](DrawingPoint at) {
            const double t =
                0.015 * (std::cos(angle) * (at.x - 120) + std::sin(angle) * (at.y - 70));
            return Color{0.5 + t, 0.5 - 0.5 * t, 0.3};
        };
        const FittedPaint paint = linear_fit(samples_of(field), tolerance);
        ASSERT_TRUE(paint.gradient);
        EXPECT_EQ(paint.gradient->stops.size(), 2U) << degrees;
        EXPECT_LE(paint.error, tolerance) << degrees;
        EXPECT_LE(largest_error(paint, field), tolerance) << degrees;
    }
}

TEST(GradientFit, SetsStopsWhereAProfileBends) {
    const ColorField field = [](DrawingPoint at) {
        const double t = (at.x + 0.5 * at.y - 150) / 40;
        return clamped(Color{2 * t - 0.3, t * t, 0.25});
    };
    const FittedPaint paint = linear_fit(samples_of(field), tolerance);
    ASSERT_TRUE(paint.gradient);
    // The knees lie between samples.
    EXPECT_LE(paint.error, 1.5 * tolerance);
    EXPECT_GT(paint.gradient->stops.size(), 4U);
    EXPECT_LE(largest_error(paint, field), 2 * tolerance);
}

TEST(GradientFit, TellsWhatItCannotReach) {
    // A saddle: no direction, no ellipses.
    const ColorField field = [](DrawingPoint at) {
        const double value = 0.5 + 0.001 * (at.x - 120) * (at.y - 70);
        return Color{value, value, value};
    };
    const auto samples = samples_of(field);
    EXPECT_GT(linear_fit(samples, tolerance).error, 0.1);
    const auto radial = radial_fit(samples, tolerance);
    EXPECT_TRUE(!radial || radial->error > 0.1);
}

TEST(GradientFit, FindsTheCentreOfEllipsesWhateverTheirProfile) {
    std::mt19937 random(3);
    for (int round = 0; round < 40; ++round) {
        const auto in = [&](double from, double to) {
            return std::uniform_real_distribution(from, to)(random);
        };
        const DrawingPoint centre = {in(90, 150), in(40, 100)};
        const double angle = in(0, 3);
        const double flatness = in(0.3, 1);
        const bool is_highlight = round % 2 == 0;
        const ColorField field = [&](DrawingPoint at) {
            const double x = at.x - centre.x;
            const double y = at.y - centre.y;
            const double a = std::cos(angle) * x + std::sin(angle) * y;
            const double b = (std::cos(angle) * y - std::sin(angle) * x) / flatness;
            const double far = (a * a + b * b) / 2500;
            const double value =
                is_highlight ? 0.9 / (1 + far) / std::sqrt(1 + far) : 0.8 - 0.1 * far;
            return clamped(Color{value, 0.5 * value, 0.2});
        };
        const auto paint = radial_fit(samples_of(field), tolerance);
        ASSERT_TRUE(paint) << round;
        EXPECT_LE(paint->error, 2.5 * tolerance) << round;
        EXPECT_LE(largest_error(*paint, field), 2.5 * tolerance) << round;
        EXPECT_NEAR(paint->gradient->start.x, centre.x, 0.5) << round;
        EXPECT_NEAR(paint->gradient->start.y, centre.y, 0.5) << round;
    }
}

TEST(GradientFit, SeesTheSlackOfSteepPlaces) {
    const ColorField field = [](DrawingPoint at) {
        const double value = at.x < 120.05 ? 0.2 : 0.8;
        return Color{value, value, value};
    };
    const auto samples = samples_of(field, 0.1);
    for (const ColorSample& sample : samples)
        EXPECT_NEAR(sample.slack, sample.point.x == 120 ? 0.6 : 0, 1e-9) << sample.point.x;
    const ColorField slope = [](DrawingPoint at) {
        const double value = 0.001 * at.x + 0.002 * at.y;
        return Color{value, 2 * value, 0};
    };
    for (const ColorSample& sample : samples_of(slope, 0.1)) {
        EXPECT_NEAR(sample.slope_x.r, 0.001, 1e-9);
        EXPECT_NEAR(sample.slope_x.g, 0.002, 1e-9);
        EXPECT_NEAR(sample.slope_y.r, 0.002, 1e-9);
        EXPECT_NEAR(sample.slope_y.g, 0.004, 1e-9);
        EXPECT_NEAR(sample.slope_y.b, 0, 1e-9);
    }
}

TEST(GradientFit, ManagesWithSamplesOnALineOrInAPoint) {
    const std::vector<DrawingPoint> line = {{0, 0}, {1, 2}, {2, 4}, {4, 8}};
    const ColorField field = [](DrawingPoint at) { return Color{0.1 * at.x, 0, 0.05 * at.y}; };
    const FittedPaint paint = linear_fit(color_samples(line, field, 0.1), tolerance);
    ASSERT_TRUE(paint.gradient);
    EXPECT_LE(paint.error, tolerance);
    const std::vector<DrawingPoint> point = {{3, 3}, {3, 3}};
    EXPECT_LE(linear_fit(color_samples(point, field, 0.1), tolerance).error, tolerance);
    EXPECT_FALSE(radial_fit(color_samples(point, field, 0.1), tolerance));
}

} // namespace
} // namespace vera
