// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/growth.h"
#include "vera/theory/nested_trees.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "theory/rectangles.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using Random = std::mt19937_64;
using testing::ray_within;
using testing::Rectangles;
using testing::rectangles_within;
using testing::repeated_rectangles;

struct Answers {
    int met = 0;
    int missed = 0;
    StepCounts counts = {};
};

void compare(
    const Rectangles& rectangles,
    std::size_t few,
    int rays,
    const std::function<WholeRay()>& ray,
    Answers& answers) {
    const NestedTrees trees(rectangles, few);
    for (int i = 0; i < rays; ++i) {
        const WholeRay asked = ray();
        const auto expected = brute_force_first_rectangle(rectangles, asked);
        ASSERT_EQ(trees.first_rectangle(asked, &answers.counts), expected);
        ++(expected ? answers.met : answers.missed);
    }
}

TEST(NestedTrees, FindTheRectangleThatLookingAtEachFinds) {
    Random random(1988);
    Answers answers;
    for (int round = 0; round < 700; ++round) {
        const std::size_t count = random() % 50;
        // Rays through corners and along borders, planes and rectangles that coincide.
        const std::int32_t reach = round % 2 == 0 ? 2 : 6;
        const Rectangles rectangles = round % 5 == 0
            ? repeated_rectangles(count, random)
            : rectangles_within(count, reach, round % 3 == 0 ? 2 * reach : 3, random);
        compare(
            rectangles,
            1 + random() % 3,
            150,
            [&] { return ray_within(reach + 1, 2, random); },
            answers);
    }
    EXPECT_GT(answers.met, 10000);
    EXPECT_GT(answers.missed, 10000);
    EXPECT_GT(answers.counts.searches, 1000U) << "in the innermost trees";
}

TEST(NestedTrees, AnswerAtTheLargestCoordinates) {
    Random random(5);
    Answers answers;
    for (int round = 0; round < 30; ++round) {
        constexpr std::int32_t reach = largest_plane_coordinate;
        compare(
            rectangles_within(40, reach, reach, random),
            2,
            100,
            [&] { return ray_within(reach, std::numeric_limits<std::int32_t>::max(), random); },
            answers);
    }
    EXPECT_GT(answers.met, 100);
    EXPECT_GT(answers.missed, 100);
}

TEST(NestedTrees, AnswerAmongManyRectangles) {
    Random random(6);
    Answers answers;
    compare(
        rectangles_within(3000, 1000, 60, random),
        16,
        1000,
        [&] { return ray_within(1000, 50, random); },
        answers);
    EXPECT_GT(answers.met, 100);
    EXPECT_GT(answers.missed, 100);
}

TEST(NestedTrees, AnswerTheSameInEitherOrderOfTheirConditions) {
    Random random(11);
    for (int round = 0; round < 50; ++round) {
        const Rectangles rectangles = rectangles_within(60, 6, 5, random);
        const NestedTrees trees(
            rectangles, 2, {}, nullptr, TreeKind::conjugation, ConditionOrder::y_first);
        for (int i = 0; i < 100; ++i) {
            const WholeRay ray = ray_within(7, 2, random);
            ASSERT_EQ(trees.first_rectangle(ray), brute_force_first_rectangle(rectangles, ray));
        }
    }
}

TEST(NestedTrees, GiveTheSmallestNumberOfThoseInOnePlane) {
    const IsoRectangle square = {5, 0, 10, 0, 10};
    const Rectangles rectangles = {{9, 0, 10, 0, 10}, square, square, square};
    const NestedTrees trees(rectangles, 1);
    EXPECT_EQ(trees.first_rectangle({{5, 5, 0}, {0, 0, 1}}), 1U);
    EXPECT_EQ(trees.first_rectangle({{5, 5, 5}, {0, 0, 1}}), 1U) << "it starts there";
    EXPECT_EQ(trees.first_rectangle({{5, 5, 6}, {0, 0, 1}}), 0U);
    EXPECT_EQ(trees.first_rectangle({{5, 5, 6}, {0, 0, -1}}), 1U);
    EXPECT_EQ(trees.first_rectangle({{5, 5, 20}, {0, 0, -7}}), 0U);
    EXPECT_EQ(trees.first_rectangle({{5, 5, 10}, {0, 0, 1}}), std::nullopt);
    EXPECT_EQ(trees.first_rectangle({{10, 10, 4}, {0, 0, 1}}), 1U) << "through a corner";
    EXPECT_EQ(trees.first_rectangle({{11, 10, 4}, {0, 0, 1}}), std::nullopt);
    EXPECT_EQ(trees.first_rectangle({{11, 10, 4}, {-1, 0, 1}}), 1U);
}

