// SPDX-License-Identifier: Apache-2.0
#include "vera/depth_buffer/depth_buffer.h"
#include "vera/visible/penetrations.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

std::vector<DepthTriangle> triangles_of(const ScreenScene& scene) {
    std::vector<DepthTriangle> triangles;
    for (const ScreenTriangle& triangle : scene.triangles)
        triangles.push_back({corners_of(scene, triangle), triangle.source});
    return triangles;
}

/// All samples of the picture, row by row.
std::vector<std::uint32_t> seen(const DepthBuffer& buffer) {
    std::vector<std::uint32_t> all;
    std::vector<std::uint32_t> of_band;
    for (std::size_t band = 0; band < buffer.bands().count(); ++band) {
        buffer.see(band, of_band);
        all.insert(all.end(), of_band.begin(), of_band.end());
    }
    return all;
}

/// Asks every triangle, in whole numbers: sample (i, j) of columns x rows.
std::uint32_t seen_by_all(
    const std::vector<DepthTriangle>& triangles,
    std::int64_t columns,
    std::int64_t rows,
    std::int64_t i,
    std::int64_t j) {
    // In units of which a step of the grid has 2 columns across and 2 rows down.
    const std::int64_t x = (2 * i + 1) * screen_size;
    const std::int64_t y = (2 * j + 1) * screen_size;
    std::uint32_t best_source = PixelPart::background;
    Int128 best = 0;
    Int128 best_area = 1;
    for (const DepthTriangle& triangle : triangles) {
        bool is_inside = true;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const ScreenPoint from = triangle.corners[corner].point;
            const ScreenStep side = step(from, triangle.corners[(corner + 1) % 3].point);
            is_inside = is_inside
                && Int128{side.x * 2 * columns} * (y - 2 * rows * from.y)
                        - Int128{side.y * 2 * rows} * (x - 2 * columns * from.x)
                    >= 0;
        }
        if (!is_inside)
            continue;
        const DepthPlane plane = depth_plane(triangle.corners);
        const Int128 nearness = Int128{plane.area} * plane.nearness * (4 * columns * rows)
            + Int128{plane.along_x} * (2 * rows) * (x - 2 * columns * plane.at.x)
            + Int128{plane.along_y} * (2 * columns) * (y - 2 * rows * plane.at.y);
        const int ahead = best_source == PixelPart::background
            ? 1
            : sign_of_difference(nearness, best_area, best, plane.area);
        if (ahead > 0 || (ahead == 0 && triangle.source < best_source)) {
            best_source = triangle.source;
            best = nearness;
            best_area = plane.area;
        }
    }
    return best_source;
}

void expect_like_asking_all(
    const ScreenScene& scene, std::size_t width, std::size_t height, const std::string& what) {
    const std::vector<DepthTriangle> triangles = triangles_of(scene);
    const std::vector<std::uint32_t> found = seen(DepthBuffer(triangles, {width, height}));
    ASSERT_EQ(found.size(), width * height);
    for (std::size_t j = 0; j < height; ++j)
        for (std::size_t i = 0; i < width; ++i)
            ASSERT_EQ(
                found[j * width + i],
                seen_by_all(
                    triangles,
                    static_cast<std::int64_t>(width),
                    static_cast<std::int64_t>(height),
                    static_cast<std::int64_t>(i),
                    static_cast<std::int64_t>(j)))
                << what << " at " << i << " " << j;
}

TEST(DepthBuffer, SeesLikeAskingAllWhatLiesInLayersOnFewPoints) {
    // On the coarser ones, middles of pixels are corners of triangles and lie on their sides.
    constexpr std::size_t sizes[][2] = {{1, 1}, {2, 4}, {8, 8}, {7, 5}, {12, 20}, {3, 16}};
    for (std::uint64_t seed = 0; seed < 240 && !HasFatalFailure(); ++seed) {
        const auto& [width, height] = sizes[seed % std::size(sizes)];
        expect_like_asking_all(
            testing::layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4)),
            width,
            height,
            "seed " + std::to_string(seed));
    }
}

