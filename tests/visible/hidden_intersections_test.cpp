// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/front_order.h"
#include "vera/visible/hidden_intersections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

struct Place {
    double x = 0;
    double y = 0;
};

/// How far inside the triangle the place is, in steps; negative outside.
double depth_within(const std::array<ScreenVertex, 3>& corners, Place place) {
    double depth = 1e300;
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenPoint a = corners[i].point;
        const ScreenPoint b = corners[(i + 1) % 3].point;
        const double x = b.x - a.x;
        const double y = b.y - a.y;
        depth =
            std::min(depth, (x * (place.y - a.y) - y * (place.x - a.x)) / std::sqrt(x * x + y * y));
    }
    return depth;
}

/// A place within both triangles at which their planes are equally near, about; at random.
std::optional<Place>
common_place(const ScreenScene& scene, std::uint32_t a, std::uint32_t b, std::mt19937_64& random) {
    const auto corners = corners_of(scene, scene.triangles[a]);
    const DepthPlane plane = plane_of(scene, scene.triangles[a]);
    const DepthPlane other = plane_of(scene, scene.triangles[b]);
    const auto apart = [&](Place place) {
        return plane.value(place.x, place.y) - other.value(place.x, place.y);
    };
    const auto inner = [&] {
        double u = std::uniform_real_distribution(0.0, 1.0)(random);
        double v = std::uniform_real_distribution(0.0, 1.0)(random);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const auto mixed = [&](double p, double q, double r) {
            return p + u * (q - p) + v * (r - p);
        };
        return Place{
            mixed(corners[0].point.x, corners[1].point.x, corners[2].point.x),
            mixed(corners[0].point.y, corners[1].point.y, corners[2].point.y)};
    };
    for (int i = 0; i < 20; ++i) {
        const Place p = inner();
        const Place q = inner();
        const double at_p = apart(p);
        const double at_q = apart(q);
        if (at_p * at_q >= 0)
            continue;
        const double part = at_p / (at_p - at_q);
        const Place place = {p.x + part * (q.x - p.x), p.y + part * (q.y - p.y)};
        if (depth_within(corners_of(scene, scene.triangles[b]), place) > 4)
            return place;
    }
    return std::nullopt;
}

/// Whether anything but the two covers the place, by asking every triangle; nothing where one has a
/// side, or is about as near, there.
std::optional<bool>
is_covered(const ScreenScene& scene, std::uint32_t a, std::uint32_t b, Place place) {
    constexpr double near = 20; // steps
    const double nearness = plane_of(scene, scene.triangles[a]).value(place.x, place.y);
    bool covered = false;
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        if (i == a || i == b)
            continue;
        const double within = depth_within(corners_of(scene, scene.triangles[i]), place);
        if (within < -near)
            continue;
        const DepthPlane plane = plane_of(scene, scene.triangles[i]);
        const double ahead = plane.value(place.x, place.y) - nearness;
        const auto slope = [&](std::uint32_t triangle) {
            return nearness_slope(plane_of(scene, scene.triangles[triangle])).per_step();
        };
        const double doubtful = near * (slope(i) + slope(a) + slope(b)) + 10;
        if (std::abs(ahead) < doubtful || (ahead > 0 && within < near))
            return std::nullopt;
        covered = covered || ahead > 0;
    }
    return covered;
}

double distance_along(const HiddenIntersection& part, Place place, double& across) {
    const double x = part.to.x() - part.from.x();
    const double y = part.to.y() - part.from.y();
    const double length = std::sqrt(x * x + y * y);
    across = std::abs(x * (place.y - part.from.y()) - y * (place.x - part.from.x())) / length;
    return (x * (place.x - part.from.x()) + y * (place.y - part.from.y())) / (length * length);
}

FrontFace face(const ScreenScene& scene, std::uint32_t triangle) {
    return {
        corners_of(scene, scene.triangles[triangle]),
        nearness_slope(plane_of(scene, scene.triangles[triangle]))};
}

/// How many parts of the line of these triangles are at that place of it.
int parts_at(
    const std::vector<HiddenIntersection>& parts,
    const std::array<std::uint32_t, 2>& triangles,
    Place place) {
    int found = 0;
    for (const HiddenIntersection& part : parts) {
        if (part.triangles != triangles)
            continue;
        double across = 0;
        const double along = distance_along(part, place, across);
        EXPECT_LE(across, 4); // its ends were moved to the grid
        found += along > 0 && along < 1 ? 1 : 0;
    }
    return found;
}

