// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/plane_sweep.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// A scene of about so many triangles.
using Family = std::function<ScreenScene(std::size_t)>;

/// Small triangles, as many one behind the other whatever their number is.
ScreenScene scatter(std::size_t count) {
    const double size = screen_size * std::sqrt(40.0 / static_cast<double>(count));
    return testing::scattered(1, count, static_cast<std::int32_t>(size));
}

/// Triangles of one size: ever more lie one behind the other.
ScreenScene deep(std::size_t count) {
    return testing::scattered(2, count, screen_size / 4);
}

ScreenScene balls(std::size_t count) {
    const double segments = std::sqrt(static_cast<double>(count) / 8);
    return testing::balls(1, 4, static_cast<std::int32_t>(segments));
}

ScreenScene terrain(std::size_t count) {
    return testing::terrain(
        1, static_cast<std::int32_t>(std::sqrt(static_cast<double>(count) / 2)));
}

/// From one point to the other, so many steps wide where it begins; sides go from left to right or
/// from top to bottom.
void add_sliver(
    ScreenScene& scene, ScreenPoint from, ScreenPoint to, ScreenPoint wide, std::int64_t nearness) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.push_back({from, nearness});
    scene.vertices.push_back({{from.x + wide.x, from.y + wide.y}, nearness});
    scene.vertices.push_back({to, nearness});
    add_triangle(scene, {first, first + 1, first + 2}, first / 3);
}

/// Side by side across the picture, at a slant.
ScreenScene stripes(std::size_t count) {
    ScreenScene scene;
    const std::int32_t spacing = screen_size / 2 / static_cast<std::int32_t>(count);
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(count); ++i)
        add_sliver(
            scene,
            {0, i * spacing},
            {screen_size, i * spacing + screen_size / 3},
            {0, spacing / 2},
            5);
    return scene;
}

/// Two bundles of slivers, each of which crosses each of the other.
ScreenScene grate(std::size_t count) {
    ScreenScene scene;
    const auto each = static_cast<std::int32_t>(count / 2);
    const std::int32_t spacing = screen_size / each;
    for (std::int32_t i = 0; i < each; ++i) {
        add_sliver(
            scene,
            {0, i * spacing},
            {screen_size, i * spacing + spacing / 4},
            {0, spacing / 2},
            10);
        add_sliver(
            scene,
            {i * spacing, 0},
            {i * spacing + spacing / 4, screen_size},
            {spacing / 2, 0},
            5000);
    }
    return scene;
}

/// The same behind two triangles that hide all of it.
ScreenScene hidden_grate(std::size_t count) {
    ScreenScene scene = grate(count);
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const ScreenPoint point :
         {ScreenPoint{0, 0},
          ScreenPoint{screen_size, 0},
          ScreenPoint{screen_size, screen_size},
          ScreenPoint{0, screen_size}})
        scene.vertices.push_back({point, depth_size / 2});
    add_triangle(scene, {first, first + 1, first + 2}, first);
    add_triangle(scene, {first, first + 2, first + 3}, first);
    return scene;
}

/// One face with so many corners, more or less round, as a fan.
ScreenScene disc(std::size_t count) {
    ScreenScene scene;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = 6.283 * static_cast<double>(i) / static_cast<double>(count);
        const auto place = [&](double part) {
            return static_cast<std::int32_t>(screen_size / 2 * (1 + 0.9 * part));
        };
        scene.vertices.push_back(
            {{place(std::cos(angle)), place(std::sin(angle))}, depth_size / 2});
    }
    for (std::uint32_t i = 2; i < count; ++i)
        add_triangle(scene, {0, i - 1, i}, 0);
    return scene;
}

/// Squares one behind the other, each a bit beside the one before it, so that something is seen of
/// all of them.
ScreenScene pile(std::size_t count) {
    ScreenScene scene;
    const auto squares = static_cast<std::int32_t>(count / 2);
    const std::int32_t wide = screen_size / 2;
    const std::int32_t spacing = screen_size / 2 / squares;
    for (std::int32_t i = 0; i < squares; ++i) {
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        const std::int32_t x = i * spacing;
        const std::int32_t y = i * (spacing / 2); // so that no diagonal lies on another one
        for (const ScreenPoint point :
             {ScreenPoint{x, y},
              ScreenPoint{x + wide, y},
              ScreenPoint{x + wide, y + wide},
              ScreenPoint{x, y + wide}})
            scene.vertices.push_back({point, 1000 + 100 * std::int64_t{i}});
        const auto source = static_cast<std::uint32_t>(i);
        add_triangle(scene, {first, first + 1, first + 2}, source);
        add_triangle(scene, {first, first + 2, first + 3}, source);
    }
    return scene;
}

CellCounts counted_cells(const ScreenScene& scene) {
    CellCounts counts;
    cell_raster(scene, {}, nullptr, {}, &counts);
    return counts;
}

