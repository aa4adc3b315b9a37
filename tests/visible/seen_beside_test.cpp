// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/seen_beside.h"
#include "vera/visible/triangle_order.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr ScreenPoint edge_begin = {2'000'000, 2'000'000};
constexpr ScreenPoint edge_end = {2'000'400, 2'000'300};

void add_over_the_edge(ScreenScene& scene, std::array<std::int64_t, 3> nearness) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    const auto source = static_cast<std::uint32_t>(scene.triangles.size());
    scene.vertices.push_back({{1'999'000, 1'999'000}, nearness[0]});
    scene.vertices.push_back({{2'004'000, 1'999'000}, nearness[1]});
    scene.vertices.push_back({{1'999'000, 2'004'000}, nearness[2]});
    add_triangle(scene, {first, first + 1, first + 2}, source);
}

/// Triangles over all of the edge, in groups far behind each other, in each of which the corners
/// are within steps: of many the order goes round.
ScreenScene near_each_other(std::mt19937& random, std::size_t count, std::int64_t groups) {
    ScreenScene scene;
    for (std::size_t i = 0; i < count; ++i) {
        const auto group = static_cast<std::int64_t>(random()) % groups;
        std::array<std::int64_t, 3> nearness = {};
        for (std::int64_t& near : nearness)
            near = 100'000 + 40 * group + static_cast<std::int64_t>(random() % 9);
        add_over_the_edge(scene, nearness);
    }
    return scene;
}

NearnessPlace place_of(ScreenPoint point) {
    return {static_cast<double>(point.x), static_cast<double>(point.y)};
}

/// Of all numbers, those from which a way leads to each other one from who is in front to who is
/// behind: the fewest that none of the others is in front of.
std::vector<std::uint32_t> foremost(
    const ScreenScene& scene,
    const std::vector<NearnessSlope>& slopes,
    const SeenBeside& seen,
    const std::vector<std::uint32_t>& all) {
    const auto middle = [&](std::uint32_t i) {
        return 0.5 * (slopes[i].at(place_of(edge_begin)) + slopes[i].at(place_of(edge_end)));
    };
    const auto is_in_front = [&](std::uint32_t a, std::uint32_t b) {
        if (seen.hides(a, b) || seen.hides(b, a))
            return seen.hides(a, b);
        const FrontOrder order = triangle_order(scene, slopes, a, b);
        return order == FrontOrder::penetrating ? middle(a) > middle(b)
                                                : order == FrontOrder::first;
    };
    const std::size_t count = all.size();
    std::vector<std::vector<bool>> leads(count, std::vector<bool>(count));
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = a + 1; b < count; ++b) {
            const bool first = is_in_front(all[a], all[b]);
            leads[a][b] = first;
            leads[b][a] = !first;
        }
    for (std::size_t by = 0; by < count; ++by)
        for (std::size_t a = 0; a < count; ++a)
            for (std::size_t b = 0; b < count; ++b)
                if (leads[a][by] && leads[by][b])
                    leads[a][b] = true;
    std::vector<std::uint32_t> found;
    for (std::size_t a = 0; a < count; ++a) {
        bool is_foremost = true;
        for (std::size_t b = 0; b < count; ++b)
            is_foremost = is_foremost && (a == b || leads[a][b]);
        if (is_foremost)
            found.push_back(all[a]);
    }
    return found;
}

TEST(SeenBeside, AmongAllIsTheFirstOfTheForemost) {
    std::mt19937 random(21);
    std::size_t going_round = 0;
    for (std::uint32_t round = 0; round < 2000; ++round) {
        const ScreenScene scene = near_each_other(random, 1 + round % 14, 1 + round % 3);
        const std::vector<NearnessSlope> slopes = slopes_of(scene);
        SeenBeside seen(scene, slopes);
        seen.follow(edge_begin, edge_end);
        seen.start(place_of(edge_begin), place_of(edge_end), Hiding::by_nothing);
        std::vector<std::uint32_t> order(scene.triangles.size());
        for (std::uint32_t i = 0; i < order.size(); ++i)
            order[i] = i;
        std::shuffle(order.begin(), order.end(), random);
        std::array<std::vector<std::uint32_t>, 2> beside;
        for (const std::uint32_t i : order) {
            const auto sides = static_cast<std::uint8_t>(
                random() % 3 == 0 ? 1 + random() % 2 : left_side | right_side);
            seen.add(i, sides);
            for (std::size_t side = 0; side < 2; ++side)
                if ((sides & (1U << side)) != 0)
                    beside[side].push_back(i);
        }
        std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating;
        const SeenBeside::Seen found = seen.find(penetrating, true);
        const std::array<std::uint32_t, 2> numbers = {found.left, found.right};
        for (std::size_t side = 0; side < 2; ++side) {
            std::sort(beside[side].begin(), beside[side].end());
            const auto expected = foremost(scene, slopes, seen, beside[side]);
            going_round += expected.size() > 1 ? 1 : 0;
            if (expected.empty())
                EXPECT_EQ(numbers[side], SeenBeside::nothing) << round;
            else
                EXPECT_EQ(order[numbers[side]], expected[0]) << round;
        }
    }
    EXPECT_GT(going_round, 100U);
}

/// However many lie in one plane far behind.
TEST(SeenBeside, AmongAllComparesThoseInFrontAlone) {
    ScreenScene scene;
    for (int i = 0; i < 2000; ++i)
        add_over_the_edge(scene, {1000, 1000, 1000});
    for (const std::int64_t near : {100'000, 100'001, 100'002})
        add_over_the_edge(scene, {near, near, near});
    const std::vector<NearnessSlope> slopes = slopes_of(scene);
    SeenBeside seen(scene, slopes);
    seen.follow(edge_begin, edge_end);
    seen.start(place_of(edge_begin), place_of(edge_end), Hiding::by_nothing);
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i)
        seen.add(i, i == 2000 ? left_side : left_side | right_side);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating;
    seen.find(penetrating, true);
    EXPECT_GT(seen.comparisons(), 0U);
    EXPECT_LE(seen.comparisons(), 10U);
}

} // namespace
} // namespace vera
