// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_cells.h"

#include "accel/random_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr std::size_t all_levels = 100;
constexpr std::size_t all_cells = 1U << 30;

TEST(GridCells, AreThoseThatTheTreeCounts) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        testing::RandomSceneSettings settings;
        settings.items = 10 + seed % 3 * 40;
        settings.subscenes = seed % 2 * 3;
        Scene scene = testing::random_scene(seed, settings);
        const GridCells found = grid_cells(scene, {}, all_levels, all_cells);
        EXPECT_TRUE(found.whole) << seed;
        const GridTreeStatistics tree = make_grid_tree(scene)->statistics();
        GridLevel sum;
        for (const GridLevel& level : found.levels) {
            sum.grids += level.grids;
            sum.cells += level.cells;
            sum.full_cells += level.full_cells;
            sum.references += level.references;
            sum.longest_list = std::max(sum.longest_list, level.longest_list);
        }
        if (settings.subscenes == 0) {
            ASSERT_TRUE(scene.subscenes.empty());
            EXPECT_EQ(sum.grids, tree.grids) << seed;
            EXPECT_EQ(sum.cells, tree.cells) << seed;
            EXPECT_EQ(sum.full_cells, tree.cells - tree.empty_cells) << seed;
            EXPECT_EQ(sum.references, tree.references) << seed;
        } else {
            EXPECT_GE(sum.grids, found.levels.size()) << seed;
        }
        EXPECT_LE(sum.longest_list, tree.longest_list) << seed;
    }
}

/// Sixteen balls in a corner make a crowd, one is far away.
Scene crowd_and_one() {
    Scene scene;
    for (int i = 0; i < 41; ++i) {
        Item item;
        item.index = static_cast<std::uint32_t>(i);
        scene.geometry.items.push_back(item);
        const double along = i == 40 ? 100 : 0.5 * (i % 4);
        scene.geometry.spheres.push_back(
            {{along, 0.5 * (i / 4 % 4), along == 100 ? 100 : 0.25 * (i / 16)}, 0.1});
    }
    number_primitives(scene);
    return scene;
}

TEST(GridCells, StandWhereTheirObjectsAre) {
    const Scene scene = crowd_and_one();
    const GridCells found = grid_cells(scene, {}, all_levels, all_cells);
    ASSERT_GE(found.levels.size(), 2U);
    // Every ball's middle is in some cell, and no cell is outside of the scene's box.
    for (const Sphere& sphere : scene.geometry.spheres) {
        bool covered = false;
        for (const FullCell& cell : found.cells) {
            const Vec3 lower = transformed_point(cell.to_scene, {0, 0, 0});
            const Vec3 upper = transformed_point(cell.to_scene, {1, 1, 1});
            bool inside = cell.objects > 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                inside = inside && lower[axis] <= sphere.center[axis] + 1e-9
                    && sphere.center[axis] <= upper[axis] + 1e-9;
                EXPECT_GE(lower[axis], found.box.lower[axis] - 1e-9);
                EXPECT_LE(upper[axis], found.box.upper[axis] + 1e-9);
            }
            covered = covered || inside;
        }
        EXPECT_TRUE(covered) << sphere.center.x << ' ' << sphere.center.y << ' ' << sphere.center.z;
    }
}

TEST(GridCells, EndWhereTheyAreToOrWouldBeTooMany) {
    const Scene scene = crowd_and_one();
    const GridCells all = grid_cells(scene, {}, all_levels, all_cells);
    const GridCells top = grid_cells(scene, {}, 1, all_cells);
    EXPECT_EQ(top.levels.size(), 1U);
    EXPECT_FALSE(top.whole);
    EXPECT_EQ(top.cells.size(), top.levels[0].full_cells);
    EXPECT_LT(top.cells.size(), all.cells.size());
    EXPECT_EQ(grid_cells(scene, {}, all_levels, all.cells.size() - 1).levels.size(), 1U);
    EXPECT_EQ(grid_cells(scene, {}, all_levels, 0).levels.size(), 1U);
    EXPECT_TRUE(grid_cells(Scene{}, {}, all_levels, all_cells).levels.empty());
}

} // namespace
} // namespace vera