PlaneSweepCounts counted_sweep(const ScreenScene& scene) {
    PlaneSweepCounts counts;
    PlaneSweepSettings settings;
    settings.counts = &counts;
    plane_sweep(scene, settings);
    return counts;
}

double steps(const PlaneSweepCounts& counts) {
    return static_cast<double>(counts.steps());
}

double steps(const CellCounts& counts) {
    return static_cast<double>(
        counts.touched + counts.edge_cells + counts.looked_at + counts.candidates + counts.events
        + counts.active);
}

/// Sizes that grow to 16 times the first.
std::array<std::size_t, 3> sizes(std::size_t first) {
    return {first, 4 * first, 16 * first};
}

TEST(EngineCounts, OfTheSweepGrowNoFasterThanItsBound) {
    const auto check = [](const char* name, const Family& family, std::size_t first) {
        double before = 0;
        for (const std::size_t size : sizes(first)) {
            const ScreenScene scene = family(size);
            const PlaneSweepCounts counts = counted_sweep(scene);
            const auto n = static_cast<double>(scene.triangles.size());
            const double bound = (n + static_cast<double>(counts.crossings)) * std::log2(n);
            const double part = steps(counts) / bound;
            EXPECT_LT(part, 6) << name << " of " << size;
            if (before > 0) {
                EXPECT_LT(part, 1.1 * before) << name << " of " << size;
            }
            before = part;
        }
    };
    check("scatter", scatter, 200);
    check("deep", deep, 60);
    check("balls", balls, 200);
    check("terrain", terrain, 200);
    check("stripes", stripes, 200);
    check("grate", grate, 30);
    check("hidden grate", hidden_grate, 30);
}

TEST(EngineCounts, OfTheCellsGrowNoFasterThanTrianglesWhereWhatIsHiddenLiesBehindLargerOnes) {
    const auto check = [](const char* name, const Family& family, std::size_t first) {
        double before = 0;
        for (const std::size_t size : sizes(first)) {
            const ScreenScene scene = family(size);
            const auto n = static_cast<double>(scene.triangles.size());
            const double each = steps(counted_cells(scene)) / n;
            // Some room: cells grow by powers of two, and so do not fit all sizes as well.
            if (before > 0) {
                EXPECT_LT(each, 1.3 * before) << name << " of " << size;
            }
            before = each;
        }
    };
    check("scatter", scatter, 500);
    check("balls", balls, 500);
    check("terrain", terrain, 500);
    check("hidden grate", hidden_grate, 500);
}

TEST(EngineCounts, OfEdgesWithinALargeFaceAreFew) {
    for (const std::size_t size : sizes(500)) {
        const CellCounts counts = counted_cells(disc(size));
        // Each of them would be compared with many of the others.
        EXPECT_LT(
            counts.looked_at + counts.candidates + counts.events + counts.active, size * size / 4)
            << size;
    }
}

TEST(EngineCounts, OfAPileGrowWithTheEventsAlongItsEdges) {
    // Of what lies one behind the other along an edge, the nearest alone is looked at again and
    // again.
    for (const std::size_t size : sizes(60)) {
        const CellCounts counts = counted_cells(pile(size));
        EXPECT_LT(counts.active, 3 * counts.events) << size;
    }
}

TEST(EngineCounts, OfListsOfTheCellsAreInProportionToTrianglesEverywhere) {
    for (const Family& family : {Family(deep), Family(stripes), Family(hidden_grate)})
        for (const std::size_t size : sizes(250)) {
            const ScreenScene scene = family(size);
            EXPECT_LE(counted_cells(scene).entries, 64 * scene.triangles.size() + 65536);
        }
}

TEST(EngineCounts, AreThoseOfAFormulaWhereNothingMeets) {
    constexpr std::uint64_t count = 300;
    const CellCounts cells = counted_cells(stripes(count));
    EXPECT_EQ(cells.edges, 3 * count);
    EXPECT_EQ(cells.followed, 3 * count); // nothing hides them
    EXPECT_EQ(cells.events, 6 * count);   // where their own triangle begins and ends
    EXPECT_EQ(cells.active, 3 * count);   // between
    EXPECT_GE(cells.touched, cells.entries);
    const PlaneSweepCounts sweep = counted_sweep(stripes(count));
    EXPECT_EQ(sweep.segments, 3 * count);
    EXPECT_EQ(sweep.crossings, 0U);
    EXPECT_EQ(sweep.insertions, count);
    EXPECT_EQ(sweep.candidates, 3 * count);
}

TEST(EngineCounts, AreTheSameForAnyNumberOfThreads) {
    const ScreenScene scene = scatter(3000);
    const CellCounts all = counted_cells(scene);
    const ThreadLimit one(1);
    const CellCounts alone = counted_cells(scene);
    EXPECT_EQ(steps(all), steps(alone));
    EXPECT_EQ(all.depth_orders, alone.depth_orders);
    EXPECT_EQ(all.followed_cells, alone.followed_cells);
}

} // namespace
} // namespace vera
