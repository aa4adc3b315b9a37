// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/math/elementary.h"
#include "vera/render/render_scene.h"

#include <algorithm>
#include <cmath>

#include "test_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// The picture is width x height units from (0, 0) on, x to the right, y down, one unit a pixel.
void look_at_pixels(SceneMaker& maker, std::uint32_t width, std::uint32_t height) {
    Camera camera;
    camera.projection = Camera::Projection::parallel;
    camera.direction = {0, 0, 1};
    camera.lower_left = {0, static_cast<double>(height), 0};
    camera.lower_right = {static_cast<double>(width), static_cast<double>(height), 0};
    camera.upper_left = {0, 0, 0};
    maker.scene.camera = camera;
}

RenderResult antialiased(SceneMaker& maker, std::uint32_t width, std::uint32_t height) {
    look_at_pixels(maker, width, height);
    const auto index = make_brute_force(maker.finish());
    PictureSettings settings;
    settings.width = width;
    settings.height = height;
    return render_scene(maker.scene, *maker.scene.camera, *index, settings, SampleType::integer16);
}

/// The red of a pixel, from 0 to 1.
double red(const Image& image, std::size_t x, std::size_t y) {
    return std::get<std::vector<std::uint16_t>>(image.samples)[3 * (y * image.width + x)] / 65535.0;
}

double sum_of_reds(const Image& image) {
    double sum = 0;
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = 0; x < image.width; ++x)
            sum += red(image, x, y);
    return sum;
}

/// A straight strip from the middle of one of its short sides to that of the other.
struct Wire {
    Vec3 start;
    Vec3 end;
    double width = 0.1;
};

void add_wire(SceneMaker& maker, const Wire& wire) {
    const Vec3 along = normalized(wire.end - wire.start);
    const Vec3 aside = 0.5 * wire.width * Vec3{-along.y, along.x, 0};
    maker.polygon({wire.start - aside, wire.end - aside, wire.end + aside, wire.start + aside});
}

/// The longest run of columns (rows, for a steep wire) in which the wire is not to be seen.
int longest_gap(const Image& image, const Wire& wire) {
    const Vec3 step = wire.end - wire.start;
    const bool is_steep = std::abs(step.y) > std::abs(step.x);
    const double from = is_steep ? wire.start.y : wire.start.x;
    const double to = is_steep ? wire.end.y : wire.end.x;
    int gap = 0;
    int longest = 0;
    for (double i = std::floor(std::min(from, to)) + 2; i < std::max(from, to) - 2; ++i) {
        const Vec3 point = wire.start + (i + 0.5 - from) / (to - from) * step;
        double seen = 0;
        for (const double offset : {-1, 0, 1})
            seen += is_steep
                ? red(
                    image, static_cast<std::size_t>(point.x + offset), static_cast<std::size_t>(i))
                : red(
                    image, static_cast<std::size_t>(i), static_cast<std::size_t>(point.y + offset));
        gap = seen > 0 ? 0 : gap + 1;
        longest = std::max(longest, gap);
    }
    return longest;
}

void expect_wire_is_drawn(const Vec3& start, const Vec3& end) {
    SceneMaker maker;
    maker.material(luminous({1, 1, 1}));
    const Wire wire = {start, end};
    add_wire(maker, wire);
    const auto width = static_cast<std::uint32_t>(std::max(start.x, end.x) + 8);
    const auto height = static_cast<std::uint32_t>(std::max(start.y, end.y) + 8);
    const RenderResult result = antialiased(maker, width, height);
    const double area = length(end - start) * wire.width;
    EXPECT_NEAR(sum_of_reds(result.image), area, 0.1 * area);
    EXPECT_LE(longest_gap(result.image, wire), 2);
}

TEST(Antialiasing, FollowsAWireOfATenthOfAPixelAtEveryAngle) {
    for (int i = 0; i < 32; ++i) {
        SCOPED_TRACE(i);
        const double angle = 180.0 / 32 * i;
        const Vec3 along = 400.0 * Vec3{cos_degrees(angle), sin_degrees(angle), 0};
        const Vec3 start = {along.x < 0 ? 8.3 - along.x : 8.3, 8.6, 0};
        expect_wire_is_drawn(start, start + along);
    }
}

TEST(Antialiasing, FollowsAWireThatPassesBetweenPixelCentres) {
    for (const double place : {8.0, 8.06, 8.25, 8.5, 8.75, 8.94}) {
        SCOPED_TRACE(place);
        expect_wire_is_drawn({8, place, 0}, {408, place, 0});
        expect_wire_is_drawn({place, 8, 0}, {place, 408, 0});
    }
}

TEST(Antialiasing, FollowsAWireThroughCornersOfPixels) {
    for (const double off : {0.0, 1e-9, 0.02, 0.05})
        for (const double rise : {1.0, 0.5, -1.0}) {
            SCOPED_TRACE(testing::Message() << off << " beside corners, rising by " << rise);
            const Vec3 start = {8, (rise < 0 ? 308 : 8) + off, 0};
            expect_wire_is_drawn(start, start + 300.0 * Vec3{1, rise, 0});
        }
}

