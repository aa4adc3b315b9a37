// SPDX-License-Identifier: Apache-2.0
// Pictures by simple ray tracing (VERA 3.2), against those by rays that look at every primitive.
#include "vera/accel/brute_force.h"
#include "vera/render/render_scene.h"
#include "vera/theory/central_index.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "accel/random_scene.h"
#include "render/test_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr std::uint32_t width = 61;
constexpr std::uint32_t height = 47;

Camera looking_down(Vec3 viewpoint, Vec3 at, double half_width) {
    const Vec3 forward = normalized(at - viewpoint);
    const Vec3 across = normalized(cross(forward, Vec3{0.1, 0, 1}));
    const Vec3 up = cross(across, forward);
    const double half_height = half_width * height / width;
    Camera camera;
    camera.viewpoint = viewpoint;
    camera.lower_left = viewpoint + forward - half_width * across - half_height * up;
    camera.lower_right = viewpoint + forward + half_width * across - half_height * up;
    camera.upper_left = viewpoint + forward - half_width * across + half_height * up;
    return camera;
}

struct Pictured {
    RenderResult central;
    RenderResult rays;
    std::size_t different = 0; ///< pixels
};

CentralIndex central_index(
    const Scene& scene, const PictureSettings& settings, LocatorKind kind = LocatorKind::slabs) {
    return {
        scene,
        std::make_unique<const Facets>(facets(scene, [](Vec3) { return 1e-3; })),
        {scene.camera->viewpoint, settings.shadows, kind}};
}

Pictured pictured(
    const Scene& scene, const PictureSettings& settings, LocatorKind kind = LocatorKind::slabs) {
    Pictured result;
    const CentralIndex index = central_index(scene, settings, kind);
    result.central = render_scene(scene, *scene.camera, index, settings, SampleType::float32);
    result.rays =
        render_scene(scene, *scene.camera, *make_brute_force(scene), settings, SampleType::float32);
    const auto& a = std::get<std::vector<float>>(result.central.image.samples);
    const auto& b = std::get<std::vector<float>>(result.rays.image.samples);
    for (std::size_t i = 0; i < a.size(); i += 3)
        if (a[i] != b[i] || a[i + 1] != b[i + 1] || a[i + 2] != b[i + 2])
            ++result.different;
    return result;
}

PictureSettings settings_of_tests() {
    PictureSettings settings = plain_settings(width, height);
    settings.ambient = {0.2, 0.2, 0.2};
    settings.firmament = Firmament{{0, 0.1, 0.9}, {0.5, 0.5, 0.7}, {0.2, 0.3, 0.1}};
    return settings;
}

/// A floor, and above it triangles that throw shadows on each other; two lights.
SceneMaker tables() {
    SceneMaker maker;
    maker.scene.camera = looking_down({2, -7, 5}, {0, 0, 0.5}, 0.6);
    maker.light({3, 2, 6}, 60, {1, 0.9, 0.8});
    maker.light({-4, -1, 5}, 40);
    maker.material(diffuse({0.7, 0.6, 0.5}));
    maker.polygon({{-6, -6, 0}, {6, -6, 0}, {6, 6, 0}, {-6, 6, 0}});
    for (int i = 0; i < 5; ++i) {
        const double z = 0.3 + 0.4 * i;
        const double x = -2 + i;
        maker.material(diffuse({0.2 + 0.15 * i, 0.9 - 0.15 * i, 0.5}));
        maker.polygon({{x, -1, z}, {x + 1.5, -0.5, z + 0.2}, {x + 0.7, 1.3, z + 0.3}});
    }
    return maker;
}

TEST(CentralIndex, GivesThePictureOfRaysWhereNoPixelsMiddleLiesOnABorder) {
    SceneMaker maker = tables();
    const Pictured picture = pictured(maker.finish(), settings_of_tests());
    EXPECT_EQ(picture.different, 0U);
    const RenderStatistics& counts = picture.central.statistics;
    EXPECT_EQ(counts.view_rays, std::uint64_t{width} * height);
    EXPECT_EQ(counts.shadow_rays, picture.rays.statistics.shadow_rays);
    EXPECT_EQ(counts.queries.rays, counts.view_rays + counts.shadow_rays);
    EXPECT_GT(counts.queries.cells, counts.queries.rays);
}

TEST(CentralIndex, IsAskedAsManyQueriesAPixelAsThereAreLightsAndOneMore) {
    // A floor that fills the picture, and lights above it.
    for (std::size_t lights = 0; lights < 4; ++lights) {
        SceneMaker maker;
        maker.scene.camera = looking_down({0, 0, 5}, {0.1, 0.1, 0}, 0.4);
        maker.material(diffuse({0.7, 0.6, 0.5}));
        maker.polygon({{-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0}});
        maker.polygon({{-1, -1, 1}, {0, -1, 1}, {0, 1, 2}});
        for (std::size_t light = 0; light < lights; ++light)
            maker.light({static_cast<double>(light), 3, 9}, 60);
        const Pictured picture = pictured(maker.finish(), settings_of_tests());
        EXPECT_EQ(picture.different, 0U);
        EXPECT_EQ(
            picture.central.statistics.queries.rays, (lights + 1) * std::uint64_t{width} * height);
    }
}

TEST(CentralIndex, GivesThePictureOfRaysWithAntialiasingAndExposure) {
    SceneMaker maker = tables();
    PictureSettings settings = settings_of_tests();
    settings.antialiasing.on = true;
    settings.exposure = 0.9;
    const Pictured picture = pictured(maker.finish(), settings);
    // One in some thousand rays passes a border within a step of the grid.
    EXPECT_LE(picture.different, 3U);
    EXPECT_GT(picture.central.statistics.extra_view_rays, 0U);
    EXPECT_EQ(picture.central.exposure->factor, picture.rays.exposure->factor);
}

