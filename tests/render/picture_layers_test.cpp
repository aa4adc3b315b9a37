// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/accel/grid_tree.h"
#include "vera/accel/wide_bvh.h"
#include "vera/image/develop.h"
#include "vera/render/exposure.h"
#include "vera/render/picture_layers.h"
#include "vera/render/ray_tree.h"
#include "vera/render/render_scene.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "accel/random_scene.h"
#include "reference/example_scenes.h"
#include "test_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using Bytes = std::array<std::uint8_t, 3>;

Bytes developed(double r, double g, double b) {
    return {developed_byte(r), developed_byte(g), developed_byte(b)};
}

Bytes byte_at(const Image& image, std::size_t x, std::size_t y) {
    const auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    const std::size_t first = 3 * (y * image.width + x);
    return {samples[first], samples[first + 1], samples[first + 2]};
}

/// A scene with everything that its picture, without antialiasing, needs.
struct Lit {
    Lit(Scene of, const Camera& seen_by, PictureSettings with)
        : scene(std::move(of))
        , camera(seen_by)
        , settings(std::move(with))
        , index(make_wide_bvh(scene))
        , traced(traced_scene(scene, *index, settings)) {
        settings.antialiasing.on = false;
        RenderStatistics statistics;
        if (settings.exposure)
            expose(traced, camera, *settings.exposure, statistics);
    }

    Raster raster() const { return {ViewRays(camera), settings.width, settings.height}; }

    Image picture() const {
        return render_scene(scene, camera, *index, settings, SampleType::integer8).image;
    }

    Scene scene;
    Camera camera;
    PictureSettings settings;
    std::unique_ptr<RayIndex> index;
    TracedScene traced;
};

struct Layers {
    std::vector<LayerChannel> channels;
    std::vector<std::vector<std::uint32_t>> words; ///< of each channel

    float sample(std::size_t channel, std::size_t pixel) const {
        return std::bit_cast<float>(words[channel][pixel]);
    }
};

Layers rendered_layers(const TracedScene& traced, const Raster& raster) {
    const std::vector<PictureLayer> layers = picture_layers(traced);
    Layers result;
    result.channels = layer_channels(layers);
    result.words.resize(result.channels.size());
    std::size_t next = 0;
    render_layers(
        traced,
        raster,
        layers,
        [&](std::size_t y, std::size_t rows, std::span<const std::uint32_t> words) {
            EXPECT_EQ(y, next);
            next += rows;
            const std::size_t plane = rows * raster.width;
            for (std::size_t i = 0; i < result.words.size(); ++i)
                result.words[i].insert(
                    result.words[i].end(),
                    words.begin() + static_cast<std::ptrdiff_t>(i * plane),
                    words.begin() + static_cast<std::ptrdiff_t>((i + 1) * plane));
        });
    EXPECT_EQ(next, raster.height);
    return result;
}

/// The numbers of the channels, in the order in which a reader of EXR finds them.
std::vector<std::size_t> name_order(const Layers& layers) {
    std::vector<std::size_t> order(layers.channels.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return layers.channels[a].name < layers.channels[b].name;
    });
    return order;
}

/// The sum of the channels whose names end so.
float sum_of(
    const Layers& layers,
    const std::vector<std::size_t>& order,
    const char* ending,
    std::size_t pixel) {
    float sum = 0;
    for (const std::size_t channel : order)
        if (layers.channels[channel].name.ends_with(ending))
            sum += layers.sample(channel, pixel);
    return sum;
}

void expect_layers_to_be_the_picture(const Lit& lit) {
    const Layers layers = rendered_layers(lit.traced, lit.raster());
    const std::vector<std::size_t> order = name_order(layers);
    const Image picture = lit.picture();
    for (std::size_t y = 0; y < picture.height; ++y)
        for (std::size_t x = 0; x < picture.width; ++x) {
            const std::size_t pixel = y * picture.width + x;
            const float r = sum_of(layers, order, ".R", pixel);
            const float g = sum_of(layers, order, ".G", pixel);
            const float b = sum_of(layers, order, ".B", pixel);
            ASSERT_EQ(developed(r, g, b), byte_at(picture, x, y)) << x << ' ' << y;
        }
}

/// The product of what stands between a place and a light is the visibility that the index says.
void expect_crossings_to_tell_visibility(const RayTree& tree) {
    for (const RayNode& node : tree.nodes)
        for (const LightAtPlace& light : node.lights) {
            Color product = {1, 1, 1};
            for (const ShadowCrossing& crossing : light.crossings)
                product = is_black(crossing.tab) ? Color{} : product * crossing.tab;
            ASSERT_EQ(product, light.visibility);
        }
}