TEST(Antialiasing, CoversPixelsByTheirPart) {
    SceneMaker maker;
    maker.material(luminous({1, 1, 1}));
    maker.polygon({{10.25, 10.5, 0}, {20.5, 10.5, 0}, {20.5, 30.75, 0}, {10.25, 30.75, 0}});
    const RenderResult result = antialiased(maker, 40, 40);
    EXPECT_EQ(red(result.image, 15, 20), 1);
    EXPECT_EQ(red(result.image, 5, 20), 0);
    EXPECT_NEAR(red(result.image, 10, 20), 0.75, 1e-4);
    EXPECT_NEAR(red(result.image, 20, 20), 0.5, 1e-4);
    EXPECT_NEAR(red(result.image, 15, 10), 0.5, 1e-4);
    EXPECT_NEAR(red(result.image, 15, 30), 0.75, 1e-4);
}

TEST(Antialiasing, ColoursASurfaceThatNoneOfTheFirstRaysMeets) {
    // A sixteenth of a pixel is met by 2 of 32 rays; 4 have colours, and with luck one of these.
    SceneMaker maker;
    maker.material(luminous({1, 1, 1}));
    for (std::size_t row = 0; row < 16; ++row) {
        const double left = 10 + static_cast<double>(row) / 16;
        const double top = static_cast<double>(row);
        maker.polygon(
            {{left, top, 0},
             {left + 0.0625, top, 0},
             {left + 0.0625, top + 1, 0},
             {left, top + 1, 0}});
    }
    const RenderResult result = antialiased(maker, 20, 16);
    for (std::size_t row = 0; row < 16; ++row)
        EXPECT_NEAR(red(result.image, 10, row), 0.0625, 1e-4) << row;
}

TEST(Antialiasing, ClampsSamplesBeforeItAveragesThem) {
    SceneMaker maker;
    maker.material(luminous({1000, 1000, 1000}));
    maker.polygon({{10.5, 0, 0}, {20, 0, 0}, {20, 20, 0}, {10.5, 20, 0}});
    EXPECT_NEAR(red(antialiased(maker, 20, 20).image, 10, 10), 0.5, 1e-4);
}

TEST(Antialiasing, CostsLittleWhereNothingChanges) {
    SceneMaker maker;
    maker.material(luminous({0.5, 0.5, 0.5}));
    maker.polygon({{-99, -99, 1}, {999, -99, 1}, {999, 999, 1}, {-99, 999, 1}});
    const RenderResult result = antialiased(maker, 128, 128);
    EXPECT_EQ(result.statistics.refined_pixels, 0U);
    const auto rays =
        static_cast<double>(result.statistics.view_rays + result.statistics.probe_rays);
    EXPECT_LT(rays / (128 * 128), 2.2) << "with one pixel of seam round each tile";
}

TEST(Antialiasing, DoesNotRefineInsideAPlaneMeshNorWhereColoursChangeEvenly) {
    SceneMaker maker;
    Material material = diffuse({0.8, 0.6, 0.4});
    material.drf = {1, 1, 1};
    maker.material(material);
    for (int i = -1; i < 14; ++i)
        for (int j = -1; j < 14; ++j) {
            const double x = 10 * i;
            const double y = 10 * j;
            maker.polygon({{x, y, 9}, {x, y + 10, 9}, {x + 10, y + 10, 9}, {x + 10, y, 9}});
        }
    maker.light({30, 30, -40}, 2000); // changes by more than the tolerance a pixel in places
    const RenderResult result = antialiased(maker, 128, 128);
    EXPECT_EQ(result.statistics.refined_pixels, 0U);
}

TEST(Antialiasing, RefinesAShadowsEdge) {
    SceneMaker maker;
    maker.material(diffuse({1, 1, 1}));
    maker.polygon({{-99, -99, 9}, {-99, 999, 9}, {999, 999, 9}, {999, -99, 9}});
    maker.polygon({{100, -99, -9}, {100, 999, -9}, {200, 999, -9}, {200, -99, -9}});
    maker.light({91, 32, -1e6}, 1e12);
    const RenderResult result = antialiased(maker, 64, 64);
    EXPECT_EQ(result.statistics.refined_pixels, 0U) << "the shadow falls outside";
    maker.scene.lights[0].position.x =
        1e6 + 64; // at 45 degrees; the shadow's edge at x = 82 - 0.25
    maker.scene.lights[0].position.z = -1e6 * 18.0 / 68.25;
    const RenderResult shadowed = antialiased(maker, 64, 64);
    EXPECT_EQ(shadowed.statistics.refined_pixels, 128U);
}

