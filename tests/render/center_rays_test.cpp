// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/simd_level.h"
#include "vera/render/center_rays.h"

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// Perspective and parallel, of usual sizes and of such that squares of lengths overflow or vanish.
std::vector<Camera> cameras() {
    std::vector<Camera> cameras;
    for (const auto projection : {Camera::Projection::perspective, Camera::Projection::parallel})
        for (const double scale : {1.0, 3e-150, 1e-140, 1e140, 7e150}) {
            Camera camera;
            camera.projection = projection;
            camera.direction = {0, 0, -1};
            camera.lower_left = scale * Vec3{-1, -0.75, -2};
            camera.lower_right = scale * Vec3{1, -0.75, -2};
            camera.upper_left = scale * Vec3{-1, 0.75, -2};
            cameras.push_back(camera);
        }
    // A picture through the view point: in its middle, rays have no length.
    Camera flat;
    flat.lower_left = {-1, -1, 0};
    flat.lower_right = {1, -1, 0};
    flat.upper_left = {-1, 1, 0};
    cameras.push_back(flat);
    return cameras;
}

std::uint64_t bits(double number) {
    return std::bit_cast<std::uint64_t>(number);
}

void expect_those_of_the_raster(
    const Raster& raster, const Tile& tile, CenterRays& centers, std::size_t frame_width) {
    std::vector<QueryRay> rays;
    centers.find(raster, tile, rays, frame_width);
    const Tile framed = {0, 0, tile.width + 2 * frame_width, tile.height + 2 * frame_width};
    ASSERT_EQ(rays.size(), framed.width * framed.height);
    auto found = rays.begin();
    for_each_pixel(framed, [&](std::size_t x, std::size_t y) {
        const auto place = [&](std::size_t first, std::size_t i) {
            return static_cast<double>(first + i) - static_cast<double>(frame_width);
        };
        const QueryRay expected = raster.ray(place(tile.x, x), place(tile.y, y));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(bits(found->ray.origin[axis]), bits(expected.ray.origin[axis]));
            EXPECT_EQ(bits(found->ray.direction[axis]), bits(expected.ray.direction[axis]));
        }
        EXPECT_EQ(bits(found->ray.t_min), bits(expected.ray.t_min));
        ++found;
    });
}

TEST(CenterRays, AreThoseOfTheRasterToTheBitWithEveryInstructionSet) {
    for (const std::string& level : simd_levels()) {
        ASSERT_TRUE(limit_simd(level));
        CenterRays centers;
        for (const Camera& camera : cameras()) {
            const Raster raster = {ViewRays(camera), 37, 20};
            for (std::size_t width = 1; width <= 10; ++width) {
                SCOPED_TRACE(level + ", width " + std::to_string(width));
                expect_those_of_the_raster(
                    raster, {3 * width, width, width, 11 - width}, centers, 0);
                expect_those_of_the_raster(raster, {0, width, width, 11 - width}, centers, 2);
            }
            expect_those_of_the_raster(raster, {0, 0, 32, 20}, centers, 0);
            expect_those_of_the_raster(raster, {0, 0, 37, 20}, centers, 1);
        }
    }
    EXPECT_TRUE(limit_simd(""));
}

} // namespace
} // namespace vera
