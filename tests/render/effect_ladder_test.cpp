// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/render/effect_ladder.h"
#include "vera/render/render_scene.h"

#include <set>
#include <string>

#include "render/test_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// A mirroring ball with a highlight and a glass one, in the light of two sources.
Scene two_balls() {
    SceneMaker maker;
    Material silver;
    silver.drf = {0.4, 0.2, 0.1};
    silver.rab = {0.5, 0.5, 0.5};
    silver.spc = 0.9;
    maker.material(silver);
    maker.sphere({-1, 0, 0}, 1);
    Material glass;
    glass.tab = {0.9, 0.9, 0.9};
    glass.ref = 1.5;
    maker.material(glass);
    maker.sphere({1, 0, 0}, 1);
    maker.light({0, 5, 5}, 20);
    maker.light({5, 0, 5}, 20);
    maker.look_down_in_parallel(2.5);
    number_primitives(maker.scene);
    return maker.scene;
}

PictureSettings small_settings() {
    PictureSettings settings;
    settings.width = 40;
    settings.height = 40;
    settings.depth = 4;
    settings.ambient = {0.2, 0.2, 0.2};
    settings.firmament = Firmament{{0.5, 0.6, 0.7}, {0.5, 0.6, 0.7}, {0.5, 0.6, 0.7}};
    return settings;
}

Image picture(Scene scene, const PictureSettings& settings, EffectStep step) {
    const Effects effects = effects_at(step, {scene.lights, scene.materials, settings});
    scene.lights = effects.lights;
    scene.materials = effects.materials;
    const auto index = make_brute_force(scene);
    return render_scene(scene, *scene.camera, *index, effects.settings, SampleType::integer8).image;
}

std::set<std::array<int, 3>> colors(const Image& image) {
    const auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    std::set<std::array<int, 3>> result;
    for (std::size_t i = 0; i < samples.size(); i += 3)
        result.insert({samples[i], samples[i + 1], samples[i + 2]});
    return result;
}

TEST(EffectLadder, BeginsWithThePlainColoursAndNoOthers) {
    const Image flat = picture(two_balls(), small_settings(), EffectStep::flat);
    const std::set<std::array<int, 3>> expected = {
        {102, 51, 26}, {0, 0, 0}, {128, 153, 179}}; // the ball, glass, and the sky
    EXPECT_EQ(colors(flat), expected);
}

TEST(EffectLadder, AddsAnEffectWithEachStepAndEndsWithTheWholePicture) {
    const Scene scene = two_balls();
    const PictureSettings settings = small_settings();
    std::set<std::string> different;
    for (const EffectStep step : effect_steps) {
        const Image image = picture(scene, settings, step);
        const auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
        different.insert(std::string(samples.begin(), samples.end()));
    }
    EXPECT_EQ(different.size(), effect_steps.size());

    const auto index = make_brute_force(scene);
    const Image whole =
        render_scene(scene, *scene.camera, *index, settings, SampleType::integer8).image;
    EXPECT_EQ(picture(scene, settings, EffectStep::rays).samples, whole.samples);
}

TEST(EffectLadder, SaysWhyAStepChangesNothing) {
    Effects all = {{PointLight{}, PointLight{}}, {Material{}}, {}};
    all.materials[0].spc = 0.5;
    all.materials[0].rab = {0.1, 0, 0};
    for (const EffectStep step : effect_steps)
        EXPECT_FALSE(why_unchanged(step, all));

    all.settings.antialiasing.on = false;
    EXPECT_TRUE(why_unchanged(EffectStep::antialiased, all));
    all.lights.resize(1);
    EXPECT_FALSE(why_unchanged(EffectStep::highlights, all));
    all.materials[0].spc = 1;
    EXPECT_TRUE(why_unchanged(EffectStep::highlights, all));
    all.settings.shadows = false;
    EXPECT_FALSE(why_unchanged(EffectStep::rays, all));
    all.settings.depth = 1;
    EXPECT_TRUE(why_unchanged(EffectStep::rays, all));
}

TEST(EffectLadder, ShowsWhatHasNoMaterialAsBefore) {
    Scene scene = two_balls();
    scene.geometry.items[1].material = inherited_material;
    const auto index = make_brute_force(scene);
    const PictureSettings settings = small_settings();
    const Image before =
        render_scene(scene, *scene.camera, *index, settings, SampleType::integer8).image;
    give_fallback_material(scene);
    const Image after =
        render_scene(scene, *scene.camera, *index, settings, SampleType::integer8).image;
    EXPECT_EQ(before.samples, after.samples);
    EXPECT_EQ(colors(picture(scene, settings, EffectStep::flat)).count({179, 179, 179}), 1U);
    const std::size_t materials = scene.materials.size();
    give_fallback_material(scene);
    EXPECT_EQ(scene.materials.size(), materials);
}

} // namespace
} // namespace vera
