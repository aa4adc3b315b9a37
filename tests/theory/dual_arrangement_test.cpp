// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/dual_arrangement.h"
#include "vera/theory/whole_within.h"

#include <algorithm>
#include <bit>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

using Lines = std::vector<DualLine>;

/// Of few values: many cross in common points, are parallel, or are the two ends of a point.
Lines some_lines(std::size_t count, std::int32_t reach, std::mt19937_64& random) {
    Lines lines;
    for (std::size_t i = 0; i < count; ++i) {
        DualLine line;
        line.end.x = whole_within(reach, random);
        line.end.y = whole_within(reach, random);
        line.is_upper = random() % 2 == 0;
        if (std::find(lines.begin(), lines.end(), line) == lines.end())
            lines.push_back(line);
    }
    return lines;
}

/// Heights of points on each line at the slope, and beside each.
std::vector<SideView> views_at(const Lines& lines, Slope slope) {
    std::vector<SideView> views;
    for (const DualLine& line : lines)
        for (std::int64_t beside = -1; beside <= 1; ++beside)
            views.push_back({slope, height_at(line, slope) + beside});
    return views;
}

/// Compares all places of the arrangement: at each slope where lines cross, and between.
void compare_everywhere(const Lines& lines, std::size_t& on_lines) {
    const DualArrangement arrangement(lines);
    std::vector<Slope> slopes = {{-1000, 1}, {1000, 1}};
    const auto crossings = arrangement.crossing_slopes();
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        slopes.push_back(crossings[i]);
        if (i > 0) // between the two
            slopes.push_back(
                {crossings[i - 1].rise + crossings[i].rise,
                 crossings[i - 1].run + crossings[i].run});
    }
    DualCounts counts;
    for (const Slope slope : slopes)
        for (const SideView& view : views_at(lines, slope)) {
            const auto expected = brute_force_first_above(lines, view);
            const auto found = arrangement.first_above(view, counts);
            ASSERT_EQ(found.has_value(), expected.has_value());
            if (!found)
                continue;
            // Of several at once any of the kind will do.
            ASSERT_EQ(height_at(lines[*found], slope), height_at(lines[*expected], slope));
            ASSERT_EQ(lines[*found].is_upper, lines[*expected].is_upper);
            on_lines += height_at(lines[*found], slope) == view.height ? 1 : 0;
        }
}

TEST(DualArrangement, FindsTheLineThatLookingAtEachFindsOnLinesAndCrossingsToo) {
    std::mt19937_64 random(1988);
    std::size_t on_lines = 0;
    for (int round = 0; round < 150; ++round) {
        const std::int32_t reach = round % 2 == 0 ? 2 : 5;
        const std::size_t count = random() % 14;
        compare_everywhere(some_lines(count, reach, random), on_lines);
    }
    EXPECT_GT(on_lines, 10000U);
}

TEST(DualArrangement, KeepsEveryOrderOfItsLines) {
    std::mt19937_64 random(2);
    for (int round = 0; round < 40; ++round) {
        const Lines lines = some_lines(20, 4, random);
        const DualArrangement arrangement(lines);
        ASSERT_EQ(arrangement.version_count(), 2 * arrangement.crossing_slopes().size() + 1);
        for (std::size_t i = 0; i < arrangement.crossing_slopes().size(); ++i) {
            const Slope slope = arrangement.crossing_slopes()[i];
            const std::vector<std::uint32_t> order = arrangement.order(2 * i + 1);
            ASSERT_EQ(order.size(), lines.size());
            for (std::size_t k = 1; k < order.size(); ++k) {
                const DualLine& below = lines[order[k - 1]];
                const DualLine& above = lines[order[k]];
                const std::int64_t height_below = height_at(below, slope);
                const std::int64_t height_above = height_at(above, slope);
                ASSERT_LE(height_below, height_above);
                if (height_below == height_above) {
                    ASSERT_LE(below.is_upper, above.is_upper);
                }
            }
        }
    }
}

TEST(DualArrangement, TakesStepsAsTheLogarithm) {
    std::mt19937_64 random(3);
    for (const std::size_t count : {10U, 60U, 200U}) {
        const Lines lines = some_lines(count, 10000, random);
        const DualArrangement arrangement(lines);
        for (int i = 0; i < 200; ++i) {
            SideView view;
            view.slope.rise = whole_within(1000, random);
            view.height = whole_within(10000, random);
            DualCounts counts;
            arrangement.first_above(view, counts);
            ASSERT_LE(
                counts.steps(),
                static_cast<std::uint64_t>(
                    std::bit_width(arrangement.crossing_slopes().size()) + std::bit_width(count)
                    + 2));
        }
        EXPECT_LE(
            static_cast<double>(arrangement.bytes()),
            DualArrangement::bytes_forecast(lines.size()));
    }
}

TEST(DualArrangement, HoldsTheLargestNumbers) {
    constexpr std::int32_t most = largest_plane_coordinate;
    const Lines lines = {
        {{-most, -most}, false},
        {{-most, most}, true},
        {{most, -most}, false},
        {{most, most}, true}};
    std::size_t on_lines = 0;
    const DualArrangement arrangement(lines);
    DualCounts counts;
    constexpr std::int64_t steepest = std::int64_t{1} << 31;
    for (const Slope slope :
         {Slope{steepest, 1}, Slope{-steepest, 1}, Slope{0, steepest}, Slope{1, 1}})
        for (const SideView& view : views_at(lines, slope)) {
            const auto expected = brute_force_first_above(lines, view);
            const auto found = arrangement.first_above(view, counts);
            ASSERT_EQ(found.has_value(), expected.has_value());
            if (found) {
                ASSERT_EQ(height_at(lines[*found], slope), height_at(lines[*expected], slope));
            }
            ++on_lines;
        }
    EXPECT_EQ(on_lines, 48U);
}

TEST(DualArrangement, CanBeStopped) {
    std::mt19937_64 random(4);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(DualArrangement(some_lines(20, 100, random), {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