/// At random pixels the explanation, place by place, is what the picture shows.
void expect_trees_to_explain_the_picture(const Lit& lit, std::size_t pixels) {
    std::mt19937 random(1988);
    const Raster raster = lit.raster();
    const Image picture = lit.picture();
    const std::vector<PictureLayer> layers = picture_layers(lit.traced);
    GenerationTracer tracer(lit.traced);
    const RayTerms terms = tracer.terms();
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::size_t x = random() % raster.width;
        const std::size_t y = random() % raster.height;
        const QueryRay ray = raster.ray(static_cast<double>(x), static_cast<double>(y));
        const RayTree tree = ray_tree(lit.traced, ray);
        ASSERT_TRUE(tree.complete);
        const Color color = tree.nodes.front().color;
        ASSERT_EQ(developed(color.r, color.g, color.b), byte_at(picture, x, y)) << x << ' ' << y;

        Hit hit;
        SurfacePoint surface;
        Color traced_color;
        std::vector<Color> traced_terms(light_way_count * terms.count(), Color{9, 9, 9});
        tracer.nearest({&ray, 1}, {&hit, 1});
        tracer.surfaces({&ray, 1}, {&hit, 1}, {&surface, 1});
        tracer.shade({&ray, 1}, {&hit, 1}, {&surface, 1}, {&traced_color, 1}, traced_terms);
        ASSERT_EQ(color, traced_color) << x << ' ' << y;
        ASSERT_EQ(ray_terms(tree, terms), traced_terms) << x << ' ' << y;

        const auto sum = layer_sum(layer_samples(layers, traced_terms, color));
        ASSERT_EQ(developed(sum[0], sum[1], sum[2]), byte_at(picture, x, y)) << x << ' ' << y;
        expect_crossings_to_tell_visibility(tree);
    }
}

class ExampleLayers : public ::testing::TestWithParam<std::string> {
protected:
    static Lit lit() {
        auto [scene, settings] = reference::example(GetParam(), 100);
        const Camera camera = *scene.camera;
        return {std::move(scene), camera, settings};
    }
};

TEST_P(ExampleLayers, AddUpToThePicturesBytes) {
    expect_layers_to_be_the_picture(lit());
}

// 10 000 pixels of five scenes.
TEST_P(ExampleLayers, AndRayTreesExplainItsPixelsToTheBit) {
    expect_trees_to_explain_the_picture(lit(), 2000);
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    ExampleLayers,
    ::testing::Values(
        "still_life.vera", "glass.vera", "mirror_room.vera", "jewels.vera", "pins.nff"),
    reference::example_name);

Camera camera_towards_the_origin() {
    Camera camera;
    camera.viewpoint = {9, 4, 3};
    camera.lower_left = {3, -2, -1};
    camera.lower_right = {3, -2, 3};
    camera.upper_left = {3, 2, -1};
    return camera;
}

Lit random_lit(std::uint64_t seed) {
    testing::RandomSceneSettings random;
    random.glass = seed % 2 == 0;
    Scene scene = testing::random_scene(seed, random);
    for (Material& material : scene.materials) {
        material.drf = {0.4, 0.5, 0.6};
        material.arf = {0.1, 0, 0.25};
        material.rab = {0.3, 0.2, 0.1};
        material.san = {0, 0, 0.125};
        material.spc = 0.5;
        material.ref = seed % 3 == 0 ? 1.5 : 1;
    }
    scene.lights.push_back({{5, 6, 9}, 90, {1, 1, 0.8}, Falloff::inverse_square});
    scene.lights.push_back({{-5, 6, 2}, 0.25, {1, 0.5, 1}, Falloff::none});
    PictureSettings settings = plain_settings(36, 35);
    settings.depth = 4;
    settings.ambient = {0.1, 0.2, 0.1};
    settings.shadows = seed % 4 != 3;
    settings.firmament = Firmament{{0, 0.1, 0.9}, {0.5, 0.5, 0.7}, {0.2, 0.3, 0.1}};
    if (seed % 5 == 0)
        settings.exposure = 0.75;
    return {std::move(scene), camera_towards_the_origin(), settings};
}

TEST(PictureLayers, OfRandomScenesAddUpAndAreExplained) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        SCOPED_TRACE(seed);
        const Lit lit = random_lit(seed);
        expect_layers_to_be_the_picture(lit);
        expect_trees_to_explain_the_picture(lit, 60);
    }
}