TEST(Antialiasing, ColoursMoreRaysWhereColoursOfOneSurfaceDiffer) {
    SceneMaker maker;
    maker.material(diffuse({1, 1, 1}));
    maker.polygon({{-99, -99, 9}, {-99, 999, 9}, {999, 999, 9}, {999, -99, 9}});
    maker.polygon({{100, -99, -9}, {100, 999, -9}, {200, 999, -9}, {200, -99, -9}});
    maker.light({1e6 + 100, 32, -9 - 18e6 / 79.6875}, 4e12); // the shadow begins at x = 20.3125
    const RenderResult result = antialiased(maker, 64, 64);
    EXPECT_EQ(result.statistics.refined_pixels, 128U);
    // All rays meet one surface, which tells nothing. Twice as many as there are samples have a
    // colour in the pixels that the shadow's edge crosses, and 4 beside it.
    EXPECT_EQ(result.statistics.view_rays, 4U * 34 * 34 + 64 * (32 + 4));
    for (std::size_t y = 0; y < 64; ++y)
        EXPECT_NEAR(red(result.image, 20, y) / red(result.image, 10, y), 0.3125, 1e-3) << y;
}

/// A view to the north of a degree and a half a pixel or so, over a profile before a white sky.
RenderResult seen_profile(const HorizonProfile& profile) {
    SceneMaker maker;
    maker.sphere({0, 0, 100}, 1); // behind the viewer
    Camera camera;
    camera.lower_left = {-1, -0.5, -2};
    camera.lower_right = {1, -0.5, -2};
    camera.upper_left = {-1, 0.5, -2};
    maker.scene.camera = camera;
    const auto index = make_brute_force(maker.finish());
    PictureSettings settings;
    settings.width = 64;
    settings.height = 32;
    settings.firmament = Firmament{{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, profile};
    return render_scene(maker.scene, camera, *index, settings, SampleType::integer16);
}

TEST(Antialiasing, CoversPixelsByTheirPartOfTheSkyAboveAProfile) {
    // From (0, 16) up to (32, 8) and down again to (64, 16) in pixels: lines are straight.
    const double side = std::atan(0.5) * 180 / 3.14159265358979;
    const double peak = std::atan(0.125) * 180 / 3.14159265358979;
    const HorizonProfile profile({{-side, 0}, {0, peak}, {side, 0}, {120, 0}, {240, 0}});
    const RenderResult result = seen_profile(profile);
    EXPECT_NEAR(sum_of_reds(result.image), 64 * 16 - 64 * 8 / 2, 1);
    for (std::size_t x = 2; x < 30; ++x) {
        double column = 0;
        for (std::size_t y = 0; y < 32; ++y)
            column += red(result.image, x, y);
        ASSERT_NEAR(column, 16 - (static_cast<double>(x) + 0.5) / 4, 0.15) << x;
    }
    EXPECT_GT(result.statistics.refined_pixels, 60U);
}

TEST(Antialiasing, FollowsAPeakOfATenthOfAPixel) {
    const double pixel = std::atan(1 / 64.0) * 180 / 3.14159265358979; // in the middle
    std::vector<ProfilePoint> points = {{60, -40}, {150, -40}, {250, -40}};
    points.push_back({360 - 0.3 * pixel - 0.01, -40});
    points.push_back({360 - 0.3 * pixel, 10});
    points.push_back({360 - 0.2 * pixel, 10});
    points.push_back({360 - 0.2 * pixel + 0.01, -40});
    const RenderResult result = seen_profile(HorizonProfile(points));
    // It is narrowest in azimuth, and so of a tenth of a pixel everywhere.
    for (std::size_t y = 8; y < 30; ++y) {
        double row = 0;
        for (std::size_t x = 0; x < 64; ++x)
            row += 1 - red(result.image, x, y);
        ASSERT_GT(row, 0) << y;
    }
}

TEST(Antialiasing, UsesAsManyRaysAsAreAskedFor) {
    SceneMaker maker;
    maker.material(luminous({1, 1, 1}));
    maker.polygon({{10.5, -9, 0}, {99, -9, 0}, {99, 99, 0}, {10.5, 99, 0}});
    look_at_pixels(maker, 32, 32);
    const auto index = make_brute_force(maker.finish());
    PictureSettings settings;
    settings.width = 32;
    settings.height = 32;
    settings.depth = 1;
    for (const std::uint32_t samples : {2U, 4U, 8U, 16U, 256U}) {
        settings.antialiasing.samples = samples;
        const RenderStatistics statistics =
            render_scene(maker.scene, *maker.scene.camera, *index, settings, SampleType::integer8)
                .statistics;
        EXPECT_EQ(statistics.refined_pixels, 64U) << "a column on each side";
        // A quarter gets a colour, as each of the two surfaces has but one. The edge runs through
        // the pixels of one column, in which two samples are not enough to know that.
        const std::uint32_t agreeing = std::min(samples, std::max(samples / 4, 4U));
        EXPECT_EQ(statistics.view_rays, 34U * 34 + 32 * std::max(agreeing, 4U) + 32 * agreeing)
            << "with the seam around the tile";
        // The pixels that are not refined are probed once, and of the seam's outer frame the
        // centres within two pixels of the edge's, six above and six below.
        const std::uint32_t asked = samples - std::min(samples, std::max(agreeing, 4U));
        EXPECT_EQ(statistics.probe_rays, 30U * 32 + 2 * 6 + 64 * asked);
        EXPECT_EQ(statistics.extra_view_rays, statistics.view_rays - 32 * 32);
    }
}

} // namespace
} // namespace vera
