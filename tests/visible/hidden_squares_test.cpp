// SPDX-License-Identifier: Apache-2.0
// Squares of cells hide what all of its cells hide, asked one by one.
#include "vera/visible/edges.h"
#include "vera/visible/hidden_squares.h"
#include "vera/visible/screen_box.h"
#include "vera/visible/sheets.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double near_all = 10;
constexpr int shift = screen_bits - 6; // 64 x 64 cells

/// Of which every cell blocks what is less near than this.
Cells blocked_cells(double blocked) {
    Cells cells;
    cells.shift = shift;
    cells.per_side = std::int32_t{1} << (screen_bits - shift);
    cells.blocked.assign(
        static_cast<std::size_t>(cells.per_side) * static_cast<std::size_t>(cells.per_side),
        blocked);
    return cells;
}

/// Rectangles of open cells, with borders on few lines.
void open_some(Cells& cells, std::mt19937_64& random) {
    const auto place = [&] { return static_cast<std::int32_t>(random() % 9) * 8; };
    for (std::uint64_t count = random() % 4; count > 0; --count) {
        const std::int32_t left = std::min(place(), cells.per_side - 1);
        const std::int32_t low = std::min(place(), cells.per_side - 1);
        const std::int32_t wide = 1 + static_cast<std::int32_t>(random() % 12);
        const std::int32_t high = 1 + static_cast<std::int32_t>(random() % 12);
        for (std::int32_t row = low; row < std::min(low + high, cells.per_side); ++row)
            for (std::int32_t column = left; column < std::min(left + wide, cells.per_side);
                 ++column)
                cells.blocked[cells.number(column, row)] = near_all * (random() % 3 == 0 ? 0 : 1);
    }
}

/// On the corners of cells, often of squares, or a step or two beside.
ScreenPoint some_point(std::mt19937_64& random) {
    const auto coordinate = [&] {
        const std::uint64_t among = random() % 2 == 0 ? 8 : 1;
        const auto corner = static_cast<std::int64_t>(random() % (64 / among + 1) * among) << shift;
        const auto beside = static_cast<std::int64_t>(random() % 5) - 2;
        return static_cast<std::int32_t>(std::clamp<std::int64_t>(corner + beside, 0, screen_size));
    };
    const std::int32_t x = coordinate();
    const std::int32_t y = coordinate();
    return {x, y};
}

TEST(HiddenSquares, HideNothingThatACellDoesNotHide) {
    std::mt19937_64 random(1);
    std::size_t hidden = 0;
    std::size_t not_found = 0;
    for (int scene = 0; scene < 400; ++scene) {
        Cells cells = blocked_cells(2 * near_all);
        open_some(cells, random);
        const HiddenSquares squares(cells);
        for (int i = 0; i < 50; ++i) {
            std::array<ScreenPoint, 3> points = {};
            for (ScreenPoint& point : points)
                point = some_point(random);
            const auto is_hidden_in = [&](std::size_t cell) {
                return near_all < cells.blocked[cell];
            };
            bool is_triangle_hidden = true;
            for_each_cell_of(
                cells,
                {ScreenVertex{points[0], 0},
                 ScreenVertex{points[1], 0},
                 ScreenVertex{points[2], 0}},
                [&](std::size_t cell) {
                    is_triangle_hidden = is_triangle_hidden && is_hidden_in(cell);
                });
            const bool is_segment_hidden =
                for_each_cell_along(cells, points[0], points[1], is_hidden_in);
            const bool is_triangle_found = squares.hide(near_all, points);
            const bool is_segment_found = squares.hide(near_all, std::array{points[0], points[1]});
            ASSERT_LE(is_triangle_found, is_triangle_hidden) << "scene " << scene;
            ASSERT_LE(is_segment_found, is_segment_hidden) << "scene " << scene;
            hidden += is_triangle_hidden ? 1 : 0;
            hidden += is_segment_hidden ? 1 : 0;
            not_found += is_triangle_hidden && !is_triangle_found ? 1 : 0;
            not_found += is_segment_hidden && !is_segment_found ? 1 : 0;
        }
    }
    EXPECT_GT(hidden, 5000U);
    EXPECT_LT(not_found, hidden / 3); // short ones, and those that pass by open cells of a square
}

TEST(HiddenSquares, HideALongSliverByTheSquaresAlongIt) {
    Cells cells = blocked_cells(2 * near_all);
    const auto point = [](std::int32_t column, std::int32_t row) {
        return ScreenPoint{column << shift, row << shift};
    };
    const std::array sliver = {point(1, 1), point(2, 1), point(62, 61)};
    EXPECT_TRUE(HiddenSquares(cells).hide(near_all, sliver));
    EXPECT_FALSE(HiddenSquares(cells).hide(3 * near_all, sliver));
    cells.blocked[cells.number(60, 2)] = 0; // far from it
    EXPECT_TRUE(HiddenSquares(cells).hide(near_all, sliver));
    std::size_t looked_at = 0;
    HiddenSquares(cells).hide(near_all, sliver, [&] { ++looked_at; });
    EXPECT_LT(looked_at, 64U);
    cells.blocked[cells.number(31, 31)] = 0;
    EXPECT_FALSE(HiddenSquares(cells).hide(near_all, sliver));
    EXPECT_FALSE(HiddenSquares(cells).hide(near_all, std::array{point(1, 1), point(4, 4)}));
}