TEST(CentralIndex, GivesThePictureOfRaysByEveryLocatorAndWithoutShadows) {
    SceneMaker maker = tables();
    const Scene& scene = maker.finish();
    for (const LocatorKind kind : {LocatorKind::hierarchy, LocatorKind::slabs, LocatorKind::grid})
        for (const bool shadows : {false, true}) {
            PictureSettings settings = settings_of_tests();
            settings.shadows = shadows;
            EXPECT_EQ(pictured(scene, settings, kind).different, 0U);
        }
}

TEST(CentralIndex, GivesTheSameBitsForAnyNumberOfThreads) {
    SceneMaker maker = tables();
    const Scene& scene = maker.finish();
    std::optional<Image> expected;
    for (const std::size_t threads : std::array<std::size_t, 3>{1, 2, 7}) {
        const ThreadLimit limit(threads);
        PictureSettings settings = settings_of_tests();
        settings.antialiasing.on = true;
        const CentralIndex index = central_index(scene, settings);
        const RenderResult result =
            render_scene(scene, *scene.camera, index, settings, SampleType::integer8);
        if (!expected)
            expected = result.image;
        EXPECT_TRUE(result.image.samples == expected->samples) << threads;
    }
}

TEST(CentralIndex, GivesThePictureOfRaysOfFacesThatPenetrateCoincideAndStandInALight) {
    SceneMaker maker;
    maker.scene.camera = looking_down({1, -8, 6}, {0, 0, 0.2}, 0.5);
    maker.light({1, 1, 3}, 30);
    maker.light({0.1, 0.2, 0}, 20); // in the floor's plane
    maker.material(diffuse({0.7, 0.6, 0.5}));
    maker.polygon({{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}});
    maker.material(diffuse({0.1, 0.6, 0.9}));
    maker.polygon({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}); // on the floor, which stands first
    maker.polygon({{-2, -0.5, -0.5}, {2, -0.7, 1.1}, {0.3, 1.5, 1.7}}); // through the floor
    maker.polygon({{-2, 1, 1.2}, {2, 0.5, -0.4}, {0.1, -1.2, 1}});      // through the other
    // Closed round the first light.
    maker.material(diffuse({0.9, 0.2, 0.1}));
    maker.polygon({{0.8, 0.8, 2.8}, {1.2, 0.8, 2.8}, {1, 1.2, 2.8}});
    maker.polygon({{0.8, 0.8, 2.8}, {1, 1, 3.3}, {1.2, 0.8, 2.8}});
    maker.polygon({{1.2, 0.8, 2.8}, {1, 1, 3.3}, {1, 1.2, 2.8}});
    const Pictured picture = pictured(maker.finish(), settings_of_tests());
    EXPECT_LE(picture.different, 1U);
}

TEST(CentralIndex, GivesThePictureOfRaysOfNothingAndOfOneFaceSeenEdgeOn) {
    SceneMaker nothing;
    nothing.scene.camera = looking_down({0, 0, 5}, {0, 0.1, 0}, 0.5);
    nothing.light({1, 1, 3}, 30);
    EXPECT_EQ(pictured(nothing.finish(), settings_of_tests()).different, 0U);
    SceneMaker edge_on;
    edge_on.scene.camera = looking_down({0, -5, 0}, {0, 0, 0.001}, 0.5);
    edge_on.light({1, 1, 3}, 30);
    edge_on.material(diffuse({1, 1, 1}));
    edge_on.polygon({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
    EXPECT_LE(pictured(edge_on.finish(), settings_of_tests()).different, 1U);
}

TEST(CentralIndex, DiffersFromRaysOfRandomScenesAtBordersAlone) {
    std::size_t different = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        testing::RandomSceneSettings random;
        random.items = 10 + 2 * seed;
        random.curved = false;
        Scene scene = testing::random_scene(seed, random);
        for (Material& material : scene.materials)
            material.drf = {0.4, 0.5, 0.6};
        scene.lights = {
            {{5.01, 6.02, 9.03}, 90, {1, 1, 0.8}, Falloff::inverse_square},
            {{0.11, -0.07, 0.29}, 9, {1, 1, 1}, Falloff::inverse_square}};
        scene.camera = looking_down({9.1, 4.2, 3.3}, {0.01, 0.02, 0.03}, 0.5);
        different += pictured(scene, settings_of_tests()).different;
    }
    EXPECT_LE(different, 8U); // of 28 670
}

TEST(CentralIndex, DiffersFromRaysAtSilhouettesOfCurvedThingsAndOfTheirShadowsAlone) {
    SceneMaker maker = tables();
    maker.material(diffuse({0.3, 0.5, 0.9}));
    maker.sphere({0.5, -1, 1}, 0.8);
    maker.sphere({-2, 0.5, 3}, 0.3);
    const Pictured picture = pictured(maker.finish(), settings_of_tests());
    EXPECT_LE(picture.different, 4U);
}

TEST(CentralIndex, StopsWhereItIsCancelled) {
    SceneMaker maker = tables();
    const Scene& scene = maker.finish();
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(
        CentralIndex(
            scene,
            std::make_unique<const Facets>(facets(scene, [](Vec3) { return 1; })),
            {scene.camera->viewpoint},
            {},
            &cancel),
        Cancelled);
}

} // namespace
} // namespace vera
