// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/render/render_parts.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "accel/random_scene.h"
#include "render/test_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

Camera camera_towards_the_origin(Camera::Projection projection) {
    Camera camera;
    camera.projection = projection;
    camera.viewpoint = {9, 4, 3};
    camera.direction = {-9, -4, -3};
    camera.lower_left = {3, -2, -1};
    camera.lower_right = {-3, 3, -2};
    camera.upper_left = {3, 0, 6};
    return camera;
}

/// The parts that rays through the middles of the pixels see.
std::vector<PixelPart> parts_by_rays(
    const Camera& camera,
    const RayIndex& index,
    const Facets& all,
    std::size_t width,
    std::size_t height) {
    std::map<std::uint64_t, std::uint32_t> first_facet;
    for (std::uint32_t i = 0; i < all.triangles.size(); ++i)
        first_facet.emplace(all.triangles[i].primitive, i);
    std::vector<PixelPart> parts;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            QueryRay query;
            query.ray = ViewRays(camera).ray(
                (x + 0.5) / static_cast<double>(width), (y + 0.5) / static_cast<double>(height));
            std::array<Hit, 1> hits;
            QueryCounts counts;
            index.nearest_hits(std::array{query}, hits, counts);
            PixelPart part = {x, y};
            if (hits[0].found())
                part.source = first_facet.at(hits[0].face.primitive);
            parts.push_back(part);
        }
    return parts;
}

PictureParts::OfBand by_bands(const std::vector<PixelPart>& all) {
    return [&all](std::size_t band, std::vector<PixelPart>& parts) {
        for (const PixelPart& part : all)
            if (part.y / PixelBands::rows == band)
                parts.push_back(part);
    };
}

TEST(RenderParts, GivesThePictureOfRaysToTheBitWhereTheSameIsSeen) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        testing::RandomSceneSettings random;
        random.items = 12;
        random.glass = seed % 2 == 0;
        Scene scene = testing::random_scene(seed, random);
        for (Material& material : scene.materials) {
            material.drf = {0.4, 0.5, 0.6};
            material.rab = {0.3, 0.2, 0.1};
        }
        scene.lights.push_back({{5, 6, 9}, 90, {1, 1, 0.8}, Falloff::inverse_square});
        PictureSettings settings = plain_settings(20, 17);
        settings.depth = 3;
        settings.firmament = Firmament{{0, 0.1, 0.9}, {0.5, 0.5, 0.7}, {0.2, 0.3, 0.1}};
        const Camera camera = camera_towards_the_origin(
            seed % 3 == 0 ? Camera::Projection::parallel : Camera::Projection::perspective);
        const auto index = make_brute_force(scene);
        const Facets all = facets(scene, [](Vec3) { return 0.01; });
        const auto parts = parts_by_rays(camera, *index, all, 20, 17);
        const RenderResult found = render_parts(
            scene, camera, *index, {all, by_bands(parts)}, settings, SampleType::float32);
        const RenderResult expected =
            render_scene(scene, camera, *index, settings, SampleType::float32);
        EXPECT_TRUE(found.image.samples == expected.image.samples) << "seed " << seed;
        EXPECT_EQ(found.statistics.parts, 20U * 17);
        EXPECT_EQ(found.statistics.view_rays, 0U);
        EXPECT_EQ(found.statistics.mirrored_rays, expected.statistics.mirrored_rays);
    }
}

