// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/scene_writer.h"
#include "vera/formats/vera_scene.h"
#include "vera/generate/generator.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

Scene made(std::string_view name, const std::vector<std::pair<const char*, double>>& given = {}) {
    const Generator* const generator = generator_named(name);
    if (generator == nullptr)
        throw std::runtime_error(std::string(name));
    ParameterValues values(*generator);
    for (const auto& [parameter_name, value] : given)
        for (const Parameter& parameter : generator->parameters)
            if (parameter.name == parameter_name) {
                EXPECT_EQ(values.set(parameter, value), std::nullopt);
            }
    Scene scene = generator->make(values);
    number_primitives(scene);
    return scene;
}

std::uint64_t
primitives(std::string_view name, const std::vector<std::pair<const char*, double>>& given = {}) {
    return made(name, given).geometry.primitive_count;
}

// As many as the files of the Standard Procedural Databases hold, but for their floors.
TEST(Generators, HaveAsManyPrimitivesAsTheClassics) {
    EXPECT_EQ(primitives("balls", {{"size", 4}}), 7381U);
    EXPECT_EQ(primitives("tetra", {{"size", 6}}), 4096U);
    EXPECT_EQ(primitives("jacks", {{"size", 4}}), 1755U + 3510U);
    EXPECT_EQ(primitives("lattice", {{"size", 12}}), 2197U + 6084U);
    EXPECT_EQ(primitives("rings", {{"size", 7}}), 4200U + 4200U);
    EXPECT_EQ(primitives("branches", {{"size", 11}}), 4095U + 4095U);
    EXPECT_EQ(primitives("shells", {{"turns", 9}}), 5761U);
}

TEST(Generators, HaveNamesInOrderAndParametersWithinTheirBounds) {
    std::string_view before;
    for (const Generator& generator : generators()) {
        EXPECT_LT(before, generator.name);
        before = generator.name;
        EXPECT_FALSE(generator.summary.empty());
        ParameterValues values(generator);
        for (const Parameter& parameter : generator.parameters) {
            EXPECT_EQ(values.set(parameter, parameter.standard), std::nullopt) << parameter.name;
            EXPECT_EQ(values.set(parameter, parameter.least), std::nullopt) << parameter.name;
            EXPECT_EQ(values.set(parameter, parameter.most), std::nullopt) << parameter.name;
            EXPECT_NE(values.set(parameter, parameter.most + 1), std::nullopt) << parameter.name;
            EXPECT_FALSE(parameter.meaning.empty()) << parameter.name;
        }
    }
}

TEST(Generators, SayWhatAValueMustBe) {
    const Generator& balls = *generator_named("balls");
    ParameterValues values(balls);
    EXPECT_EQ(
        values.set(balls.parameters[0], 2.5),
        "size of balls is 2.5, but must be a whole number from 0 to 12");
}

class EveryGenerator : public testing::TestWithParam<const Generator*> {};

// Staged and written, read again without a warning: the same primitives, and the same text twice.
TEST_P(EveryGenerator, IsATextThatReadsAsTheSameScene) {
    const Generator& generator = *GetParam();
    const ParameterValues values(generator);
    const Scene scene =
        staged(generator.make(values), std::string(generator.name), generator.stage);
    const std::string text = vera_scene_text(scene);
    const SceneFile read = read_vera_scene(SourceText("made.vera", text));
    for (const Diagnostic& warning : read.warnings)
        ADD_FAILURE() << to_text(warning);
    EXPECT_EQ(read.scene.geometry.primitive_count, scene.geometry.primitive_count);
    EXPECT_EQ(read.scene.materials.size(), scene.materials.size());
    ASSERT_TRUE(read.scene.camera.has_value());
    EXPECT_EQ(read.scene.camera->viewpoint, scene.camera->viewpoint);
    EXPECT_EQ(read.scene.lights.size(), 4U);
    EXPECT_EQ(
        vera_scene_text(
            staged(generator.make(values), std::string(generator.name), generator.stage)),
        text);
}

std::vector<const Generator*> all_generators() {
    std::vector<const Generator*> all;
    for (const Generator& generator : generators())
        all.push_back(&generator);
    return all;
}

std::string name_of(const testing::TestParamInfo<const Generator*>& test) {
    return std::string(test.param->name);
}

INSTANTIATE_TEST_SUITE_P(All, EveryGenerator, testing::ValuesIn(all_generators()), name_of);

} // namespace
} // namespace vera
