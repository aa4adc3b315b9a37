// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_tree.h"
#include "vera/render/render_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "reference/example_scenes.h"
#include "reference/reference_renderer.h"

namespace vera::reference {
namespace {

/// The reference asks every ray of every primitive: of scenes with very many, or with glass and
/// mirrors that send rays on and on, a smaller picture.
std::uint32_t affordable_width(const std::string& file) {
    constexpr std::uint32_t usual = 128;
    constexpr double usual_primitives = 1500;
    constexpr double usual_depth = 3;
    const auto [scene, settings] = example(file, usual);
    const double by_primitives =
        std::sqrt(usual_primitives / static_cast<double>(scene.geometry.primitive_count));
    const double by_depth = usual_depth / settings.depth;
    return static_cast<std::uint32_t>(
        usual * std::min(1.0, by_primitives) * std::min(1.0, by_depth));
}

class Agreement : public testing::TestWithParam<std::string> {};

TEST_P(Agreement, OfAllBytes999In1000AreWithinOneOfTheReference) {
    auto [scene, settings] = example(GetParam(), affordable_width(GetParam()));
    settings.antialiasing.on = false;
    const auto index = make_grid_tree(scene);
    const RenderResult rendered =
        render_scene(scene, *scene.camera, *index, settings, SampleType::integer8);
    const ReferencePicture expected = reference_picture(scene, settings);

    const auto& bytes = std::get<std::vector<std::uint8_t>>(rendered.image.samples);
    ASSERT_EQ(bytes.size(), expected.bytes.size());
    std::size_t equal = 0;
    std::size_t close = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const int difference = std::abs(bytes[i] - expected.bytes[i]);
        equal += difference == 0;
        close += difference <= 1;
    }
    const auto percent = [&](std::size_t count) {
        return 100 * static_cast<double>(count) / static_cast<double>(bytes.size());
    };
    std::printf(
        "%-18s %8.4f %% within 1, %8.4f %% equal\n",
        GetParam().c_str(),
        percent(close),
        percent(equal));
    EXPECT_GE(percent(close), 99.9);
    if (rendered.exposure) {
        EXPECT_NEAR(rendered.exposure->factor / expected.light_factor, 1, 1e-9);
    }
}

INSTANTIATE_TEST_SUITE_P(Examples, Agreement, testing::ValuesIn(example_files()), example_name);

} // namespace
} // namespace vera::reference
