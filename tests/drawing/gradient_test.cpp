// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/gradient.h"

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(Gradient, GoesFromStopToStopAlongItsAxisAndIsConstantBeyond) {
    Gradient gradient;
    gradient.start = {1, 1};
    gradient.axis = {3, 4};
    gradient.stops = {{0.25, {255, 0, 0}}, {0.75, {0, 0, 255}}};
    EXPECT_EQ(gradient_offset(gradient, {1, 1}), 0);
    EXPECT_EQ(gradient_offset(gradient, {4, 5}), 1);
    EXPECT_EQ(gradient_offset(gradient, {1 - 4, 1 + 3}), 0); // across the axis
    EXPECT_EQ(color_at(gradient, {2.5, 3}), (Color{0.5, 0, 0.5}));
    EXPECT_EQ(color_at(gradient, {1, 1}), (Color{1, 0, 0}));
    EXPECT_EQ(color_at(gradient, {-30, -40}), (Color{1, 0, 0}));
    EXPECT_EQ(color_at(gradient, {4, 5}), (Color{0, 0, 1}));
    EXPECT_EQ(color_at(gradient, {40, 50}), (Color{0, 0, 1}));
}

TEST(Gradient, GoesFromItsStartToAnEllipse) {
    Gradient gradient;
    gradient.shape = Gradient::Shape::radial;
    gradient.start = {10, 20};
    gradient.axis = {8, 0};
    gradient.other_axis = {0, 2};
    gradient.stops = {{0, {0, 0, 0}}, {1, {255, 255, 255}}};
    EXPECT_EQ(gradient_offset(gradient, {10, 20}), 0);
    for (const DrawingPoint end : {DrawingPoint{18, 20}, {2, 20}, {10, 22}, {10, 18}})
        EXPECT_EQ(gradient_offset(gradient, end), 1);
    EXPECT_EQ(color_at(gradient, {10, 21}), (Color{0.5, 0.5, 0.5}));
    EXPECT_EQ(color_at(gradient, {10, 30}), (Color{1, 1, 1}));
}

TEST(Gradient, HasOneColorWhereTwoStopsMeet) {
    Gradient gradient;
    gradient.stops = {{0.5, {0, 0, 0}}, {0.5, {255, 255, 255}}};
    EXPECT_EQ(color_at(gradient, {0.49, 0}), (Color{0, 0, 0}));
    EXPECT_EQ(color_at(gradient, {0.5, 0}), (Color{1, 1, 1}));
}

TEST(GradientDeathTest, NeedsAStop) {
    EXPECT_DEATH(color_at({}, {}), "stops.empty");
}

} // namespace
} // namespace vera
