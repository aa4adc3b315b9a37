// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/near_border.h"
#include "vera/visible/region_paint.h"
#include "vera/visible/region_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include "visible/painted_color.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double tolerance = 1.0 / 255;

/// A triangle with corners of few values, among them ones without area, and now and then one more.
std::vector<BorderRing> random_rings(std::mt19937& random) {
    std::vector<BorderRing> rings(1 + random() % 2);
    for (BorderRing& ring : rings)
        for (int i = 0; i < 3; ++i) {
            BorderPoint point;
            point.x = 4.0 * static_cast<double>(random() % 4);
            point.y = 3.0 * static_cast<double>(random() % 4);
            ring.push_back(point);
        }
    return rings;
}

double distance_to_side(DrawingPoint point, DrawingPoint a, DrawingPoint b) {
    double least = 1e9;
    constexpr int steps = 2000;
    for (int i = 0; i <= steps; ++i) {
        const double part = static_cast<double>(i) / steps;
        least = std::min(
            least,
            std::hypot(a.x + part * (b.x - a.x) - point.x, a.y + part * (b.y - a.y) - point.y));
    }
    return least;
}

TEST(NearBorder, IncludesWhatIsNearerThanHalfAPixel) {
    std::mt19937 random(11);
    int inside = 0;
    for (int round = 0; round < 40; ++round) {
        const std::vector<BorderRing> rings = random_rings(random);
        const NearBorder border(rings);
        for (int i = 0; i < 25; ++i) {
            const double x = 0.25 * static_cast<double>(random() % 53) + 0.1;
            const double y = 0.25 * static_cast<double>(random() % 41) + 0.1;
            double least = 1e9;
            for (const BorderRing& ring : rings)
                for (std::size_t k = 0; k < ring.size(); ++k)
                    least = std::min(
                        least, distance_to_side({x, y}, ring[k], ring[(k + 1) % ring.size()]));
            if (std::abs(least - 0.5) < 0.01 || extent_of(rings).length() <= 1)
                continue;
            const Extent extent = extent_of(rings);
            if (x < extent.least.x || x > extent.most.x || y < extent.least.y || y > extent.most.y)
                continue;
            EXPECT_EQ(border.includes({x, y}), least < 0.5) << x << ' ' << y;
            inside += least < 0.5 ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 30);
}

TEST(NearBorder, IncludesAllOfWhatIsSmall) {
    const std::vector<BorderRing> rings = {{{0, 0}, {0.9, 0}, {0.9, 0.9}}};
    EXPECT_TRUE(NearBorder(rings).includes({0.5, 0.2}));
}

TEST(ScatteredPoints, AreOneForEachSquareAndInNoRowsOrColumns) {
    const std::vector<BorderRing> square = {{{0, 0}, {90, 0}, {90, 90}, {0, 90}}};
    const std::vector<DrawingPoint> points = scattered_points(square, 3, 0);
    EXPECT_NEAR(static_cast<double>(points.size()), 900, 60);
    // Every strip of a third of the spacing has some, along both axes.
    for (const auto axis : {&DrawingPoint::x, &DrawingPoint::y}) {
        std::vector<int> strips(90);
        for (const DrawingPoint& point : points)
            ++strips[static_cast<std::size_t>(point.*axis)];
        EXPECT_GT(*std::ranges::min_element(strips), 0);
    }
    const std::vector<DrawingPoint> others = scattered_points(square, 3, 1);
    EXPECT_NE(points.front().x, others.front().x);
    EXPECT_EQ(points, scattered_points(square, 3, 0));
}

TEST(ScatteredPoints, LieInside) {
    std::mt19937 random(12);
    std::size_t all = 0;
    for (int round = 0; round < 40; ++round) {
        const std::vector<BorderRing> rings = {random_rings(random).front()};
        FilledOutline outline;
        outline.rings.emplace_back(rings.front().begin(), rings.front().end());
        const auto points = scattered_points(rings, 1, static_cast<std::uint64_t>(round));
        all += points.size();
        for (const DrawingPoint& point : points)
            EXPECT_NE(testing::turns_about(testing::flattened_rings(outline), point), 0);
    }
    EXPECT_GT(all, 400U);
}

TEST(NearBorder, EnclosesWhatTheSidesGoRoundAnOddNumberOfTimes) {
    std::mt19937 random(14);
    int inside = 0;
    for (int round = 0; round < 40; ++round) {
        const std::vector<BorderRing> rings = random_rings(random);
        const NearBorder border(rings);
        for (int i = 0; i < 25; ++i) {
            // Neither in a row with a corner nor on a side.
            const double x = 0.25 * static_cast<double>(random() % 53) + 0.11;
            const double y = 0.25 * static_cast<double>(random() % 41) + 0.13;
            int turns = 0;
            for (const BorderRing& ring : rings) {
                FilledOutline outline;
                outline.rings.emplace_back(ring.begin(), ring.end());
                turns += testing::turns_about(testing::flattened_rings(outline), {x, y});
            }
            EXPECT_EQ(border.encloses({x, y}), turns % 2 != 0) << x << ' ' << y;
            inside += turns % 2 != 0 ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 100);
    EXPECT_FALSE(NearBorder({}).encloses({0, 0}));
    EXPECT_TRUE(NearBorder({{{0, 0}, {0.9, 0}, {0.9, 0.9}}}).encloses({0.5, 0.2}));
}

struct Off {
    int points = 0;
    int off = 0; ///< by more than the tolerance
    double most = 0;
};

/// How far off the paint of a square is.
void compare(const ColorField& field, double size, Off& result, double step = 0.7) {
    PaintedRegion region;
    region.rings = {{{0, 0}, {size, 0}, {size, size}, {0, size}}};
    const auto fills = painted(region, field, {});
    for (double y = 0.3; y < size; y += step)
        for (double x = 0.4; x < size; x += step) {
            const Color is = field({x, y});
            const Color shown = testing::painted_color(fills, {x, y}).value_or(Color{9, 9, 9});
            const double off = std::max(
                {std::abs(is.r - shown.r), std::abs(is.g - shown.g), std::abs(is.b - shown.b)});
            ++result.points;
            result.off += off > tolerance ? 1 : 0;
            result.most = std::max(result.most, off);
        }
}

TEST(RegionPaint, FindsSpotsThatAreSmallerThanTheDistanceOfSamples) {
    std::mt19937 random(13);
    Off off;
    for (int round = 0; round < 30; ++round) {
        const double x = 10 + 5 * static_cast<double>(random() % 9);
        const double y = 10 + 5 * static_cast<double>(random() % 9);
        const double radius = 3 + static_cast<double>(random() % 2);
        const ColorField field = [&](DrawingPoint at) {
            const double far = std::hypot(at.x - x, at.y - y) / radius;
            const double light = far < 1 ? (1 - far * far) * (1 - far * far) : 0;
            return Color{0.2 + 0.5 * light, 0.3, 0.3 + 0.001 * at.x};
        };
        compare(field, 60, off);
    }
    EXPECT_LT(off.off, off.points / 2000);
    EXPECT_LT(off.most, 8 * tolerance);
}

/// Between two checked places a paint may be off by little, in a small place: at a stop, or half
/// way between two of them.
TEST(RegionPaint, GoesToWhereItIsFarthestOff) {
    Off off;
    for (int i = 0; i < 6; ++i) {
        const double x = 4 + 3 * i;
        const double y = 20 - 2 * i;
        const ColorField field = [&](DrawingPoint at) {
            const double far = (at.x - x) * (at.x - x) + 2 * (at.y - y) * (at.y - y);
            const double wave = far / (70 + 15 * i + far);
            return Color{0.2 + 0.7 * wave, 0.9 - 0.6 * wave * wave, 0.3 + 0.004 * at.x};
        };
        compare(field, 30, off, 0.31);
    }
    EXPECT_LT(
        off.off, off.points / 2500); // three times as many where only the places are looked at
    EXPECT_LT(off.most, 1.5 * tolerance);
}

/// Where parts meet at sharp angles, what smooths edges leaves a trace to what is behind them.
TEST(RegionPaint, CoversWhatIsBehindARegionThatLiesOnNoUnderlay) {
    PaintedRegion region;
    region.rings = {{{0, 0}, {40, 0}, {40, 40}, {0, 40}}};
    region.below = {{{40, 0}, {41, 0}, {41, 40}, {40, 40}}};
    const ColorField field = [](DrawingPoint at) {
        return Color{0.5 + 0.4 * std::sin(0.2 * at.x), 0.5 + 0.4 * std::sin(0.15 * at.y), 0.5};
    };
    const auto on_underlay = painted(region, field, {});
    ASSERT_GT(on_underlay.size(), 3U);
    region.lies_on_underlay = false;
    const auto alone = painted(region, field, {});
    ASSERT_EQ(alone.size(), on_underlay.size() + 1);
    EXPECT_EQ(alone.front().rings.size(), 1U);
    EXPECT_EQ(testing::doubled_area(alone.front().rings), 3200);
    for (std::size_t i = 0; i < on_underlay.size(); ++i)
        EXPECT_EQ(alone[i + 1].rings, on_underlay[i].rings) << i;
    const ColorField plain = [](DrawingPoint) { return Color{0.5, 0.5, 0.5}; };
    EXPECT_EQ(painted(region, plain, {}).size(), 1U);
}

/// Near borders too colours are as they are, where they change slowly.
TEST(RegionPaint, IsWithinTheToleranceNearBorders) {
    PaintedRegion region;
    region.rings = {{{0, 0}, {30, 0}, {30, 30}, {0, 30}}};
    const ColorField field = [](DrawingPoint at) {
        return Color{0.2 + 0.009 * at.x + 0.0002 * at.y * at.y, 0.5, 0.4 + 0.006 * at.y};
    };
    const auto fills = painted(region, field, {});
    int off = 0;
    for (double x = 0.05; x < 30; x += 0.3)
        for (const double y : {0.02, 0.11, 0.31, 29.71, 29.93}) {
            const Color is = field({x, y});
            const Color shown = testing::painted_color(fills, {x, y}).value_or(Color{9, 9, 9});
            off +=
                std::max(
                    {std::abs(is.r - shown.r), std::abs(is.g - shown.g), std::abs(is.b - shown.b)})
                    > tolerance
                ? 1
                : 0;
        }
    EXPECT_EQ(off, 0);
}

/// A drawing rounds the corners of parts, which are not the same on both sides of a cut.
TEST(RegionPaint, LeavesNoGapBetweenPartsWhoseCornersAreRounded) {
    constexpr double size = 40;
    constexpr double precision = 0.1;
    PaintedRegion region;
    region.rings = {{{0, 0}, {size, 0}, {size, size}, {0, size}}};
    const ColorField field = [](DrawingPoint at) {
        const double far = std::hypot(at.x - 13.7, 1.3 * at.y - 21.2 + 0.3 * at.x);
        const double wave = far / (20 + far);
        return Color{0.1 + 0.8 * wave, 0.8 - 0.6 * wave * wave, 0.2 + 0.003 * at.y};
    };
    auto fills = painted(region, field, {});
    EXPECT_GT(fills.size(), 20U);
    for (FilledOutline& fill : fills)
        for (std::vector<DrawingPoint>& ring : fill.rings)
            for (DrawingPoint& point : ring)
                point = {
                    precision * std::round(point.x / precision),
                    precision * std::round(point.y / precision)};
    int places = 0;
    int gaps = 0;
    for (const FilledOutline& fill : fills)
        for (const std::vector<DrawingPoint>& ring : fill.rings)
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const DrawingPoint from = ring[i];
                const DrawingPoint to = ring[(i + 1) % ring.size()];
                for (const double part : {0.13, 0.31, 0.57, 0.83})
                    for (const double aside : {-0.04, -0.02, 0.02, 0.04}) {
                        const DrawingPoint at = {
                            from.x + part * (to.x - from.x) + aside,
                            from.y + part * (to.y - from.y) + 0.7 * aside};
                        if (std::min({at.x, at.y, size - at.x, size - at.y}) < precision)
                            continue;
                        ++places;
                        gaps += testing::painted_color(fills, at) ? 0 : 1;
                    }
            }
    EXPECT_GT(places, 2000);
    EXPECT_EQ(gaps, 0);
}

/// What smooths the edge of an area lets through what is below it there: that must be of a colour
/// that is seen nearby.
TEST(RegionPaint, LetsNoOtherColorsThroughWherePartsAreSmoothed) {
    constexpr double size = 12;
    PaintedRegion region;
    region.rings = {{{0, 0}, {size, 0}, {size, size}, {0, size}}};
    const auto beyond_jump = [](DrawingPoint at) {
        return at.x - 5.3 - 0.17 * at.y - 0.03 * at.y * at.y;
    };
    const ColorField field = [&](DrawingPoint at) {
        return beyond_jump(at) > 0 ? Color{0.7, 0.3 + 0.01 * at.y, 0.2} : Color{0.1, 0.1, 0.1};
    };
    const auto fills = painted(region, field, {});
    ASSERT_GT(fills.size(), 20U);
    const auto last_at = [&](DrawingPoint at) {
        std::size_t last = fills.size();
        while (last > 0 && !testing::painted_color(std::span(fills).subspan(last - 1, 1), at))
            --last;
        return last;
    };
    std::mt19937 random(15);
    const auto part = [&] { return static_cast<double>(random() % 4096) / 4096; };
    int edges = 0;
    int others = 0;
    for (int i = 0; i < 2000; ++i) {
        const double y = 2 + (size - 4) * part();
        const DrawingPoint at = {5.3 + 0.17 * y + 0.03 * y * y + 3 * part() - 1.5, y};
        const std::size_t last = last_at(at);
        ASSERT_GT(last, 0U);
        const auto below = testing::painted_color(std::span(fills).first(last - 1), at);
        bool is_edge = false;
        bool is_near = false; // in colour
        for (int k = 0; k < 8; ++k) {
            constexpr double near = 0.05;
            const double angle = 0.785 * k;
            const DrawingPoint beside = {
                at.x + near * std::cos(angle), at.y + near * std::sin(angle)};
            is_edge = is_edge || last_at(beside) < last;
            const auto shown = testing::painted_color(fills, beside);
            is_near = is_near || (below && std::abs(shown->r - below->r) < 0.2);
        }
        edges += is_edge && below ? 1 : 0;
        others += is_edge && below && !is_near ? 1 : 0;
    }
    EXPECT_GT(edges, 100);
    EXPECT_LE(others, edges / 15); // twice as many where strips reach all sides
}

TEST(RegionPaint, SeesBendsAlongRowsAndColumns) {
    Off off;
    for (const bool along_rows : {false, true})
        for (int i = 0; i < 12; ++i) {
            const ColorField field = [&](DrawingPoint at) {
                const double way = along_rows ? at.y : at.x;
                return clamped(Color{0.1 * (way - 17 - 0.31 * i), 0.02 * way, 0.5});
            };
            compare(field, 40, off);
        }
    EXPECT_LT(off.off, off.points / 1000);
    EXPECT_LT(off.most, 4 * tolerance);
}

} // namespace
} // namespace vera
