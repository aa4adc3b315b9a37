// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/brute_force.h"
#include "vera/visible/map_raster.h"
#include "vera/visible/penetrations.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

std::vector<ScreenScene> scenes() {
    std::vector<ScreenScene> result;
    for (std::uint64_t seed = 0; seed < 60; ++seed)
        result.push_back(testing::layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4)));
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        result.push_back(testing::scattered(seed, 200, screen_size >> seed));
        result.push_back(testing::terrain(seed, 4 << (seed % 3)));
    }
    result.emplace_back();
    return result;
}

VisibleMap map_of(const ScreenScene& scene) {
    return visible_map(scene, cell_raster(scene));
}

struct Point {
    double x = 0;
    double y = 0;
};

/// What of the polygon lies where inside(point), which is affine, is not negative.
template <typename Inside>
std::vector<Point> cut(const std::vector<Point>& polygon, const Inside& inside) {
    std::vector<Point> result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point a = polygon[i];
        const Point b = polygon[(i + 1) % polygon.size()];
        const double at_a = inside(a);
        const double at_b = inside(b);
        if (at_a >= 0)
            result.push_back(a);
        if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) {
            const double part = at_a / (at_a - at_b);
            result.push_back({a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)});
        }
    }
    return result;
}

struct Moments {
    double area = 0;
    double x = 0;
    double y = 0;
};

/// What each source has of a pixel, by cutting its rings at the pixel's sides.
std::map<std::uint32_t, Moments> cut_rings(
    const VisibleMap& map, std::size_t width, std::size_t height, std::size_t i, std::size_t j) {
    std::map<std::uint32_t, Moments> result;
    for (const VisibleMap::Ring& ring : map.rings) {
        std::vector<Point> polygon;
        for (const std::uint32_t vertex : map.vertices_of(ring))
            polygon.push_back(
                {map.vertices[vertex].x() * static_cast<double>(width) / screen_size
                     - static_cast<double>(i),
                 map.vertices[vertex].y() * static_cast<double>(height) / screen_size
                     - static_cast<double>(j)});
        polygon = cut(polygon, [](Point p) { return p.x; });
        polygon = cut(polygon, [](Point p) { return 1 - p.x; });
        polygon = cut(polygon, [](Point p) { return p.y; });
        polygon = cut(polygon, [](Point p) { return 1 - p.y; });
        Moments& moments = result[ring.source];
        for (std::size_t corner = 0; corner < polygon.size(); ++corner) {
            const Point a = polygon[corner];
            const Point b = polygon[(corner + 1) % polygon.size()];
            const double doubled = a.x * b.y - a.y * b.x;
            moments.area += doubled / 2;
            moments.x += doubled * (a.x + b.x) / 6;
            moments.y += doubled * (a.y + b.y) / 6;
        }
    }
    return result;
}

std::vector<PixelPart> all_areas(const MapRaster& raster) {
    std::vector<PixelPart> parts;
    for (std::size_t band = 0; band < raster.bands().count(); ++band)
        raster.add_areas(band, parts);
    return parts;
}

void expect_areas_of_rings(
    const VisibleMap& map, std::size_t width, std::size_t height, const std::string& what) {
    const std::vector<PixelPart> parts = all_areas(MapRaster(map, width, height));
    std::size_t next = 0;
    for (std::size_t j = 0; j < height; ++j)
        for (std::size_t i = 0; i < width; ++i) {
            auto expected = cut_rings(map, width, height, i, j);
            double sum = 0;
            const std::string pixel =
                what + " pixel " + std::to_string(i) + " " + std::to_string(j);
            for (; next < parts.size() && parts[next].x == i && parts[next].y == j; ++next) {
                const PixelPart& part = parts[next];
                sum += part.area;
                if (part.source == PixelPart::background)
                    continue;
                const Moments own = expected[part.source];
                expected.erase(part.source);
                ASSERT_NEAR(part.area, own.area, 1e-7) << pixel;
                if (own.area > 1e-3) {
                    ASSERT_NEAR(part.across, own.x / own.area, 1e-6) << pixel;
                    ASSERT_NEAR(part.down, own.y / own.area, 1e-6) << pixel;
                }
            }
            ASSERT_NEAR(sum, 1, 1e-12) << pixel;
            for (const auto& [source, left_out] : expected)
                ASSERT_LT(std::abs(left_out.area), 1e-7) << pixel;
        }
    ASSERT_EQ(next, parts.size());
}

TEST(MapRaster, GivesEachPixelTheAreasThatCuttingRingsGives) {
    constexpr std::size_t sizes[][2] = {{1, 1}, {2, 2}, {8, 16}, {7, 5}, {13, 20}};
    const std::vector<ScreenScene> all = scenes();
    for (std::size_t i = 0; i < all.size() && !HasFatalFailure(); ++i) {
        const auto& [width, height] = sizes[i % std::size(sizes)];
        expect_areas_of_rings(map_of(all[i]), width, height, "scene " + std::to_string(i));
    }
}

TEST(MapRaster, LosesNoAreaOfAnySource) {
    for (const ScreenScene& scene : scenes()) {
        const VisibleMap map = map_of(scene);
        std::map<std::uint32_t, double> expected;
        for (const VisibleMap::Ring& ring : map.rings)
            expected[ring.source] +=
                doubled_area(map, ring) / 2 / screen_size / screen_size * 31 * 17;
        for (const PixelPart& part : all_areas(MapRaster(map, 31, 17)))
            if (part.source != PixelPart::background)
                expected[part.source] -= part.area;
        for (const auto& [source, difference] : expected)
            EXPECT_NEAR(difference, 0, 1e-5) << source;
    }
}

TEST(MapRaster, ShowsInTheMiddleOfEachPixelWhatAskingEveryTriangleTells) {
    for (const ScreenScene& scene : scenes())
        for (const std::size_t size : {std::size_t{1}, std::size_t{4}, std::size_t{32}}) {
            const MapRaster raster(map_of(scene), size, size);
            std::vector<PixelPart> parts;
            for (std::size_t band = 0; band < raster.bands().count(); ++band)
                raster.add_centers(band, parts);
            ASSERT_EQ(parts.size(), size * size);
            for (std::size_t i = 0; i < parts.size(); ++i) {
                const PixelPart& part = parts[i];
                EXPECT_EQ(part.y * size + part.x, i);
                EXPECT_EQ(part.area, 1);
                const std::int64_t side = screen_size / static_cast<std::int64_t>(size);
                const SeenAt expected =
                    seen_at(scene, (2 * part.x + 1) * side, (2 * part.y + 1) * side);
                if (!expected.has_side_at) {
                    EXPECT_EQ(part.source, expected.source);
                }
            }
        }
}

} // namespace
} // namespace vera