TEST(HiddenSquares, AreNoneOfFewCells) {
    Cells cells;
    cells.blocked.assign(1, 2 * near_all);
    EXPECT_FALSE(HiddenSquares(cells).hide(
        near_all, std::array{ScreenPoint{0, 0}, ScreenPoint{screen_size, screen_size}}));
}

/// What large sheets leave out of lists is less near than what blocks the cell, and they block
/// nothing that the sheets of all triangles do not.
TEST(HiddenSquares, OfLargeSheetsLeaveOutOnlyWhatIsHidden) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        ScreenScene scene = testing::scattered(seed, 2000, screen_size / 60);
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        for (const ScreenPoint point :
             {ScreenPoint{screen_size / 8, 0},
              ScreenPoint{screen_size, 0},
              ScreenPoint{screen_size, screen_size / 2},
              ScreenPoint{screen_size / 8, screen_size}})
            scene.vertices.push_back({point, depth_size / 2});
        add_triangle(scene, {first, first + 1, first + 2}, first);
        add_triangle(scene, {first, first + 2, first + 3}, first);
        const std::vector<NearnessSlope> slopes = slopes_of(scene);
        const ScreenEdges edges = screen_edges(scene);
        const std::vector<EdgeNeighbours> neighbours = edge_neighbours(scene, edges);
        const SheetScene sheets = {scene, edges, neighbours, slopes};
        const Cells without = cells_of(scene, slopes);
        const Cells with = cells_of(scene, slopes, nullptr, {}, &sheets);
        ASSERT_EQ(with.blocked.size(), without.blocked.size());
        std::size_t left_out = 0;
        for (std::size_t cell = 0; cell < with.blocked.size(); ++cell) {
            const auto kept = with.triangles_of(cell);
            for (const std::uint32_t i : without.triangles_of(cell)) {
                if (std::ranges::binary_search(kept, i))
                    continue;
                ++left_out;
                const auto corners = corners_of(scene, scene.triangles[i]);
                ASSERT_LT(
                    nearest_for_hiding(
                        slopes[i],
                        std::array{corners[0].point, corners[1].point, corners[2].point}),
                    with.blocked[cell]);
            }
            ASSERT_TRUE(std::ranges::includes(without.triangles_of(cell), kept));
        }
        EXPECT_GT(left_out, 30U);
        Cells cells_of_all = without;
        block_by_sheets(cells_of_all, sheets);
        for (std::size_t cell = 0; cell < with.blocked.size(); ++cell)
            ASSERT_LE(with.blocked[cell], cells_of_all.blocked[cell]);
    }
}

/// One point at least of the figure in the box: a corner of either in the other, or two sides that
/// meet.
bool do_meet_by_sides(const ScreenBox& box, const std::vector<ScreenPoint>& figure) {
    const auto at = [](std::int64_t x, std::int64_t y) {
        return ScreenPoint{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
    };
    const std::vector<ScreenPoint> square = {
        at(box.x.least, box.y.least),
        at(box.x.most, box.y.least),
        at(box.x.most, box.y.most),
        at(box.x.least, box.y.most)};
    const auto encloses = [](const std::vector<ScreenPoint>& outline, ScreenPoint point) {
        bool left = true;
        bool right = true;
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const auto side = orientation(outline[i], outline[(i + 1) % outline.size()], point);
            left = left && side >= 0;
            right = right && side <= 0;
        }
        return left != right; // all on one line: nothing is enclosed
    };
    const auto cross_each_other = [](ScreenPoint a, ScreenPoint b, ScreenPoint c, ScreenPoint d) {
        const auto are_apart = [](ScreenPoint p, ScreenPoint q, ScreenPoint r, ScreenPoint s) {
            const auto first = orientation(p, q, r);
            const auto second = orientation(p, q, s);
            return (first > 0 && second > 0) || (first < 0 && second < 0);
        };
        return !are_apart(a, b, c, d) && !are_apart(c, d, a, b)
            && std::max(a.x, b.x) >= std::min(c.x, d.x) && std::max(c.x, d.x) >= std::min(a.x, b.x)
            && std::max(a.y, b.y) >= std::min(c.y, d.y) && std::max(c.y, d.y) >= std::min(a.y, b.y);
    };
    for (const ScreenPoint corner : figure)
        if (encloses(square, corner))
            return true;
    for (std::size_t i = 0; i < 4; ++i) {
        if (encloses(figure, square[i]))
            return true;
        for (std::size_t k = 0; k < figure.size(); ++k)
            if (cross_each_other(
                    square[i], square[(i + 1) % 4], figure[k], figure[(k + 1) % figure.size()]))
                return true;
    }
    return false;
}

TEST(ScreenBox, MeetsWhatHasAPointOfIt) {
    std::mt19937 random(16);
    int meeting = 0;
    for (int round = 0; round < 20000; ++round) {
        std::vector<ScreenPoint> figure(2 + random() % 2);
        for (ScreenPoint& corner : figure) {
            corner.x = static_cast<std::int32_t>(random() % 9);
            corner.y = static_cast<std::int32_t>(random() % 9);
        }
        ScreenBox box;
        for (ScreenRange* const range : {&box.x, &box.y}) {
            range->least = 2 + static_cast<std::int64_t>(random() % 3);
            range->most = range->least + 1 + static_cast<std::int64_t>(random() % 3);
        }
        const bool is = do_meet_by_sides(box, figure);
        meeting += is ? 1 : 0;
        ASSERT_EQ(do_meet(box, figure), is) << round;
    }
    EXPECT_GT(meeting, 5000);
    EXPECT_LT(meeting, 18000);
}

} // namespace
} // namespace vera