TEST(DepthBuffer, SeesLikeAskingAllWhatIsScatteredAndATerrain) {
    for (std::uint64_t seed = 0; seed < 6 && !HasFatalFailure(); ++seed) {
        expect_like_asking_all(
            testing::scattered(seed, 300, screen_size >> (seed % 6)), 37, 29, "scattered");
        expect_like_asking_all(testing::terrain(seed, 4 << (seed % 3)), 32, 27, "terrain");
    }
}

/// Two rectangles of the whole picture that cross in the middle.
ScreenScene crossing_rectangles() {
    ScreenScene scene;
    scene.vertices = {
        {{0, 0}, 1000000},
        {{screen_size, 0}, 3000000},
        {{screen_size, screen_size}, 3000000},
        {{0, screen_size}, 1000000},
        {{0, 0}, 3000000},
        {{screen_size, 0}, 1000000},
        {{screen_size, screen_size}, 1000000},
        {{0, screen_size}, 3000000}};
    add_triangle(scene, {0, 1, 2}, 7);
    add_triangle(scene, {0, 2, 3}, 7);
    add_triangle(scene, {4, 5, 6}, 5);
    add_triangle(scene, {4, 6, 7}, 5);
    return scene;
}

TEST(DepthBuffer, ComparesSampleBySampleWhatPassesThroughAnother) {
    const auto found = seen(DepthBuffer(triangles_of(crossing_rectangles()), {9, 3}));
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 9; ++column)
            // In the middle both are equally near: the smaller number is in front.
            EXPECT_EQ(found[row * 9 + column], column < 5 ? 5U : 7U) << row << " " << column;
}

TEST(DepthBuffer, PutsTheFirstInFrontOfWhatTheGridMadePassThroughIt) {
    // One plane, but the second has corners of its own, moved by a step of depth.
    ScreenScene scene;
    scene.vertices = {
        {{0, 0}, 1000},
        {{screen_size, 0}, 1000},
        {{0, screen_size}, 1000},
        {{1000, 1000}, 1001},
        {{3000000, 1000}, 999},
        {{1000, 700000}, 1001}};
    add_triangle(scene, {3, 4, 5}, 9);
    add_triangle(scene, {0, 1, 2}, 4);
    for (const std::uint32_t source : seen(DepthBuffer(triangles_of(scene), {8, 8})))
        EXPECT_NE(source, 9U);
    scene.triangles[0].source = 3;
    const auto found = seen(DepthBuffer(triangles_of(scene), {8, 8}));
    EXPECT_EQ(std::count(found.begin(), found.end(), 3U), 4);
}

TEST(DepthBuffer, TellsAreasByTheSamples) {
    const DepthBuffer buffer(triangles_of(crossing_rectangles()), {3, 9, 4, 2});
    for (std::size_t band = 0; band < 2; ++band) {
        std::vector<PixelPart> parts;
        buffer.add_parts(band, parts);
        ASSERT_EQ(parts.size(), band == 0 ? 32U : 4U);
        for (std::size_t i = 0; i < parts.size(); i += 4) {
            const PixelPart* const pixel = &parts[i];
            EXPECT_EQ(pixel[0].source, 5U);
            EXPECT_EQ(pixel[0].area, 1);
            EXPECT_EQ(pixel[0].across, 0.5);
            EXPECT_EQ(pixel[0].down, 0.5);
            for (std::size_t part = 1; part < 3; ++part) {
                EXPECT_EQ(pixel[part].x, 1U);
                EXPECT_EQ(pixel[part].y, i / 4 + 8 * band);
                EXPECT_EQ(pixel[part].source, part == 1 ? 5U : 7U);
                EXPECT_EQ(pixel[part].area, 0.5);
                EXPECT_EQ(pixel[part].across, part == 1 ? 0.25 : 0.75);
                EXPECT_EQ(pixel[part].down, 0.5);
            }
            EXPECT_EQ(pixel[3].source, 7U);
        }
    }
}

TEST(DepthBuffer, SeesNothingWhereNothingIs) {
    EXPECT_EQ(
        seen(DepthBuffer({}, {2, 1})),
        (std::vector<std::uint32_t>{PixelPart::background, PixelPart::background}));
}

} // namespace
} // namespace vera
