// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/accel/grid_tree.h"
#include "vera/base/available_memory.h"
#include "vera/render/generations.h"
#include "vera/render/render_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/memory_is_watched.h"
#include "reference/reference_renderer.h"
#include "test_scenes.h"
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace vera {
namespace {

/// A bit of everything: glass, mirrors, highlights, patches, a thin wire, two lights, a firmament.
/// Lengths are multiplied by scale, intensities by its square.
struct Room : SceneMaker {
    explicit Room(double scale = 1) {
        const auto at = [&](double x, double y, double z) { return scale * Vec3{x, y, z}; };
        Material shiny = diffuse({0.4, 0.3, 0.2});
        shiny.spc = 0.8;
        shiny.rab = {0.3, 0.3, 0.3};
        material(shiny);
        polygon({at(-9, 0, -9), at(-9, 0, 9), at(9, 0, 9), at(9, 0, -9)});
        material(glass({0.8, 0.9, 0.7}, 1.5));
        sphere(at(-1, 1.5, 0), 1.25 * scale);
        material(mirror({0.9, 0.8, 0.7}));
        sphere(at(2, 1, -2), scale);
        Material dull = diffuse({0.7, 0.2, 0.2});
        dull.arf = {0.1, 0.3, 0.1};
        dull.san = {0.1, 0, 0};
        material(dull);
        const Vec3 leaning = normalized({0.3, 0.1, 1});
        patch({at(-4, 0, -4), at(4, 0, -4), at(0, 5, -4)}, {Vec3{-0.3, 0, 1}, leaning, {0, 1, 1}});
        material(luminous({0.2, 0.9, 0.4}));
        const double thin = 0.004;
        polygon({at(-3, 3, 2), at(3, 1, 2), at(3, 1 + thin, 2), at(-3, 3 + thin, 2)});
        light(at(3, 6, 5), 30 * scale * scale);
        light(at(-5, 4, 1), 10 * scale * scale, {1, 0.5, 0.25});

        Camera camera;
        camera.viewpoint = at(0, 2, 9);
        camera.lower_left = at(-2, 0.25, 5);
        camera.lower_right = at(2, 0.25, 5);
        camera.upper_left = at(-2, 3.25, 5);
        scene.camera = camera;
        finish();
    }

    static PictureSettings settings() {
        PictureSettings settings;
        settings.width = 100;
        settings.height = 75;
        settings.depth = 5;
        settings.ambient = {0.2, 0.2, 0.25};
        settings.firmament = Firmament{{0.2, 0.3, 0.8}, {0.7, 0.7, 0.9}, {0.3, 0.2, 0.1}};
        return settings;
    }

    RenderResult rendered(const PictureSettings& settings, const RayIndex& index) const {
        return render_scene(scene, *scene.camera, index, settings, SampleType::integer8);
    }

    RenderResult rendered(const PictureSettings& settings) const {
        return rendered(settings, *make_brute_force(scene));
    }
};

std::vector<std::uint8_t> bytes(const RenderResult& result) {
    return std::get<std::vector<std::uint8_t>>(result.image.samples);
}

/// The most memory that the process has had in use, in bytes.
std::size_t peak_memory() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::vector<PictureSettings> settings_with_and_without_antialiasing() {
    PictureSettings with = Room::settings();
    with.antialiasing.samples = 4;
    PictureSettings in_parts = with;
    in_parts.antialiasing.samples = 16; // of which some only ask what is there
    PictureSettings without = with;
    without.antialiasing.on = false;
    return {with, in_parts, without};
}

TEST(RenderScene, GivesTheSameBytesAndCountsForAnyNumberOfThreads) {
    const Room room;
    for (const PictureSettings& settings : settings_with_and_without_antialiasing()) {
        std::optional<RenderResult> first;
        for (const std::size_t threads : {1U, 2U, 7U}) {
            const ThreadLimit limit(threads);
            const RenderResult result = room.rendered(settings);
            if (!first)
                first = result;
            EXPECT_EQ(bytes(result), bytes(*first)) << threads << " threads";
            EXPECT_EQ(result.statistics.view_rays, first->statistics.view_rays);
            EXPECT_EQ(result.statistics.extra_view_rays, first->statistics.extra_view_rays);
            EXPECT_EQ(result.statistics.probe_rays, first->statistics.probe_rays);
            EXPECT_EQ(result.statistics.refined_pixels, first->statistics.refined_pixels);
            EXPECT_EQ(result.statistics.shadow_rays, first->statistics.shadow_rays);
            EXPECT_EQ(result.statistics.mirrored_rays, first->statistics.mirrored_rays);
            EXPECT_EQ(result.statistics.refracted_rays, first->statistics.refracted_rays);
            EXPECT_EQ(result.statistics.queries.tests, first->statistics.queries.tests);
        }
    }
}

TEST(RenderScene, GivesTheSameBytesForEveryIndex) {
    const Room room;
    const auto brute_force = make_brute_force(room.scene);
    const auto grids = make_grid_tree(room.scene);
    for (const PictureSettings& settings : settings_with_and_without_antialiasing())
        EXPECT_EQ(
            bytes(room.rendered(settings, *brute_force)), bytes(room.rendered(settings, *grids)));
}

TEST(RenderScene, GivesTheSameBytesInUnitsOfAPowerOfTwo) {
    for (const PictureSettings& settings : settings_with_and_without_antialiasing()) {
        const auto expected = bytes(Room().rendered(settings));
        EXPECT_EQ(bytes(Room(0x1p20).rendered(settings)), expected);
        EXPECT_EQ(bytes(Room(0x1p-20).rendered(settings)), expected);
    }
}

TEST(RenderScene, GivesNearlyTheSameBytesInUnitsOfAPowerOfTen) {
    PictureSettings settings = Room::settings();
    settings.antialiasing.on = false;
    const auto expected = bytes(Room().rendered(settings));
    for (const double scale : {1e6, 1e-6}) {
        const auto actual = bytes(Room(scale).rendered(settings));
        std::size_t different = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            different += std::abs(expected[i] - actual[i]) > 1;
        EXPECT_LE(different, expected.size() / 1000) << "scale " << scale;
    }
}

TEST(RenderScene, AgreesWithTheReferenceRenderer) {
    const Room room;
    PictureSettings settings = Room::settings();
    settings.antialiasing.on = false;
    for (const bool shadows : {true, false}) {
        settings.shadows = shadows;
        const auto expected = reference::reference_picture(room.scene, settings).bytes;
        const auto actual = bytes(room.rendered(settings));
        ASSERT_EQ(actual.size(), expected.size());
        std::size_t different = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            different += std::abs(expected[i] - actual[i]) > 1;
        EXPECT_LE(different, expected.size() / 1000);
    }
}

TEST(RenderScene, NeedsLittleMemoryBesideThePicture) {
    if (memory_is_watched())
        GTEST_SKIP() << "a sanitizer takes more memory than the renderer";
    SceneMaker maker;
    maker.material(luminous({1, 1, 1}));
    maker.sphere({0, 0, -2}, 0.5);
    maker.look_down_in_parallel(1);
    const auto index = make_brute_force(maker.finish());
    PictureSettings settings = plain_settings(1024, 1024);
    for (const bool antialiasing : {false, true}) {
        settings.antialiasing.on = antialiasing;
        const std::size_t before = peak_memory();
        render_scene(maker.scene, *maker.scene.camera, *index, settings, SampleType::integer8);
        // What is kept of each pixel would show: there are a million.
        const std::size_t picture = std::size_t{4} << 20;
        EXPECT_LT(peak_memory() - before, picture + (std::size_t{40} << 20));
    }
}

TEST(RenderScene, GivesTheSameBitsForGenerationsOfAnySize) {
    const Room room;
    const auto index = make_brute_force(room.scene);
    for (const PictureSettings& settings : settings_with_and_without_antialiasing()) {
        const auto expected = bytes(room.rendered(settings));
        const auto in_generations = [&](std::size_t size) {
            return bytes(render_scene(
                room.scene,
                *room.scene.camera,
                *index,
                settings,
                SampleType::integer8,
                {},
                nullptr,
                size));
        };
        for (const std::size_t size : {1U, 37U, 2000U})
            EXPECT_EQ(in_generations(size), expected) << size;
        for (const std::size_t threads : {1U, 2U, 3U, 8U}) {
            const ThreadLimit limit(threads);
            EXPECT_EQ(in_generations(whole_generations), expected) << threads << " threads";
        }
    }
}

/// Of rays all over the picture, in one generation, what each sees and what that is made of.
std::vector<Color> colors_and_terms(const Room& room, const RayIndex& index) {
    const PictureSettings settings = Room::settings();
    TracedScene traced = traced_scene(room.scene, index, settings);
    traced.generation_size = whole_generations;
    const ViewRays view(*room.scene.camera);
    std::vector<QueryRay> rays;
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 80; ++x) {
            QueryRay query;
            query.ray = view.ray(x / 80.0, y / 60.0);
            rays.push_back(query);
        }
    GenerationTracer tracer(traced);
    std::vector<Hit> hits(rays.size());
    std::vector<SurfacePoint> at(rays.size());
    std::vector<Color> colors(rays.size());
    std::vector<Color> terms(rays.size() * light_way_count * tracer.terms().count());
    tracer.nearest(rays, hits);
    tracer.surfaces(rays, hits, at);
    tracer.shade(rays, hits, at, colors, terms);
    colors.insert(colors.end(), terms.begin(), terms.end());
    return colors;
}

TEST(RenderScene, SharesALongGenerationAmongThreadsToTheBit) {
    const Room room;
    const auto index = make_grid_tree(room.scene);
    std::optional<std::vector<Color>> first;
    for (const std::size_t threads : {1U, 2U, 3U, 8U}) {
        const ThreadLimit limit(threads);
        const std::vector<Color> colors = colors_and_terms(room, *index);
        if (!first)
            first = colors;
        EXPECT_TRUE(colors == *first) << threads;
    }
}

TEST(RenderScene, RefusesWholeGenerationsBeforeMemoryRunsOut) {
    const Room room;
    const auto index = make_brute_force(room.scene);
    PictureSettings settings = Room::settings();
    settings.width = settings.height = 2000;
    const MemoryLimit little(1);
    try {
        render_scene(
            room.scene,
            *room.scene.camera,
            *index,
            settings,
            SampleType::integer8,
            {},
            nullptr,
            whole_generations);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_EQ(
            std::string(error.what()).find("a generation of 4000000 view rays takes about "), 0U)
            << error.what();
    }
}

TEST(RenderScene, CountsARayAPixelWithoutAntialiasing) {
    PictureSettings settings = Room::settings();
    settings.antialiasing.on = false;
    settings.depth = 1;
    const RenderStatistics statistics = Room().rendered(settings).statistics;
    EXPECT_EQ(statistics.view_rays, 7500U);
    EXPECT_EQ(statistics.extra_view_rays, 0U);
    EXPECT_EQ(statistics.probe_rays, 0U);
    EXPECT_EQ(statistics.mirrored_rays, 0U);
    EXPECT_EQ(statistics.queries.rays, statistics.view_rays + statistics.shadow_rays);
    EXPECT_FALSE(Room().rendered(settings).exposure);
}

TEST(RenderScene, CountsTheExtraRaysOfAntialiasing) {
    const RenderStatistics statistics = Room().rendered(Room::settings()).statistics;
    EXPECT_EQ(statistics.view_rays - statistics.extra_view_rays, 7500U);
    EXPECT_GT(statistics.refined_pixels, 400U);
    EXPECT_LT(statistics.refined_pixels, 5000U);
    EXPECT_EQ(
        statistics.queries.rays,
        statistics.view_rays + statistics.probe_rays + statistics.shadow_rays
            + statistics.mirrored_rays + statistics.refracted_rays);
}

TEST(RenderScene, ScalesTheLightToTheExposureAskedFor) {
    const Room room;
    PictureSettings settings = Room::settings();
    settings.antialiasing.on = false;
    settings.exposure = 0;
    EXPECT_EQ(bytes(room.rendered(settings)), [&] {
        PictureSettings unmeasured = settings;
        unmeasured.exposure.reset();
        return bytes(room.rendered(unmeasured));
    }());

    settings.exposure = 0.95;
    const RenderResult scaled = room.rendered(settings);
    ASSERT_TRUE(scaled.exposure);
    EXPECT_TRUE(scaled.exposure->reachable);
    EXPECT_NE(scaled.exposure->factor, 1);

    Room brighter;
    for (PointLight& light : brighter.scene.lights)
        light.intensity *= scaled.exposure->factor;
    settings.ambient = scaled.exposure->factor * settings.ambient;
    settings.exposure.reset();
    EXPECT_EQ(bytes(brighter.rendered(settings)), bytes(scaled));
}

TEST(RenderScene, ReportsProgressThatNeverFallsAndEndsAtOne) {
    const Room room;
    const auto index = make_brute_force(room.scene);
    for (const PictureSettings& settings : settings_with_and_without_antialiasing()) {
        std::vector<double> reports;
        render_scene(
            room.scene,
            *room.scene.camera,
            *index,
            settings,
            SampleType::integer8,
            [&](double done) { reports.push_back(done); });
        ASSERT_GE(reports.size(), 3U);
        EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
        EXPECT_GT(reports.front(), 0);
        EXPECT_EQ(reports.back(), 1);
    }
}

TEST(RenderScene, StopsSoonAfterItIsCancelled) {
    const Room room;
    const auto index = make_brute_force(room.scene);
    PictureSettings settings = Room::settings();
    settings.width = settings.height = 4096; // would take many seconds
    for (const bool antialiasing : {false, true}) {
        settings.antialiasing.on = antialiasing;
        CancelFlag cancel;
        double done_at_most = 0;
        EXPECT_THROW(
            render_scene(
                room.scene,
                *room.scene.camera,
                *index,
                settings,
                SampleType::integer8,
                [&](double done) {
                    done_at_most = done;
                    cancel.raise();
                },
                &cancel),
            Cancelled);
        EXPECT_LT(done_at_most, 0.01);
    }
}

} // namespace
} // namespace vera