/// How many places were compared, on lines that are covered and that are not.
std::array<int, 2> compare_with_brute_force(const ScreenScene& scene, std::uint64_t seed) {
    const auto parts = hidden_intersections(scene, [](auto, auto) { return true; });
    std::mt19937_64 random(seed);
    std::array<int, 2> compared = {};
    for (std::uint32_t a = 0; a < scene.triangles.size(); ++a)
        for (std::uint32_t b = a + 1; b < scene.triangles.size(); ++b) {
            if (scene.triangles[a].source == scene.triangles[b].source
                || order_in_overlap(face(scene, a), face(scene, b)) != FrontOrder::penetrating)
                continue;
            const auto place = common_place(scene, a, b, random);
            const auto covered = place ? is_covered(scene, a, b, *place) : std::nullopt;
            if (!covered)
                continue;
            ++compared[*covered ? 1 : 0];
            EXPECT_EQ(parts_at(parts, {a, b}, *place), *covered ? 1 : 0)
                << "seed " << seed << " at " << place->x << ' ' << place->y;
        }
    for (const HiddenIntersection& part : parts) {
        const Place middle = {(part.from.x() + part.to.x()) / 2, (part.from.y() + part.to.y()) / 2};
        const auto covered = is_covered(scene, part.triangles[0], part.triangles[1], middle);
        EXPECT_TRUE(!covered || *covered) << "seed " << seed;
    }
    return compared;
}

TEST(HiddenIntersections, AreWhatIsCoveredOfThemByBruteForce) {
    std::array<int, 2> compared = {};
    for (std::uint64_t seed = 0; seed < 60 && !HasFailure(); ++seed) {
        const auto crossings = static_cast<std::int32_t>(seed % 3 == 0 ? 0 : 3 + seed % 7);
        const auto some =
            compare_with_brute_force(testing::tangle(seed, 20 + seed % 30, crossings), seed);
        compared = {compared[0] + some[0], compared[1] + some[1]};
    }
    EXPECT_GT(compared[0], 500);
    EXPECT_GT(compared[1], 500);
}

/// Two plates that cross on a line, and what stands before them.
ScreenScene crossing_plates(const std::vector<std::array<ScreenPoint, 3>>& covers) {
    constexpr std::int32_t unit = screen_size / 16;
    ScreenScene scene;
    const auto add = [&](const std::array<ScreenVertex, 3>& corners, std::uint32_t source) {
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        for (ScreenVertex corner : corners) {
            corner.point = {corner.point.x * unit, corner.point.y * unit};
            corner.nearness *= depth_size / 100;
            scene.vertices.push_back(corner);
        }
        add_triangle(scene, {first, first + 1, first + 2}, source);
    };
    add({{{{2, 2}, 10}, {{14, 2}, 30}, {{8, 14}, 20}}}, 0);
    add({{{{2, 2}, 30}, {{14, 2}, 10}, {{8, 14}, 20}}}, 1); // on x = 8
    for (std::uint32_t i = 0; i < covers.size(); ++i)
        add({{{covers[i][0], 60}, {covers[i][1], 60}, {covers[i][2], 60}}}, 2 + i);
    return scene;
}

TEST(HiddenIntersections, NeedACoverOnBothSides) {
    const auto parts = [](const std::vector<std::array<ScreenPoint, 3>>& covers) {
        return hidden_intersections(crossing_plates(covers), [](auto, auto) { return true; });
    };
    constexpr std::int32_t unit = screen_size / 16;
    EXPECT_TRUE(parts({}).empty());
    // A cover that has a side on the line, on either side, and both of them.
    const std::array<ScreenPoint, 3> left = {{{8, 4}, {8, 10}, {0, 8}}};
    const std::array<ScreenPoint, 3> right = {{{8, 2}, {16, 8}, {8, 8}}};
    EXPECT_TRUE(parts({left}).empty());
    EXPECT_TRUE(parts({right}).empty());
    const auto both = parts({left, right});
    ASSERT_EQ(both.size(), 1U);
    const auto [low, high] = std::minmax({both[0].from.whole.y, both[0].to.whole.y});
    EXPECT_EQ(low, 4 * unit);
    EXPECT_EQ(high, 8 * unit);
    EXPECT_EQ(both[0].from.whole.x, 8 * unit);
    EXPECT_EQ(both[0].triangles, (std::array<std::uint32_t, 2>{0, 1}));
    // Nothing that is not asked for.
    EXPECT_TRUE(hidden_intersections(crossing_plates({left, right}), [](auto, auto) {
                    return false;
                }).empty());
}

TEST(HiddenIntersections, AreTheSameForAnyNumberOfThreads) {
    const ScreenScene scene = testing::tangle(3, 400, 40);
    const auto found = [&](std::size_t threads) {
        const ThreadLimit limit(threads);
        return hidden_intersections(scene, [](auto, auto) { return true; });
    };
    const auto one = found(1);
    EXPECT_GT(one.size(), 100U);
    for (const std::size_t threads : {2U, 7U}) {
        const auto more = found(threads);
        ASSERT_EQ(more.size(), one.size());
        for (std::size_t i = 0; i < one.size(); ++i) {
            EXPECT_EQ(more[i].from, one[i].from);
            EXPECT_EQ(more[i].to, one[i].to);
            EXPECT_EQ(more[i].triangles, one[i].triangles);
        }
    }
}

} // namespace
} // namespace vera
