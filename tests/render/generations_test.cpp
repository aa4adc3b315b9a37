// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/render/generations.h"

#include <cmath>
#include <string>
#include <vector>

#include "test_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double tolerance = 1e-12;

void expect_near(Color actual, Color expected) {
    EXPECT_NEAR(actual.r, expected.r, tolerance);
    EXPECT_NEAR(actual.g, expected.g, tolerance);
    EXPECT_NEAR(actual.b, expected.b, tolerance);
}

struct Traced {
    std::vector<Color> colors;
    RenderStatistics statistics;
};

Traced traced(SceneMaker& maker, const PictureSettings& settings, std::vector<Ray> rays) {
    const auto index = make_brute_force(maker.finish());
    const TracedScene scene = traced_scene(maker.scene, *index, settings);
    GenerationTracer tracer(scene);
    std::vector<QueryRay> queries(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        queries[i].ray = rays[i];
    Traced result;
    result.colors.resize(rays.size());
    tracer.trace(queries, result.colors);
    result.statistics = tracer.statistics;
    return result;
}

Color traced(SceneMaker& maker, const PictureSettings& settings, const Ray& ray) {
    return traced(maker, settings, std::vector<Ray>{ray}).colors[0];
}

PictureSettings settings_of_depth(std::uint32_t depth) {
    PictureSettings settings = plain_settings(1, 1);
    settings.depth = depth;
    return settings;
}

/// The square |x|, |z| <= 10 at that height, its normal up.
void add_floor(SceneMaker& maker, double height) {
    maker.polygon({{-10, height, -10}, {-10, height, 10}, {10, height, 10}, {10, height, -10}});
}

const Ray straight_down = {{0, 5, 0}, {0, -1, 0}};

TEST(Generations, ARayThatMeetsNothingSeesTheFirmament) {
    SceneMaker maker;
    PictureSettings settings = settings_of_depth(1);
    EXPECT_EQ(traced(maker, settings, straight_down), Color{});
    settings.firmament = Firmament{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(traced(maker, settings, straight_down), (Color{0, 1, 0}));
    EXPECT_EQ(traced(maker, settings, Ray{{}, {0, 1, 0}}), (Color{0, 0, 1}));
}

TEST(Generations, AMirrorShowsItsSurroundingsAtTheSecondLevel) {
    SceneMaker maker;
    maker.material(mirror({0.5, 0.25, 1}));
    add_floor(maker, 0);
    PictureSettings settings = settings_of_depth(1);
    settings.firmament = Firmament{{1, 1, 1}, {1, 1, 1}, {0, 0, 0}};
    EXPECT_EQ(traced(maker, settings, straight_down), Color{});
    settings.depth = 2;
    EXPECT_EQ(traced(maker, settings, straight_down), (Color{0.5, 0.25, 1}));
}

TEST(Generations, EachLevelOfTwoMirrorsDimsOnceMore) {
    SceneMaker maker;
    Material half = mirror({0.5, 0.5, 0.5});
    half.sdi = {1, 0, 0};
    maker.material(half);
    add_floor(maker, 0);
    add_floor(maker, 6);
    double expected = 0;
    for (std::uint32_t depth = 1; depth <= 40; ++depth) {
        expected += std::ldexp(1, 1 - static_cast<int>(depth));
        EXPECT_NEAR(traced(maker, settings_of_depth(depth), straight_down).r, expected, tolerance);
    }
}

TEST(Generations, GlassBendsByItsIndexAndBack) {
    // A slab of index 1.5 between heights 0 and 3, seen at the sine 0.6 inside at 0.4, above a
    // floor that is luminous on one side of where the ray arrives.
    SceneMaker maker;
    maker.material(glass({0.5, 0.5, 0.5}, 1.5));
    maker.polygon({{-10, 3, -10}, {-10, 3, 10}, {10, 3, 10}, {10, 3, -10}}, Outside::along_normal);
    maker.polygon(
        {{-10, 0, -10}, {-10, 0, 10}, {10, 0, 10}, {10, 0, -10}}, Outside::against_normal);
    const double inside_shift = 3 * 0.4 / std::sqrt(1 - 0.16);
    const double arrival = inside_shift + 0.75; // 1 lower, outside, at the slope 3/4
    maker.material(luminous({1, 0, 0}));
    maker.polygon({{-10, -1, -10}, {-10, -1, 10}, {arrival, -1, 10}, {arrival, -1, -10}});
    maker.material(luminous({0, 1, 0}));
    maker.polygon({{arrival, -1, -10}, {arrival, -1, 10}, {10, -1, 10}, {10, -1, -10}});

    for (const double offset : {-1e-9, 1e-9}) {
        const Ray ray = {{-0.75 + offset, 4, 0}, {0.6, -0.8, 0}};
        const Color expected = offset < 0 ? Color{0.25, 0, 0} : Color{0, 0.25, 0};
        expect_near(traced(maker, settings_of_depth(3), ray), expected);
        expect_near(traced(maker, settings_of_depth(2), ray), {});
    }
}

TEST(Generations, TotalReflectionMirrorsWithTab) {
    // From inside, index 2, at the cosine 0.6: the sine 0.8 would become 1.6.
    SceneMaker maker;
    Material inside = glass({0.5, 0.25, 0}, 2);
    maker.material(inside);
    add_floor(maker, 2);
    maker.material(luminous({1, 1, 1}));
    add_floor(maker, -2);
    const Ray ray = {{0, 0, 0}, {0.8, 0.6, 0}};
    expect_near(traced(maker, settings_of_depth(2), ray), {0.5, 0.25, 0});

    // With RAB beside TAB the ray counts for both, and is traced once.
    maker.scene.materials[0].rab = {0.25, 0.25, 1};
    const Traced both = traced(maker, settings_of_depth(2), std::vector<Ray>{ray});
    expect_near(both.colors[0], {0.75, 0.5, 1});
    EXPECT_EQ(both.statistics.mirrored_rays, 1U);
    EXPECT_EQ(both.statistics.refracted_rays, 0U);
}

TEST(Generations, AGlassSphereIsSeenThroughTwice) {
    SceneMaker maker;
    maker.material(glass({0.5, 0.5, 0.5}, 1.5));
    maker.sphere({0, 0, 0}, 1);
    maker.material(luminous({1, 1, 1}));
    add_floor(maker, -3);
    expect_near(traced(maker, settings_of_depth(2), straight_down), {});
    expect_near(traced(maker, settings_of_depth(3), straight_down), {0.25, 0.25, 0.25});
}

TEST(Generations, AnOpaqueThingCastsAShadowAndGlassDimsAtEachSurface) {
    SceneMaker maker;
    maker.material(diffuse({1, 1, 1}));
    add_floor(maker, 0);
    maker.light({0, 10, 0}, 100);
    const Ray aslant = {{3, 4, 0}, {-0.6, -0.8, 0}}; // meets the floor below the light
    PictureSettings settings = settings_of_depth(1);
    expect_near(traced(maker, settings, aslant), {1, 1, 1});

    maker.material(glass({0.5, 0.25, 1}, 1.5));
    maker.sphere({0, 6, 0}, 1);
    expect_near(traced(maker, settings, aslant), {0.25, 0.0625, 1});

    maker.material(diffuse({1, 1, 1}));
    maker.sphere({0, 8, 0}, 0.5);
    expect_near(traced(maker, settings, aslant), {});
    settings.shadows = false;
    expect_near(traced(maker, settings, aslant), {1, 1, 1});
}

TEST(Generations, WhatLiesBehindTheLightOrHoldsItCastsNoShadow) {
    SceneMaker maker;
    maker.material(diffuse({1, 1, 1}));
    add_floor(maker, 0);
    add_floor(maker, 10);
    maker.sphere({0, 12, 0}, 1);
    maker.light({0, 10, 0}, 100);
    const Ray aslant = {{3, 4, 0}, {-0.6, -0.8, 0}};
    expect_near(traced(maker, settings_of_depth(1), aslant), {1, 1, 1});
}

TEST(Generations, RaysFromACurvedSurfaceDoNotMeetItAtTheirStart) {
    // Convex and diffuse: what faces the light is lit, from grazing rays to head-on ones.
    SceneMaker maker;
    maker.material(diffuse({1, 1, 1}));
    maker.sphere({1000, 2000, -3000}, 7);
    maker.light({1000, 2000 + 70, -3000}, 63 * 63);
    std::vector<Ray> rays;
    for (int i = 1; i < 200; ++i) {
        const double across = 7 * i / 200.0;
        rays.push_back({{1000 + across, 2050, -3000}, {0, -1, 0}});
    }
    const Traced result = traced(maker, settings_of_depth(1), rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3 point = {
            rays[i].origin.x - 1000,
            std::sqrt(49 - (rays[i].origin.x - 1000) * (rays[i].origin.x - 1000)),
            0};
        const Vec3 to_light = Vec3{0, 70, 0} - point;
        const double cosine = dot(to_light, point) / 7 / length(to_light);
        const double expected = cosine > 0 ? cosine * 63 * 63 / dot(to_light, to_light) : 0;
        ASSERT_NEAR(result.colors[i].r, expected, 1e-9) << "ray " << i;
    }
}

TEST(Generations, ARayThatAPatchsNormalSendsBelowThePatchGoesOnThere) {
    SceneMaker maker;
    maker.material(mirror({1, 1, 1}));
    const Vec3 leaning = normalized({1, 0.5, 0});
    maker.patch({Vec3{-10, 0, -10}, {-10, 0, 10}, {10, 0, 0}}, {leaning, leaning, leaning});
    maker.material(luminous({0, 1, 0}));
    add_floor(maker, -1);
    EXPECT_EQ(traced(maker, settings_of_depth(2), straight_down), (Color{0, 1, 0}));
}

TEST(Generations, AColourDependsOnNothingButItsRay) {
    // More rays than are worked on at a time, every one of which doubles at each level.
    SceneMaker maker;
    Material crystal = glass({0.5, 0.5, 0.25}, 1.25);
    crystal.rab = {0.25, 0.5, 0.5};
    crystal.drf = {0.1, 0.2, 0.3};
    maker.material(crystal);
    for (int i = 0; i < 5; ++i)
        maker.sphere({0, -2.5 * i, 0.25 * i}, 1);
    maker.light({3, 5, 4}, 30);
    PictureSettings settings = settings_of_depth(6);
    settings.firmament = Firmament{{0, 0, 1}, {1, 1, 1}, {0.5, 0.25, 0}};

    std::vector<Ray> rays;
    for (int i = 0; i < 2100; ++i)
        rays.push_back({{(i % 70) / 40.0 - 0.9, 5, (i / 70) / 17.0 - 0.9}, {0, -1, 0}});
    const Traced together = traced(maker, settings, rays);
    for (std::size_t i = 0; i < rays.size(); i += 97)
        ASSERT_EQ(together.colors[i], traced(maker, settings, rays[i])) << "ray " << i;
}

TEST(Generations, WhatRaysMeetIsToldBesideTheirColoursAndIsTheSame) {
    SceneMaker maker;
    maker.material(mirror({0.5, 0.25, 1}));
    maker.sphere({0, 1, 0}, 1);
    maker.material(glass({0.5, 0.5, 0.25}, 1.25));
    add_floor(maker, 0);
    maker.light({3, 5, 4}, 30);
    PictureSettings settings = settings_of_depth(3);
    settings.firmament = Firmament{{0, 0, 1}, {1, 1, 1}, {0.5, 0.25, 0}};
    const auto index = make_brute_force(maker.finish());
    const TracedScene scene = traced_scene(maker.scene, *index, settings);
    GenerationTracer tracer(scene);
    // Some pass the floor by, and there are more of them than are worked on at a time.
    std::vector<QueryRay> rays(600);
    for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i].ray = {
            {static_cast<double>(i % 30) - 12, 5, 0.5}, {0, -0.6, i % 7 < 3 ? 0.8 : -0.8}};

    SurfacePoint untouched;
    untouched.point = {1, 2, 3};
    std::vector<Hit> hits(rays.size());
    std::vector<Hit> expected_hits(rays.size());
    std::vector<SurfacePoint> at(rays.size(), untouched);
    std::vector<SurfacePoint> expected_at(rays.size(), untouched);
    std::vector<Color> colors(rays.size());
    std::vector<Color> expected_colors(rays.size());
    tracer.trace(rays, hits, at, colors);
    tracer.nearest(rays, expected_hits);
    tracer.surfaces(rays, expected_hits, expected_at);
    tracer.shade(rays, expected_hits, expected_at, expected_colors);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE("ray " + std::to_string(i));
        found += expected_hits[i].found() ? 1 : 0;
        EXPECT_EQ(hits[i], expected_hits[i]);
        EXPECT_EQ(at[i].point, expected_at[i].point);
        EXPECT_EQ(at[i].point_error, expected_at[i].point_error);
        EXPECT_EQ(at[i].geometric_normal, expected_at[i].geometric_normal);
        EXPECT_EQ(at[i].shading_normal, expected_at[i].shading_normal);
        EXPECT_EQ(at[i].material, expected_at[i].material);
        EXPECT_EQ(at[i].face, expected_at[i].face);
        EXPECT_EQ(colors[i], expected_colors[i]);
    }
    EXPECT_GT(found, 0U);
    EXPECT_LT(found, rays.size());
    tracer.trace(rays, colors);
    EXPECT_EQ(colors, expected_colors);
}

TEST(Generations, ARaisedFlagStopsThem) {
    SceneMaker maker;
    maker.sphere({0, 0, 0}, 1);
    const auto index = make_brute_force(maker.finish());
    CancelFlag cancel;
    const TracedScene scene = traced_scene(maker.scene, *index, settings_of_depth(1), &cancel);
    GenerationTracer tracer(scene);
    const std::vector<QueryRay> rays(1, {straight_down, {}});
    std::vector<Color> colors(1);
    EXPECT_NO_THROW(tracer.trace(rays, colors));
    cancel.raise();
    EXPECT_THROW(tracer.trace(rays, colors), Cancelled);
}

} // namespace
} // namespace vera
