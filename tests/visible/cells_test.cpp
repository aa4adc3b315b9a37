// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cells.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/sheets.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::layers;
using testing::scattered;
using testing::tangle;
using testing::terrain;

/// Slanting so that none is nearer than another everywhere.
ScreenScene slanting_one_behind_the_other() {
    ScreenScene scene;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        scene.vertices.push_back({{0, static_cast<std::int32_t>(i)}, depth_size / 2 - i});
        scene.vertices.push_back({{screen_size, 0}, depth_size / 2});
        scene.vertices.push_back({{0, screen_size}, depth_size / 2 + i});
        add_triangle(scene, {first, first + 1, first + 2}, i);
    }
    return scene;
}

TEST(Cells, HoldListsInProportionToTheTrianglesHoweverManyLieOneBehindTheOther) {
    const ScreenScene scene = slanting_one_behind_the_other();
    EXPECT_LE(cells_of(scene).triangles.size(), 64 * scene.triangles.size() + 65536);
}

/// Whoever is asked may make use of it: rounds of cutting take then what they keep.
TEST(Cells, AreAskedForOnceWhereThereAreFewerInTheEnd) {
    const ScreenScene scene = slanting_one_behind_the_other();
    const std::vector<NearnessSlope> slopes = slopes_of(scene);
    const Cells all = cells_of(scene, slopes);
    int calls = 0;
    std::int32_t asked_per_side = 0;
    // Not in the lower left quarter of the picture; elsewhere one corner of each larger cell.
    const auto is_asked = [&](std::int32_t column, std::int32_t row) {
        return column >= asked_per_side / 4 || row >= asked_per_side / 4;
    };
    const Cells some = cells_of(scene, slopes, nullptr, [&](const Cells& cells) {
        ++calls;
        asked_per_side = cells.per_side;
        std::vector<std::uint8_t> asked(cells.blocked.size());
        for (std::int32_t row = 0; row < cells.per_side; ++row)
            for (std::int32_t column = 0; column < cells.per_side; ++column)
                asked[cells.number(column, row)] =
                    is_asked(column, row) && column % 2 == 1 && row % 2 == 1 ? asked_for
                                                                             : not_asked;
        return asked;
    });
    EXPECT_EQ(calls, 1);
    EXPECT_LT(some.per_side, asked_per_side);
    ASSERT_EQ(some.per_side, all.per_side);
    const std::int32_t width = asked_per_side / some.per_side;
    std::size_t entries = 0;
    for (std::int32_t row = 0; row < some.per_side; ++row)
        for (std::int32_t column = 0; column < some.per_side; ++column) {
            const std::size_t cell = some.number(column, row);
            const bool are_same =
                std::ranges::equal(some.triangles_of(cell), all.triangles_of(cell));
            if (is_asked(column * width, row * width))
                EXPECT_TRUE(are_same) << column << ' ' << row;
            else
                EXPECT_TRUE(some.triangles_of(cell).empty()) << column << ' ' << row;
            entries += some.triangles_of(cell).size();
        }
    EXPECT_GT(entries, scene.triangles.size());
}

TEST(Cells, ThatAreAskedForHoldAndAreBlockedByTheSameAsIfAllWere) {
    std::size_t entries = 0;
    for (std::uint64_t seed = 0; seed < 60 && !HasFailure(); ++seed) {
        const ScreenScene scene = seed % 3 == 0 ? terrain(seed, 4 << (seed % 4))
            : seed % 3 == 1 ? layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4))
                            : scattered(seed, 10 * seed, screen_size / 30);
        const std::vector<NearnessSlope> slopes = slopes_of(scene);
        const Cells all = cells_of(scene, slopes);
        // From none of them to all: mostly few, which most triangles touch none of.
        std::mt19937_64 random(seed);
        std::vector<std::uint8_t> is_asked(all.blocked.size());
        for (std::uint8_t& asked : is_asked)
            asked = random() % 60 < seed / 2 ? 1 : 0;
        const Cells some = cells_of(scene, slopes, nullptr, [&](const Cells&) { return is_asked; });
        ASSERT_EQ(some.blocked.size(), is_asked.size());
        for (std::size_t cell = 0; cell < is_asked.size(); ++cell) {
            if (is_asked[cell] == 0) {
                EXPECT_TRUE(some.triangles_of(cell).empty()) << "seed " << seed;
                continue;
            }
            EXPECT_TRUE(std::ranges::equal(some.triangles_of(cell), all.triangles_of(cell)))
                << "seed " << seed;
            EXPECT_EQ(some.blocked[cell], all.blocked[cell]) << "seed " << seed;
            entries += some.triangles_of(cell).size();
        }
    }
    EXPECT_GT(entries, 1000U);
}

