// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/screen_point.h"
#include "vera/visible/light_frames.h"
#include "vera/visible/projection.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

bool shows(const LightFrame& frame, Vec3 from_light) {
    const ImagePoint p = CameraMap(frame.camera).image_point(from_light);
    return p.w > 0 && p.w <= 1.001 * frame.farthest && p.x >= 0 && p.x <= p.w && p.y >= 0
        && p.y <= p.w;
}

/// Of the frame's grid at the place, in the scene's units.
double step_at(const LightFrame& frame, Vec3 from_light) {
    return CameraMap(frame.camera).size_of_pixel(screen_size, screen_size, from_light);
}

struct Seen {
    Box3 box;
    std::vector<SeenSegment> segments;
};

/// A triangle with these corners, on which a pixel is as large as the distance to the viewer, over
/// 1000.
void add_triangle(Seen& seen, const std::array<Vec3, 3>& corners, Vec3 viewer) {
    const auto pixel = [&](Vec3 at) { return std::max(1e-9, (at.z - viewer.z) / 1000); };
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 from = corners[i];
        const Vec3 to = corners[(i + 1) % 3];
        seen.segments.push_back({{from, to}, {pixel(from), pixel(to)}});
        seen.box = grown(seen.box, from);
    }
}

std::vector<LightFrame> frames_of(Vec3 light, const Seen& seen) {
    return light_frames(
               std::array{light},
               seen.box,
               [&](const auto& visit) {
                   for (const SeenSegment& segment : seen.segments)
                       visit(segment);
               })
        .front();
}

/// Whether every place is in a frame, and where no frame is too coarse in one that is fine there.
void expect_fine_frames(Vec3 light, const std::array<Vec3, 3>& corners, bool is_fine) {
    const Vec3 viewer = {0, 1, -1};
    Seen seen;
    add_triangle(seen, corners, viewer);
    const std::vector<LightFrame> frames = frames_of(light, seen);
    double coarse = 0;
    for (const LightFrame& frame : frames)
        coarse = std::max(coarse, frame.coarse_step);
    EXPECT_EQ(coarse == 0, is_fine) << coarse;
    std::mt19937_64 random(frames.size());
    for (int i = 0; i < 200; ++i) {
        // As many near the first corner as far away.
        const double a = std::pow(10.0, -std::uniform_real_distribution(0.0, 7.0)(random));
        const double b = std::uniform_real_distribution(0.0, 1.0)(random);
        const Vec3 at = corners[0] + a * (1 - b) * (corners[1] - corners[0])
            + a * b * (corners[2] - corners[0]);
        const double pixel = std::max(1e-9, (at.z - viewer.z) / 1000);
        bool is_shown = false;
        bool is_fine_there = false;
        for (const LightFrame& frame : frames)
            if (shows(frame, at - light)) {
                is_shown = true;
                is_fine_there = is_fine_there || step_at(frame, at - light) <= 1.01 * pixel / 64;
            }
        EXPECT_TRUE(is_shown) << at.x << " " << at.y << " " << at.z;
        EXPECT_TRUE(is_fine_there || !is_fine) << at.x << " " << at.y << " " << at.z;
    }
}

TEST(LightFrames, AreOneWhereNothingNeedsMore) {
    Seen seen;
    add_triangle(seen, {Vec3{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {0, 1, -1});
    EXPECT_EQ(frames_of({0, 5, 0}, seen).size(), 1U);
    // Downward and to four sides.
    EXPECT_EQ(frames_of({0.2, 0.3, 0.2}, seen).size(), 5U);
}

TEST(LightFrames, AreFineWhereThingsAreNearTheViewer) {
    for (const double far : {10.0, 1e3, 1e5, 1e6})
        for (const Vec3 light :
             {Vec3{0, 2 * far, 0.1 * far}, {far, 0.3 * far, -far}, {1, 2, 3}, {0, 1e8, 1e8}})
            expect_fine_frames(light, {Vec3{0, 0, 0}, {-far, 0, far}, {far, 0, far}}, true);
}

TEST(LightFrames, TellWhereNoneIsFineEnough) {
    // Pixels of 1e-9 along the whole of a triangle a million units long: as many frames as there
    // are.
    Seen seen;
    add_triangle(seen, {Vec3{-1e6, 0, -5}, {1e6, 0, -5}, {0, 1e6, -5}}, {0, 0, 0});
    const auto frames = frames_of({0, 0, -1e6}, seen);
    EXPECT_LE(frames.size(), 6U * 32);
    EXPECT_GT(frames.back().coarse_step, 0);
}

} // namespace
} // namespace vera