TEST(RenderParts, AveragesLimitedColoursByAreaWithAntialiasingAlone) {
    SceneMaker maker;
    maker.look_down_in_parallel(1);
    maker.material(luminous({3, 0.5, 0}));
    maker.polygon({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
    const Scene& scene = maker.finish();
    const auto index = make_brute_force(scene);
    const Facets all = facets(scene, [](Vec3) { return 1; });
    PictureSettings settings = plain_settings(1, 1);
    settings.firmament = Firmament{{}, {}, {0, 0, 0.5}}; // seen below: all of it is earth
    const std::vector<PixelPart> whole = {{0, 0, 0}};
    const std::vector<PixelPart> halves = {
        {0, 0, 0, 0.25, 0.125, 0.5}, {0, 0, PixelPart::background, 0.75, 0.625, 0.5}};
    const auto sample = [&](const std::vector<PixelPart>& parts, std::size_t channel) {
        const RenderResult result = render_parts(
            scene, *scene.camera, *index, {all, by_bands(parts)}, settings, SampleType::integer16);
        return std::get<std::vector<std::uint16_t>>(result.image.samples)[channel];
    };
    EXPECT_EQ(sample(whole, 1), std::floor(0.5 * 65535 + 0.5));
    settings.antialiasing.on = true;
    EXPECT_EQ(sample(halves, 0), std::floor(0.25 * 65535 + 0.5));
    EXPECT_EQ(sample(halves, 1), std::floor(0.125 * 65535 + 0.5));
}

TEST(RenderParts, SoftenTheHorizonAsRaysDo) {
    SceneMaker maker;
    maker.sphere({0, 0, 100}, 1); // behind the viewer
    Camera camera;
    camera.lower_left = {-1, -0.5, -2};
    camera.lower_right = {1, -0.5, -2};
    camera.upper_left = {-1, 0.55, -2};
    maker.scene.camera = camera;
    const auto index = make_brute_force(maker.finish());
    PictureSettings settings = plain_settings(60, 31);
    const std::vector<PixelPart> parts = [] {
        std::vector<PixelPart> all;
        for (std::uint32_t i = 0; i < 60 * 31; ++i)
            all.push_back({i % 60, i / 60});
        return all;
    }();
    const auto red = [&](const RenderResult& result, std::size_t pixel) {
        return std::get<std::vector<std::uint16_t>>(result.image.samples)[3 * pixel] / 65535.0;
    };
    for (const auto& profile :
         {std::optional<HorizonProfile>(), std::optional(HorizonProfile(Mountains{5, 9, 0.3}))}) {
        settings.firmament = Firmament{{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, profile};
        settings.antialiasing.on = true;
        const RenderResult found = render_parts(
            maker.scene, camera, *index, {{}, by_bands(parts)}, settings, SampleType::integer16);
        const RenderResult rays =
            render_scene(maker.scene, camera, *index, settings, SampleType::integer16);
        std::size_t between = 0;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            // Where a fourth of the rays agree, rays end: less than an eighth of the pixel is
            // missed.
            ASSERT_NEAR(red(found, i), red(rays, i), 0.13) << i;
            between += red(found, i) > 0 && red(found, i) < 1 ? 1 : 0;
        }
        EXPECT_GE(between, 55U);
        settings.antialiasing.on = false;
        const RenderResult sharp = render_parts(
            maker.scene, camera, *index, {{}, by_bands(parts)}, settings, SampleType::integer16);
        for (std::size_t i = 0; i < parts.size(); ++i)
            ASSERT_TRUE(red(sharp, i) == 0 || red(sharp, i) == 1) << i;
    }
}

TEST(RenderParts, LightsAFacetThatSticksOutOfItsSurfaceAsTheSurfaceBesideIt) {
    // The ray through the middle of the pixel passes the sphere; its facet is said to be seen.
    SceneMaker maker;
    maker.look_down_in_parallel(1);
    maker.material(diffuse({1, 1, 1}));
    maker.light({0, 0, 100}, 1e4);
    maker.sphere({-1.0001, 0, 0}, 1);
    const Scene& scene = maker.finish();
    const auto index = make_brute_force(scene);
    Facets all;
    for (const Vec3 corner : {Vec3{0.1, -1, 0.05}, Vec3{0.1, 1, 0.05}, Vec3{-1, 0, 1}})
        all.corners.push_back(corner);
    all.triangles = {{{0, 1, 2}, 0, 0, MaterialId{0}}};
    const std::vector<PixelPart> parts = {{0, 0, 0}};
    PictureSettings settings = plain_settings(1, 1);
    const RenderResult result = render_parts(
        scene, *scene.camera, *index, {all, by_bands(parts)}, settings, SampleType::float32);
    const float red = std::get<std::vector<float>>(result.image.samples)[0];
    // The facet's place at the ray is (0, 0, 0.136): the normal there is that of the sphere.
    const double height = 0.05 + 0.95 * 0.1 / 1.1;
    const Vec3 normal = normalized(Vec3{1.0001, 0, height});
    const Vec3 place = Vec3{-1.0001, 0, 0} + normal;
    const Vec3 to_light = Vec3{0, 0, 100} - place;
    const double value = dot(normal, normalized(to_light)) * 1e4 / dot(to_light, to_light);
    EXPECT_NEAR(red, std::pow((value + 0.055) / 1.055, 2.4), 1e-6);
}

} // namespace
} // namespace vera
