// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/scene_writer.h"
#include "vera/formats/vera_scene.h"
#include "vera/generate/gears.h"
#include "vera/generate/generator.h"

#include <array>
#include <map>
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

// Counted, not timed: what is in memory does not grow with what is seen.
TEST(Generators, HoldABillionLeavesInFewCalls) {
    const Scene forest = made("forest", {{"rows", 141}, {"levels", 8}, {"leaves", 8}});
    // A tree of 8 forks by three has 3^8 twigs, of 8 leaves each.
    EXPECT_GE(std::uint64_t{141 * 141} * 6561 * 8, 1'000'000'000U);
    std::size_t held = 0;
    std::uint64_t triangles_of_a_leaf = 0;
    for (const Geometry& subscene : forest.subscenes) {
        held += subscene.items.size();
        for (const Mesh& mesh : subscene.meshes)
            triangles_of_a_leaf = mesh.triangle_count();
    }
    EXPECT_LT(held, 500U);
    EXPECT_EQ(forest.geometry.calls.size(), 141U * 141U);
    EXPECT_GT(forest.geometry.primitive_count, 1'000'000'000U * triangles_of_a_leaf);
}

// A million balls, and more than a billion tetrahedra, end at the plane that they stand on: to
// frame them takes no more than to frame one.
TEST(Generators, AreStagedAtTheirLargestSizes) {
    for (const char* const name : {"balls", "branches", "jacks", "lattice", "tetra"}) {
        const Generator& generator = *generator_named(name);
        ParameterValues values(generator);
        for (const Parameter& parameter : generator.parameters)
            if (parameter.name == "size") {
                EXPECT_EQ(values.set(parameter, parameter.most), std::nullopt);
            }
        const Scene scene = staged(generator.make(values), name, generator.stage);
        EXPECT_TRUE(scene.camera.has_value()) << name;
        EXPECT_GT(scene.geometry.primitive_count, 10'000'000U) << name;
    }
}

// What 'vera make --list' says of it.
TEST(Generators, MakeABillionLeavesOf340RowsOfStandardTrees) {
    const std::string summary(generator_named("forest")->summary);
    EXPECT_THAT(summary, testing::HasSubstr("340 rows are a billion leaves"));
    const std::uint64_t with_leaves = primitives("forest", {{"rows", 3}});
    const std::uint64_t bare = primitives("forest", {{"rows", 3}, {"leaves", 0}});
    const std::uint64_t with_one = primitives("forest", {{"rows", 3}, {"leaves", 1}});
    const std::uint64_t standard_leaves = 12;
    EXPECT_EQ(with_leaves - bare, standard_leaves * (with_one - bare));
    // 9 trees of 3^6 twigs; so many triangles has a leaf.
    const std::uint64_t triangles = (with_one - bare) / (9 * 729);
    const std::uint64_t of_a_tree = (with_leaves - bare) / 9 / triangles;
    EXPECT_NEAR(static_cast<double>(340 * 340 * of_a_tree), 1e9, 0.02e9);
}

TEST(Generators, GrowAFicusThatIsOlderOnTopOfTheYoungerOne) {
    const auto leaves = [](double age) {
        const Scene scene = made("ficus", {{"age", age}, {"triangles", 100}});
        return scene.geometry.calls.size();
    };
    EXPECT_LT(leaves(5), leaves(10));
    EXPECT_LT(leaves(10), leaves(20));
    // Leaves fall after 24 steps, or a few more.
    const Scene stem =
        made("ficus", {{"age", 60}, {"stems", 1}, {"branching", 0}, {"triangles", 100}});
    EXPECT_GT(stem.geometry.calls.size(), 15U);
    EXPECT_LT(stem.geometry.calls.size(), 28U);
    EXPECT_EQ(made("ficus", {{"triangles", 2000}}).subscenes.size(), 1U);
    const std::size_t blade =
        made("ficus", {{"triangles", 2000}}).subscenes[0].meshes.at(0).triangle_count();
    EXPECT_GT(blade, 1500U);
    EXPECT_LT(blade, 2500U);
}

/// How often the sides of triangles and polygons lie between two places, one way less the other.
std::map<std::array<double, 6>, int> open_sides(const Geometry& geometry) {
    std::map<std::array<double, 6>, int> sides;
    const auto count = [&](Vec3 a, Vec3 b) {
        const std::array<double, 3> first = {a.x, a.y, a.z};
        const std::array<double, 3> second = {b.x, b.y, b.z};
        const bool forwards = first < second;
        const Vec3 low = forwards ? a : b;
        const Vec3 high = forwards ? b : a;
        sides[{low.x, low.y, low.z, high.x, high.y, high.z}] += forwards ? 1 : -1;
    };
    for (const Triangle& triangle : geometry.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            count(triangle.corners[i], triangle.corners[(i + 1) % 3]);
    for (const Polygon& polygon : geometry.polygons)
        for (std::uint32_t i = 0; i < polygon.corner_count; ++i)
            count(
                geometry.corners[polygon.first_corner + i],
                geometry.corners[polygon.first_corner + (i + 1) % polygon.corner_count]);
    std::erase_if(sides, [](const auto& side) { return side.second == 0; });
    return sides;
}

TEST(Generators, MakeLandWithoutGaps) {
    const Scene scene = made("terrain", {{"detail", 5}, {"water", 0}});
    // The bottom is one square, whose sides are not cut where the walls' are.
    const std::size_t cuts = 4 * 32 + 4;
    EXPECT_EQ(open_sides(scene.geometry).size(), cuts);
    for (const auto& [side, count] : open_sides(scene.geometry)) {
        EXPECT_EQ(side[1], -0.08);
        EXPECT_EQ(side[4], -0.08);
    }
}

TEST(Generators, MakeGearsThatAreClosed) {
    for (const double teeth : {6, 17, 24, 60})
        EXPECT_THAT(open_sides(made("gear", {{"teeth", teeth}}).geometry), testing::IsEmpty())
            << teeth;
}

bool crosses(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const auto side = [](Vec3 p, Vec3 q, Vec3 r) { return cross(q - p, r - p).z; };
    return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/// The outline of a gear of all its teeth, turned and moved.
std::vector<Vec3> outline(std::size_t teeth, double turn_degrees, double x) {
    std::vector<Vec3> points;
    const std::vector<Vec3> tooth = tooth_outline({.teeth = teeth});
    for (std::size_t i = 0; i < teeth; ++i)
        for (const Vec3 point : tooth)
            points.push_back(transformed_point(
                composed(
                    translation({x, 0, 0}),
                    rotation(
                        {0,
                         0,
                         turn_degrees
                             + 360.0 * static_cast<double>(i) / static_cast<double>(teeth)})),
                point));
    return points;
}

// Turned together, involute teeth touch and never cut each other; a little play is left to them.
TEST(Generators, MakeTeethThatRollOnEachOther) {
    constexpr std::size_t one = 30;
    constexpr std::size_t other = 20;
    for (const double turn : {0.0, 2.0, 5.5, 9.0}) {
        const std::vector<Vec3> first = outline(one, turn, 0);
        const double back = 180 + 180.0 / other - turn * one / other;
        const std::vector<Vec3> second = outline(other, back, 25.02);
        for (std::size_t i = 0; i < first.size(); ++i)
            for (std::size_t j = 0; j < second.size(); ++j)
                ASSERT_FALSE(crosses(
                    first[i],
                    first[(i + 1) % first.size()],
                    second[j],
                    second[(j + 1) % second.size()]))
                    << turn;
        // Moved together by a quarter of a tooth's height, they do.
        bool cut = false;
        const std::vector<Vec3> nearer = outline(other, back, 24.5);
        for (std::size_t i = 0; i < first.size(); ++i)
            for (std::size_t j = 0; j < nearer.size(); ++j)
                cut = cut
                    || crosses(
                          first[i],
                          first[(i + 1) % first.size()],
                          nearer[j],
                          nearer[(j + 1) % nearer.size()]);
        EXPECT_TRUE(cut) << turn;
    }
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
