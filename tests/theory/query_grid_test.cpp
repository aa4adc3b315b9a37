// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/query_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr std::array<SweepDirection, 6> directions = {
    {{0, true}, {0, false}, {1, true}, {1, false}, {2, true}, {2, false}}};

/// From few values, and of any size.
double some_number(std::mt19937_64& random) {
    constexpr std::array values = {-1.0, -0.5, 0.0, 0.25, 1.0};
    if (random() % 2 == 0)
        return values[random() % values.size()];
    return static_cast<double>(random() % 2'000'001) / 1e6 - 1;
}

Vec3 some_point(std::mt19937_64& random) {
    const double x = some_number(random);
    const double y = some_number(random);
    const double z = some_number(random);
    return {x, y, z};
}

/// One that goes through the target, often nearly along a plane or an axis.
Ray ray_through(Vec3 target, std::mt19937_64& random) {
    Ray ray;
    do {
        ray.direction = some_point(random);
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (random() % 3 == 0)
                ray.direction[axis] *=
                    std::array{0.0, 1e-9, 1e-3, 0.035, 0.0357, 0.036}[random() % 6];
    } while (!(max_component(abs(ray.direction)) > 1e-6));
    const double distance = std::array{0.0, 0.01, 1.0, 50.0, 3e4}[random() % 5];
    ray.origin = target - (distance / max_component(abs(ray.direction))) * ray.direction;
    return ray;
}

struct Found {
    bool within = false;
    bool swept = false;
};

Found found(const QueryGrid& grid, const StepBox& box, const Ray& ray, double t) {
    Found result;
    result.within = contains(grid.scene_box(box), ray.origin);
    for (const SweepDirection direction : directions)
        if (const auto sloped = grid.sloped_ray(ray, direction)) {
            const IsoRectangle entry = grid.entry(box, direction);
            result.swept |= meets(*sloped, entry) && entry.z <= grid.last_step(ray, t, direction);
        }
    return result;
}

TEST(QueryGrid, TellsEveryRayThatMeetsABox) {
    std::mt19937_64 random(1988);
    int within = 0;
    int swept = 0;
    int steep = 0;
    for (const double scale : {1.0, 1e-30, 3e7})
        for (int round = 0; round < 20000; ++round) {
            const Vec3 middle = random() % 2 == 0 ? Vec3{} : scale * Vec3{5, -7, 1};
            const auto placed = [&](Vec3 point) { return middle + scale * point; };
            const QueryGrid grid({placed({-1, -1, -1}), placed({1, 1, 1})});
            const Vec3 a = some_point(random);
            const Vec3 b =
                random() % 3 == 0 ? Vec3{a.x, a.y, some_number(random)} : some_point(random);
            const Box3 box = {placed(min(a, b)), placed(max(a, b))};
            // Somewhere in the box, often at a corner or on a side.
            Vec3 target;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double part = std::array{0.0, 0.5, 1.0}[random() % 3];
                target[axis] = box.lower[axis] + part * (box.upper[axis] - box.lower[axis]);
            }
            const Ray unit = ray_through({}, random);
            Ray ray = unit;
            ray.origin = target + scale * unit.origin;
            const auto larger = grid.larger_box(box, 0);
            ASSERT_TRUE(larger);
            ASSERT_TRUE(grid.can_hold(ray));
            const double t =
                max_component(abs(target - ray.origin)) / max_component(abs(ray.direction));
            const Found is = found(grid, *larger, ray, t * (1 + 1e-9));
            ASSERT_TRUE(is.within || is.swept) << "scale " << scale << ", round " << round;
            within += is.within ? 1 : 0;
            swept += is.swept ? 1 : 0;
            const Vec3 size = abs(ray.direction);
            steep +=
                is.swept && std::min({size.x, size.y, size.z}) * 28 < max_component(size) ? 1 : 0;
        }
    EXPECT_GT(within, 5000);
    EXPECT_GT(swept, 20000);
    EXPECT_GT(steep, 10000);
}