TEST(CellsInRows, AreThereWhereOneOfThemIsMarked) {
    std::mt19937_64 random(3);
    for (const std::int32_t per_side : {1, 2, 8}) {
        Cells cells;
        cells.per_side = per_side;
        std::vector<std::uint8_t> is_marked(cells.number(0, per_side));
        for (std::uint8_t& mark : is_marked)
            mark = random() % 4 == 0 ? 2 : 0;
        const CellsInRows in_rows(cells, is_marked);
        for (std::int32_t row = 0; row < per_side; ++row)
            for (std::int32_t first = 0; first < per_side; ++first) {
                bool is_any = false;
                for (std::int32_t last = first; last < per_side; ++last) {
                    is_any = is_any || is_marked[cells.number(last, row)] != 0;
                    EXPECT_EQ(in_rows.are_any({first, last}, row), is_any);
                }
            }
    }
}

TEST(Cells, AreBlockedByNothingNearerThanWhatCoversThem) {
    std::size_t blocked = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        ScreenScene scene = seed % 3 == 0 ? terrain(seed, 4 << (seed % 5))
            : seed % 3 == 1 ? layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4))
                            : tangle(seed, 2 + seed % 30, 8);
        whole_pieces(scene); // cuts what is tangled to slivers
        const std::vector<NearnessSlope> slopes = slopes_of(scene);
        const ScreenEdges edges = screen_edges(scene);
        Cells cells = cells_of(scene, slopes);
        const std::vector<double> alone = cells.blocked;
        block_by_sheets(cells, {scene, edges, edge_neighbours(scene, edges), slopes});
        std::mt19937_64 random(seed);
        for (int i = 0; i < 200; ++i) {
            const auto x = static_cast<std::int32_t>(random() % screen_size);
            const auto y = static_cast<std::int32_t>(random() % screen_size);
            const std::size_t cell = cells.number(cells.cell_of(x), cells.cell_of(y));
            double nearest = -1;
            for (std::size_t j = 0; j < scene.triangles.size(); ++j) {
                const auto corners = corners_of(scene, scene.triangles[j]);
                const auto is_left = [&](std::size_t k) {
                    return orientation(corners[k].point, corners[(k + 1) % 3].point, {x, y}) >= 0;
                };
                if (is_left(0) && is_left(1) && is_left(2))
                    nearest = std::max(
                        nearest, slopes[j].at({static_cast<double>(x), static_cast<double>(y)}));
            }
            EXPECT_LE(cells.blocked[cell], nearest) << "seed " << seed << " at " << x << " " << y;
            blocked += cells.blocked[cell] > alone[cell] ? 1 : 0;
        }
    }
    EXPECT_GT(blocked, 200U);
}

/// Squares each on a larger one, as slices of a pyramid: no one triangle covers a cell on their
/// diagonals. Each square's border lies in a few cells alone.
TEST(Cells, HoldOfSlicesOneOnAnotherOnlyThoseThatAreSeen) {
    for (const std::int32_t count : {250, 1000, 4000}) {
        ScreenScene scene;
        for (std::int32_t i = 0; i < count; ++i) {
            const auto first = static_cast<std::uint32_t>(scene.vertices.size());
            const std::int32_t low = screen_size / 2 / (count + 1) * (i + 1);
            const std::int32_t high = screen_size - low;
            for (const ScreenPoint point :
                 {ScreenPoint{low, low}, {high, low}, {high, high}, {low, high}})
                scene.vertices.push_back({point, depth_size / 2 + 1000 * i});
            const auto source = static_cast<std::uint32_t>(i);
            add_triangle(scene, {first, first + 1, first + 2}, source);
            add_triangle(scene, {first, first + 2, first + 3}, source);
        }
        const std::vector<NearnessSlope> slopes = slopes_of(scene);
        const ScreenEdges edges = screen_edges(scene);
        const std::vector<EdgeNeighbours> neighbours = edge_neighbours(scene, edges);
        const SheetScene sheets = {scene, edges, neighbours, slopes};
        Cells cells = cells_of(scene, slopes, nullptr, {}, &sheets);
        block_by_sheets(cells, sheets);
        std::size_t longest = 0;
        for (std::size_t cell = 0; cell < cells.blocked.size(); ++cell)
            longest = std::max(longest, cells.triangles_of(cell).size());
        EXPECT_LE(longest, 300U) << count;
    }
}

} // namespace
} // namespace vera
