// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/dual_bits.h"
#include "vera/theory/dual_pairs.h"
#include "vera/theory/whole_within.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <random>

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
    int on_ends = 0; ///< whose line touches the end of a side, seen from the side
};

bool touches_an_end(const Rectangles& rectangles, const WholeRay& ray) {
    for (const auto axis : {SideProjection::Axis::x, SideProjection::Axis::y}) {
        const SideView view = side_view(ray, axis);
        for (const IsoRectangle& each : rectangles) {
            const bool is_x = axis == SideProjection::Axis::x;
            const PlanePoint lower = {each.z, is_x ? each.lower_x : each.lower_y};
            const PlanePoint upper = {each.z, is_x ? each.upper_x : each.upper_y};
            if (height_at({lower, false}, view.slope) == view.height
                || height_at({upper, true}, view.slope) == view.height)
                return true;
        }
    }
    return false;
}

/// The pairs for rays and for lines, and the bits.
void compare(
    const Rectangles& rectangles,
    int rays,
    const std::function<WholeRay()>& ray,
    Answers& answers) {
    const DualPairs pairs(rectangles, Stabbing::from_a_rank, DualPairs::Building::when_asked);
    const DualPairs of_lines(rectangles, Stabbing::first_of_all, DualPairs::Building::when_asked);
    const DualBits bits(rectangles);
    for (int i = 0; i < rays; ++i) {
        const WholeRay asked = ray();
        const auto expected = brute_force_first_rectangle(rectangles, asked);
        ASSERT_EQ(pairs.first_rectangle(asked), expected);
        ASSERT_EQ(bits.first_rectangle(asked), expected);
        const auto lowest = brute_force_lowest_rectangle(rectangles, asked);
        ASSERT_EQ(of_lines.lowest_rectangle(asked), lowest);
        ASSERT_EQ(pairs.lowest_rectangle(asked), lowest);
        ++(expected ? answers.met : answers.missed);
        answers.on_ends += touches_an_end(rectangles, asked) ? 1 : 0;
    }
}

TEST(DualPairs, FindTheRectangleThatLookingAtEachFinds) {
    Random random(1988);
    Answers answers;
    for (int round = 0; round < 500; ++round) {
        const std::size_t count = random() % 16;
        // Rays through corners and along borders, planes and rectangles that coincide.
        const std::int32_t reach = round % 2 == 0 ? 2 : 5;
        const Rectangles rectangles = round % 5 == 0
            ? repeated_rectangles(count, random)
            : rectangles_within(count, reach, round % 3 == 0 ? 2 * reach : 3, random);
        compare(
            rectangles, 200, [&] { return ray_within(reach + 1, 2, random); }, answers);
    }
    EXPECT_EQ(answers.met + answers.missed, 100'000);
    EXPECT_GT(answers.met, 10000);
    EXPECT_GT(answers.missed, 10000);
    EXPECT_GT(answers.on_ends, 30000);
}

TEST(DualPairs, AnswerAmongManyRectangles) {
    Random random(6);
    Answers answers;
    compare(
        rectangles_within(70, 1000, 700, random),
        3000,
        [&] { return ray_within(1000, 50, random); },
        answers);
    EXPECT_GT(answers.met, 300);
    EXPECT_GT(answers.missed, 300);
}

TEST(DualPairs, AnswerAtTheLargestCoordinates) {
    Random random(5);
    Answers answers;
    for (int round = 0; round < 20; ++round) {
        constexpr std::int32_t reach = largest_plane_coordinate;
        compare(
            rectangles_within(12, reach, reach, random),
            100,
            [&] { return ray_within(reach, std::numeric_limits<std::int32_t>::max(), random); },
            answers);
    }
    EXPECT_GT(answers.met, 50);
    EXPECT_GT(answers.missed, 50);
}

TEST(DualPairs, AnswerNothingWhereThereIsNothing) {
    EXPECT_EQ(DualPairs(Rectangles{}).first_rectangle({{0, 0, 0}, {0, 0, 1}}), std::nullopt);
    EXPECT_EQ(DualBits(Rectangles{}).first_rectangle({{0, 0, 0}, {0, 0, -1}}), std::nullopt);
}

TEST(DualPairs, AreTheSameBuiltAtOnceOrWhenAskedOnAllThreads) {
    Random random(7);
    const Rectangles rectangles = rectangles_within(12, 20, 20, random);
    const DualPairs all(rectangles);
    const DualPairs later(rectangles, Stabbing::from_a_rank, DualPairs::Building::when_asked);
    EXPECT_EQ(all.built_count(), all.pair_count());
    EXPECT_EQ(later.built_count(), 0U);
    std::vector<WholeRay> rays(4000);
    for (WholeRay& ray : rays)
        ray = ray_within(20, 5, random);
    std::vector<std::optional<std::uint32_t>> found(rays.size());
    parallel_ranges(rays.size(), 16, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            found[i] = later.first_rectangle(rays[i]);
    });
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(found[i], all.first_rectangle(rays[i]));
    EXPECT_GT(later.built_count(), 0U);
    EXPECT_LE(later.built_count(), later.pair_count());
}