TEST(PictureLayers, AreTheSameForAnyNumberOfThreadsAndAnyIndex) {
    const Lit lit = random_lit(2);
    std::optional<Layers> first;
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const ThreadLimit limit(threads);
        const Layers layers = rendered_layers(lit.traced, lit.raster());
        if (!first)
            first = layers;
        EXPECT_EQ(layers.words, first->words) << threads;
    }
    const auto brute_force = make_brute_force(lit.scene);
    const auto grids = make_grid_tree(lit.scene);
    for (const RayIndex* index : std::initializer_list<const RayIndex*>{&*brute_force, &*grids}) {
        const TracedScene traced = traced_scene(lit.scene, *index, lit.settings);
        EXPECT_EQ(rendered_layers(traced, lit.raster()).words, first->words);
    }
}

TEST(PictureLayers, TellWhatIsSeenWhere) {
    SceneMaker maker;
    maker.material(diffuse({0.5, 0.5, 0.5}));
    maker.material(luminous({1, 0.5, 0}));
    maker.sphere({0, 0, -4}, 1);
    maker.look_down_in_parallel(3);
    const Lit lit(maker.finish(), *maker.scene.camera, plain_settings(3, 3));
    const Layers layers = rendered_layers(lit.traced, lit.raster());
    const auto channel = [&](const std::string& name) {
        for (std::size_t i = 0; i < layers.channels.size(); ++i)
            if (layers.channels[i].name == name)
                return i;
        ADD_FAILURE() << name;
        return std::size_t{0};
    };
    constexpr std::size_t middle = 4;
    EXPECT_EQ(layers.sample(channel("Z"), middle), 3);
    EXPECT_EQ(layers.sample(channel("normal.Z"), middle), 1);
    EXPECT_EQ(layers.sample(channel("position.Z"), middle), -3);
    EXPECT_EQ(layers.words[channel("object.id")][middle], 1U);
    EXPECT_EQ(layers.words[channel("material.id")][middle], 2U);
    EXPECT_EQ(layers.sample(channel("direct.luminosity.G"), middle), 0.5F);
    EXPECT_EQ(layers.sample(channel("Z"), 0), std::numeric_limits<float>::infinity());
    EXPECT_EQ(layers.words[channel("object.id")][0], 0U);
    EXPECT_EQ(layers.words[channel("material.id")][0], 0U);
}

TEST(PictureLayers, LeaveOutWaysThatNoLightComesOn) {
    SceneMaker maker;
    maker.material(diffuse({0.5, 0.5, 0.5}));
    maker.sphere({0, 0, -4}, 1);
    for (int i = 0; i < 10; ++i)
        maker.light({1.0 * i, 0, 9}, 1);
    maker.look_down_in_parallel(3);
    Lit lit(maker.finish(), *maker.scene.camera, plain_settings(1, 1));
    const auto layers = picture_layers(lit.traced);
    EXPECT_EQ(layers.size(), 23U);
    EXPECT_EQ(layers.front().name, "direct.ambient");
    EXPECT_EQ(layers[2].name, "direct.light01.diffuse");
    lit.scene.materials[0].tab = {0, 0, 1};
    EXPECT_EQ(picture_layers(lit.traced).size(), 46U);
    lit.scene.materials[0].rab = {0, 0, 1};
    EXPECT_EQ(picture_layers(lit.traced).size(), 69U);
    lit.traced.depth = 1;
    EXPECT_EQ(picture_layers(lit.traced).size(), 23U);
}

// Values beside a border between two bytes, where the nearest float lies on its other side.
TEST(PictureLayers, EndInTheBytesOfTheExactValue) {
    const std::vector<PictureLayer> layers = {{"a", 0}, {"b", 1}};
    std::mt19937 random(3);
    std::size_t moved = 0;
    for (int i = 0; i < 20000; ++i) {
        const double border = (static_cast<double>(random() % 255) + 0.5) / 255;
        const double value = border + (static_cast<double>(random() % 9) - 4) * 0x1p-53;
        const double part = value * (static_cast<double>(random() % 5) / 4);
        const std::vector<Color> terms = {
            {part, part, part}, {value - part, value - part, value - part}};
        const Color color = {value, value, value};
        const auto sum = layer_sum(layer_samples(layers, terms, color));
        ASSERT_EQ(developed(sum[0], sum[1], sum[2]), developed(value, value, value)) << value;
        const auto nearest = static_cast<float>(value);
        moved += developed(nearest, nearest, nearest) != developed(value, value, value);
    }
    EXPECT_GT(moved, 100U);
}

} // namespace
} // namespace vera