TEST(QueryGrid, LeavesOutRaysThatPassFarFromABox) {
    const QueryGrid grid({{-1, -1, -1}, {1, 1, 1}});
    const auto box = grid.larger_box({{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, 0);
    ASSERT_TRUE(box);
    for (int i = 0; i < 100; ++i) {
        const double off = 0.12 + 0.01 * i;
        const Found is = found(grid, *box, {{off, 0, -3}, {0, 0, 1}}, 100);
        EXPECT_FALSE(is.within || is.swept) << off;
    }
    EXPECT_FALSE(found(grid, *box, {{0, 0, -3}, {0, 0, 1}}, 2.5).swept) << "it ends before";
    EXPECT_TRUE(found(grid, *box, {{0, 0, -3}, {0, 0, 1}}, 2.95).swept);
    EXPECT_FALSE(found(grid, *box, {{0, 0, 0.2}, {0, 0, 1}}, 100).swept) << "it is behind";
}

/// Rays from one point never exchange their order, wherever the point is.
TEST(QueryGrid, LetsRaysFromOnePointNotCross) {
    std::mt19937_64 random(3);
    for (const Vec3 eye : {Vec3{0.3, 0.2, -40}, Vec3{0.3, 0.2, -1.3}, Vec3{0.1, 0.77, -0.333}}) {
        const QueryGrid grid({{-1, -1, -1}, {1, 1, 1}});
        std::vector<SlopedRay> rays;
        for (int i = 0; i < 300; ++i) {
            const double x = some_number(random);
            const double y = some_number(random);
            const Vec3 direction = {x - eye.x, y - eye.y, 1 - eye.z};
            const auto ray = grid.sloped_ray({eye, direction}, {2, true});
            if (ray)
                rays.push_back(*ray);
        }
        ASSERT_GT(rays.size(), 250U);
        for (const SlopedRay& a : rays)
            for (const SlopedRay& b : rays) {
                ASSERT_EQ(a.first_z, b.first_z);
                const auto begins =
                    value_at(x_point(a), a.first_z) - value_at(x_point(b), b.first_z);
                const auto ends = value_at(x_point(a), QueryGrid::farthest_step)
                    - value_at(x_point(b), QueryGrid::farthest_step);
                ASSERT_FALSE((begins < 0 && ends > 0) || (begins > 0 && ends < 0));
            }
    }
}

TEST(QueryGrid, LetsRaysBeginBehindEverythingThatGoOnBackwards) {
    const QueryGrid grid({{-1, -1, -1}, {1, 1, 1}});
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(grid.beginning({{0, 0, 5}, {0, 0, 2}}), 0);
    EXPECT_EQ(grid.beginning({{0, 0, 5}, {0, 0, 2}, 1}), 0);
    EXPECT_EQ(grid.beginning({{0, 0, 5}, {0, 0, 2}, -1}), -1);
    const Ray endless = {{0, 0, 5}, {0, 0, 2}, -inf};
    EXPECT_LT(point_at(endless, grid.beginning(endless)).z, -1.5);
    EXPECT_GT(point_at(endless, grid.beginning(endless)).z, -9);
}

TEST(QueryGrid, SaysWhatItCannotHold) {
    const QueryGrid grid({{-1, -1, -1}, {1, 1, 1}});
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(grid.can_hold({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_FALSE(grid.can_hold({{0, 0, 0}, {0, 0, 0}}));
    EXPECT_FALSE(grid.can_hold({{0, 0, 1e9}, {0, 0, 1}}));
    EXPECT_FALSE(grid.can_hold({{0, 0, 0}, {0, 0, std::nan("")}}));
    EXPECT_FALSE(grid.can_hold({{0, 0, 0}, {0, 0, 1}, -inf}));
    EXPECT_FALSE(grid.can_hold({{0, 0, 0}, {0, 0, 1}, 0, inf, 1e-3}));
    EXPECT_FALSE(grid.larger_box({{-1, -1, -1}, {1, 1, 1}}, 0.1)) << "so large a slack";
    EXPECT_FALSE(grid.larger_box({{-1, -1, -inf}, {1, 1, 1}}, 0));
}

} // namespace
} // namespace vera
