// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/single_tree.h"

#include <random>
#include <stdexcept>
#include <string>

#include "theory/rectangles.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using Random = std::mt19937_64;
using testing::ray_within;
using testing::Rectangles;
using testing::rectangles_within;

TEST(SingleTree, FindsTheRectangleThatLookingAtEachFinds) {
    Random random(1988);
    int met = 0;
    int missed = 0;
    for (int round = 0; round < 400; ++round) {
        const std::size_t count = random() % 60;
        const std::int32_t reach = round % 2 == 0 ? 2 : 6;
        const Rectangles rectangles = round % 5 == 0
            ? testing::repeated_rectangles(count, random)
            : rectangles_within(count, reach, round % 3 == 0 ? 2 * reach : 3, random);
        const SingleTree tree(rectangles, 1 + random() % 3);
        for (int i = 0; i < 100; ++i) {
            const WholeRay ray = ray_within(reach + 1, 2, random);
            const auto expected = brute_force_first_rectangle(rectangles, ray);
            ASSERT_EQ(tree.first_rectangle(ray), expected);
            ++(expected ? met : missed);
        }
    }
    EXPECT_GT(met, 5000);
    EXPECT_GT(missed, 5000);
}

TEST(SingleTree, LooksAtFewAmongManyRectangles) {
    Random random(2);
    const Rectangles rectangles = rectangles_within(4000, 1000, 40, random);
    const SingleTree tree(rectangles);
    StepCounts counts;
    for (int i = 0; i < 300; ++i) {
        const WholeRay ray = ray_within(1000, 50, random);
        ASSERT_EQ(tree.first_rectangle(ray, &counts), brute_force_first_rectangle(rectangles, ray));
    }
    EXPECT_LT(counts.points, 300U * rectangles.size() / 10);
}

TEST(SingleTree, TakesNoMoreMemoryThanForecast) {
    Random random(3);
    for (const std::size_t count : {0U, 1U, 5U, 100U, 3000U})
        for (const std::size_t leaf_size : {1U, 8U, 32U}) {
            const SingleTree tree(rectangles_within(count, 1000, 50, random), leaf_size);
            const double forecast = SingleTree::bytes_forecast(count, leaf_size);
            EXPECT_LE(static_cast<double>(tree.bytes()), forecast) << count << ' ' << leaf_size;
        }
}

TEST(SingleTree, IsRefusedBeforeMemoryRunsOut) {
    const Rectangles rectangles(1'000'000);
    const MemoryLimit little(1);
    try {
        const SingleTree tree(rectangles);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(
            error.what(),
            ::testing::AllOf(
                ::testing::StartsWith(
                    "a tree of 1000000 rectangles with four hulls a node takes about "),
                ::testing::EndsWith(": fewer rectangles, and leaves of more than 8 of them, take "
                                    "less")));
    }
}

TEST(SingleTree, TellsHowFarItIsAndCanBeStopped) {
    Random random(4);
    const Rectangles rectangles = rectangles_within(500, 1000, 50, random);
    double last = 0;
    const SingleTree tree(rectangles, 8, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(SingleTree(rectangles, 8, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