TEST(NestedTrees, AnswerNothingWhereThereIsNothing) {
    EXPECT_EQ(NestedTrees(Rectangles{}).first_rectangle({{0, 0, 0}, {0, 0, 1}}), std::nullopt);
}

/// How steps grow with the number of rectangles, whose sides are at most so many parts of the mean
/// distance between them: with 2, rays meet some whatever their number is; with 0, none, so that
/// nothing ends the search early.
Growth growth_of_steps(double parts, Random& random) {
    constexpr std::int32_t reach = 20000;
    std::vector<double> sizes;
    std::vector<double> steps;
    for (std::size_t count = 128; count <= 2048; count *= 2) {
        const double side = parts * reach / std::sqrt(static_cast<double>(count));
        const NestedTrees trees(
            rectangles_within(count, reach, static_cast<std::int32_t>(side), random), 8);
        StepCounts counts;
        for (int i = 0; i < 300; ++i)
            trees.first_rectangle(ray_within(reach, 1000, random), &counts);
        sizes.push_back(static_cast<double>(count));
        steps.push_back(static_cast<double>(counts.nodes + counts.points));
    }
    return growth(sizes, steps);
}

TEST(NestedTrees, TakeStepsThatGrowNoFasterThanThePaperSays) {
    constexpr double bound = 0.695; // to which a polylogarithm may add, and does not
    Random random(7);
    for (const double parts : {0., 0.5, 2.}) {
        const Growth found = growth_of_steps(parts, random);
        EXPECT_LT(found.exponent - found.uncertainty, bound) << parts;
        EXPECT_LT(found.uncertainty, 0.15) << parts << " tells nothing";
        RecordProperty("parts_" + std::to_string(parts), std::to_string(found.exponent));
    }
}

TEST(NestedTrees, TakeNoMoreMemoryThanForecast) {
    Random random(8);
    for (const std::size_t count : {0U, 1U, 5U, 100U, 600U})
        for (const std::size_t few : {1U, 8U, 32U}) {
            const NestedTrees trees(rectangles_within(count, 1000, 50, random), few);
            const double forecast = NestedTrees::bytes_forecast(count, few);
            EXPECT_LE(static_cast<double>(trees.bytes()), forecast) << count << ' ' << few;
            if (count >= 100) {
                EXPECT_GE(static_cast<double>(trees.bytes()), 0.25 * forecast)
                    << count << ' ' << few;
            }
        }
}

TEST(NestedTrees, AreRefusedBeforeMemoryRunsOut) {
    Random random(9);
    const Rectangles rectangles = rectangles_within(100'000, 10000, 50, random);
    const MemoryLimit little(1);
    try {
        const NestedTrees trees(rectangles, 32);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(
            error.what(),
            ::testing::AllOf(
                ::testing::StartsWith("nesting trees of 100000 rectangles down to 32 takes about "),
                ::testing::EndsWith(
                    ": trees that end at more rectangles, as at 256, and trees of fewer "
                    "rectangles take less")));
    }
}

std::string refusal(const std::function<void()>& ask) {
    try {
        ask();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(NestedTrees, RefuseWhatTheyCannotHold) {
    EXPECT_EQ(
        refusal([] {
            NestedTrees(Rectangles{{0, 1, 0, 0, 0}});
        }),
        "rectangle 0 has a lower side above its upper side: exchange the two");
    EXPECT_EQ(
        refusal([] {
            NestedTrees(Rectangles{{}, {-1073741825, 0, 0, 0, 0}});
        }),
        "rectangle 1 has the coordinate -1073741825, and the largest magnitude is 1073741824: "
        "scale "
        "everything down");
    const NestedTrees trees(Rectangles{{}});
    EXPECT_EQ(
        refusal([&] {
            trees.first_rectangle({{0, 0, 0}, {1, 1, 0}});
        }),
        "the ray's direction has no z, and so it meets a rectangle in a plane across z only where "
        "it lies in that plane: turn it, or leave it out");
    EXPECT_EQ(
        refusal([&] {
            trees.first_rectangle({{0, 2000000000, 0}, {1, 1, 1}});
        }),
        "the ray's origin has the coordinate 2000000000, and the largest magnitude is 1073741824: "
        "scale everything down");
}

TEST(NestedTrees, TellHowFarTheyAreAndCanBeStopped) {
    Random random(10);
    const Rectangles rectangles = rectangles_within(500, 1000, 50, random);
    double last = 0;
    const NestedTrees trees(rectangles, 8, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(NestedTrees(rectangles, 8, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