TEST(DualPairs, TakeNoMoreMemoryThanForecast) {
    Random random(8);
    for (const std::size_t count : {0U, 1U, 5U, 20U})
        for (const std::int32_t reach : {2, 1000}) {
            const Rectangles rectangles = rectangles_within(count, reach, reach, random);
            for (const Stabbing kind : {Stabbing::first_of_all, Stabbing::from_a_rank}) {
                const DualPairs pairs(rectangles, kind);
                const double forecast = DualPairs::bytes_forecast(count, kind);
                EXPECT_LE(static_cast<double>(pairs.bytes()), forecast) << count << ' ' << reach;
                if (count == 20 && reach == 1000) {
                    EXPECT_GE(static_cast<double>(pairs.bytes()), 0.1 * forecast);
                }
            }
            const DualBits bits(rectangles);
            const double forecast = DualBits::bytes_forecast(count);
            EXPECT_LE(static_cast<double>(bits.bytes()), forecast) << count << ' ' << reach;
            if (count == 20 && reach == 1000) {
                EXPECT_GE(static_cast<double>(bits.bytes()), 0.1 * forecast);
            }
        }
}

TEST(DualPairs, AreForecastByASample) {
    Random random(11);
    const Rectangles rectangles = rectangles_within(40, 1000, 500, random);
    // What is there before pairs are built, every machine has.
    const MemoryLimit little(1);
    EXPECT_THROW(DualPairs{rectangles}, std::runtime_error);
    EXPECT_NO_THROW(DualPairs(rectangles, Stabbing::from_a_rank, DualPairs::Building::when_asked));
}

std::string refusal(const std::function<void()>& ask) {
    try {
        ask();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

TEST(DualPairs, AreRefusedBeforeMemoryRunsOut) {
    Random random(9);
    const Rectangles rectangles = rectangles_within(300, 10000, 50, random);
    const MemoryLimit little(1);
    EXPECT_THAT(
        refusal([&] { const DualPairs pairs(rectangles); }),
        ::testing::AllOf(
            ::testing::StartsWith(
                "locating rays among the pairs of sides of 300 rectangles takes about "),
            ::testing::EndsWith(
                ": bits in place of pairs, and fewer rectangles take less; nested trees take far "
                "less")));
    EXPECT_THAT(
        refusal([&] { const DualBits bits(rectangles); }),
        ::testing::StartsWith("the bits of the pairs of sides of 300 rectangles takes about "));
}

TEST(DualPairs, RefuseWhatTheyCannotHold) {
    EXPECT_EQ(
        refusal([] { const DualPairs pairs(Rectangles(16384)); }),
        "16384 rectangles are more than point location among the lines of their sides can number, "
        "and 16383 the most: nested trees take more");
    EXPECT_THAT(
        refusal([] {
            const DualBits bits(Rectangles{{0, 1, 0, 0, 0}});
        }),
        "rectangle 0 has a lower side above its upper side: exchange the two");
    const DualPairs pairs(Rectangles{{}});
    EXPECT_THAT(
        refusal([&] {
            pairs.first_rectangle({{0, 0, 0}, {1, 1, 0}});
        }),
        ::testing::StartsWith("the ray's direction has no z"));
}

TEST(DualPairs, TellHowFarTheyAreAndCanBeStopped) {
    Random random(10);
    const Rectangles rectangles = rectangles_within(12, 1000, 50, random);
    double last = 0;
    const DualPairs pairs(
        rectangles, Stabbing::from_a_rank, DualPairs::Building::all, [&](double done) {
            EXPECT_GE(done, last);
            last = done;
        });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(
        DualPairs(rectangles, Stabbing::from_a_rank, DualPairs::Building::all, {}, &cancel),
        Cancelled);
    EXPECT_THROW(DualBits(rectangles, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
