// SPDX-License-Identifier: Apache-2.0
#include "vera/shade/lighting.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double tolerance = 1e-14;

void expect_near(Color actual, Color expected) {
    EXPECT_NEAR(actual.r, expected.r, tolerance);
    EXPECT_NEAR(actual.g, expected.g, tolerance);
    EXPECT_NEAR(actual.b, expected.b, tolerance);
}

void expect_near(Vec3 actual, Vec3 expected) {
    EXPECT_NEAR(actual.x, expected.x, tolerance);
    EXPECT_NEAR(actual.y, expected.y, tolerance);
    EXPECT_NEAR(actual.z, expected.z, tolerance);
}

/// The origin of a floor that faces up.
SurfacePoint floor_point() {
    SurfacePoint surface;
    surface.geometric_normal = {0, 1, 0};
    surface.shading_normal = {0, 1, 0};
    return surface;
}

/// Seen from above at the cosine 0.8, out of the direction (0.6, 0.8, 0).
Incidence floor_seen_aslant() {
    return incidence(floor_point(), {-0.6, -0.8, 0});
}

TEST(Incidence, TurnsTheNormalToTheViewer) {
    const Incidence above = incidence(floor_point(), {0, -1, 0});
    EXPECT_EQ(above.normal, (Vec3{0, 1, 0}));
    EXPECT_TRUE(above.from_outside);
    const Incidence below = incidence(floor_point(), {0, 1, 0});
    EXPECT_EQ(below.normal, (Vec3{0, -1, 0}));
    EXPECT_EQ(below.geometric_normal, (Vec3{0, -1, 0}));
    EXPECT_FALSE(below.from_outside);
}

TEST(Incidence, MirrorsTheDirectionToTheViewer) {
    const Incidence at = floor_seen_aslant();
    expect_near(at.to_viewer, {0.6, 0.8, 0});
    expect_near(at.mirrored, {-0.6, 0.8, 0});
    EXPECT_NEAR(at.cos_viewer, 0.8, tolerance);
}

TEST(Lighting, AmbientLightDependsOnTheViewerByDrfAlone) {
    Material material;
    material.drf = {0.5, 0.25, 0};
    material.arf = {0.1, 0, 0.2};
    const LocalTerms terms = unlit(floor_seen_aslant(), material, {0.5, 1, 2});
    expect_near(
        terms.ambient, {(0.8 * 0.5 + 0.1) * 0.5, (0.8 * 0.25 + 0) * 1, (0.8 * 0 + 0.2) * 2});
    EXPECT_TRUE(is_black(terms.luminosity));
}

TEST(Lighting, SelfLuminosityDependsOnTheViewerBySanAlone) {
    Material material;
    material.sdi = {0.5, 0.25, 0};
    material.san = {0.1, 0, 0.2};
    const LocalTerms terms = unlit(floor_seen_aslant(), material, {});
    expect_near(terms.luminosity, {0.8 * 0.1 + 0.5, 0.25, 0.8 * 0.2});
}

TEST(Lighting, DiffuseLightFollowsTheFormula) {
    Material material;
    material.drf = {0.5, 0.25, 0};
    material.arf = {0.1, 0, 0.2};
    PointLight light;
    light.position = {0, 3, 4}; // L = (0, 0.6, 0.8) at distance 5; L.N = 0.6, L.R = 0.48
    light.intensity = 50;
    light.color = {1, 0.5, 0.25};
    const LightTerms terms = unshadowed(floor_seen_aslant(), material, light);
    expect_near(terms.diffuse, {(0.6 * 0.5 + 0.48 * 0.1) * 2, 0.6 * 0.25 * 1, 0.48 * 0.2 * 0.5});
    EXPECT_TRUE(is_black(terms.highlight));
}

TEST(Lighting, ArfGivesNothingOfLightFromBehindTheViewer) {
    Material material;
    material.arf = {1, 1, 1};
    PointLight light;
    light.position = {-8, 6, 0}; // L = (-0.8, 0.6, 0); L.R = 0
    const Incidence at = incidence(floor_point(), {-0.8, -0.6, 0});
    EXPECT_TRUE(is_black(unshadowed(at, material, light)));
}

TEST(Lighting, FalloffNoneDoesNotDependOnTheDistance) {
    Material material;
    material.drf = {1, 1, 1};
    PointLight light;
    light.position = {0, 1000, 0};
    light.intensity = 0.5;
    light.falloff = Falloff::none;
    expect_near(unshadowed(floor_seen_aslant(), material, light).diffuse, {0.5, 0.5, 0.5});
}

TEST(Lighting, TheHighlightFallsFromTheMirrorDirectionToSpc) {
    EXPECT_EQ(highlight_factor(1, 0.5), -1);
    EXPECT_EQ(highlight_factor(0.5, 0.5), 0);
    EXPECT_EQ(highlight_factor(0.4, 0.5), 0);
    EXPECT_DOUBLE_EQ(highlight_factor(0.75, 0.5), 0.25 * -0.75 / 0.25);
    EXPECT_EQ(highlight_factor(-1, -1), 0);
    EXPECT_EQ(highlight_factor(1, -1), -1);
    EXPECT_EQ(highlight_factor(1, 1), 0) << "SPC 1 is a surface without highlight";
}

TEST(Lighting, TheHighlightIsTheSquaredFactorTimesTheIntensity) {
    Material material;
    material.spc = 0.5;
    PointLight light;
    light.position = {0, 10, 0}; // L.S = 0.8
    light.intensity = 200;
    light.color = {1, 0.5, 0};
    const double factor = 0.3 * (0.8 + 0.5 - 2) / 0.25;
    const LightTerms terms = unshadowed(floor_seen_aslant(), material, light);
    expect_near(terms.highlight, {factor * factor * 2, factor * factor, 0});
    EXPECT_TRUE(is_black(terms.diffuse));
}

TEST(Lighting, LightFromBelowTheSurfaceGivesNothing) {
    Material material;
    material.drf = {1, 1, 1};
    material.arf = {1, 1, 1};
    material.spc = -1;
    PointLight light;
    for (const Vec3 position : {Vec3{0, -1, 0}, Vec3{5, 0, 0}, Vec3{0, 0, 0}}) {
        light.position = position;
        EXPECT_TRUE(is_black(unshadowed(floor_seen_aslant(), material, light)));
    }
}

TEST(Lighting, APatchBlocksLightBehindItsOwnFace) {
    SurfacePoint patch = floor_point();
    patch.shading_normal = normalized({1, 1, 0});
    Material material;
    material.drf = {1, 1, 1};
    PointLight light;
    light.position = {5, -1, 0}; // before the interpolated normal, behind the face
    const Incidence at = incidence(patch, {0, -1, 0});
    ASSERT_GT(dot(light.position, at.normal), 0);
    EXPECT_TRUE(is_black(unshadowed(at, material, light)));
    light.position = {5, 1, 0};
    EXPECT_FALSE(is_black(unshadowed(at, material, light)));
}

TEST(Lighting, ALightInThePlaneOfAFaceGivesNothingWhateverRounds) {
    Material material;
    material.drf = {1, 1, 1};
    material.arf = {1, 1, 1};
    const Vec3 along = {2, -1, 0};
    const Vec3 across = {3, 0, -1};
    const Vec3 corner = {0.1, 0.1, 0.1};
    SurfacePoint surface;
    surface.geometric_normal = normalized({1, 2, 3});
    PointLight light;
    light.position = corner + 0.3 * along + 0.2 * across;
    std::size_t before_by_rounding = 0;
    for (int i = 0; i < 400; ++i) {
        surface.point = corner + (i % 20) / 70.0 * along - (i / 20) / 90.0 * across;
        surface.point_error = 0x1p-50;
        const Vec3 to_light = light.position - surface.point;
        surface.shading_normal = normalized(surface.geometric_normal + 0.1 * to_light);
        before_by_rounding += dot(to_light, surface.geometric_normal) > 0 ? 1 : 0;
        const Incidence at = incidence(surface, -surface.geometric_normal);
        ASSERT_TRUE(is_black(unshadowed(at, material, light))) << i;
    }
    EXPECT_GT(before_by_rounding, 0U); // these would be lit
    light.position = light.position + 0x1p-40 * surface.geometric_normal;
    const Incidence at = incidence(surface, -surface.geometric_normal);
    EXPECT_FALSE(is_black(unshadowed(at, material, light)));
}

TEST(Lighting, VisibilityDimsDiffuseLightAndHighlightByColour) {
    const LightTerms terms = {{1, 2, 4}, {8, 16, 32}};
    EXPECT_EQ((Color{1, 0.5, 0} * terms), (LightTerms{{1, 1, 0}, {8, 8, 0}}));
}

TEST(Refraction, GoesStraightOnWithoutAChangeOfIndex) {
    const Vec3 direction = normalized({0.3, -0.7, 0.2});
    EXPECT_EQ(refracted(incidence(floor_point(), direction), 1), direction);
}

TEST(Refraction, BendsBySnellsLawOnTheWayIn) {
    // sin 0.6 becomes sin 0.4 inside glass of index 1.5.
    const auto direction = refracted(floor_seen_aslant(), 1.5);
    ASSERT_TRUE(direction);
    expect_near(*direction, {-0.4, -std::sqrt(1 - 0.16), 0});
}

TEST(Refraction, BendsBackOnTheWayOut) {
    // From below the floor, which is inside.
    const auto direction = refracted(incidence(floor_point(), {0.4, std::sqrt(1 - 0.16), 0}), 1.5);
    ASSERT_TRUE(direction);
    expect_near(*direction, {0.6, 0.8, 0});
}

TEST(Refraction, IsTotalReflectionBeyondTheCriticalAngle) {
    // The sine 0.8 would become 1.2.
    EXPECT_FALSE(refracted(incidence(floor_point(), {0.8, 0.6, 0}), 1.5));
    EXPECT_TRUE(refracted(incidence(floor_point(), {0.8, -0.6, 0}), 1.5));
    EXPECT_FALSE(refracted(incidence(floor_point(), {0.8, -0.6, 0}), 0.75)) << "thin inside";
}

TEST(Material, IsTheFallbackWhereNoneWasSaid) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].sdi = {1, 0, 0};
    EXPECT_EQ(material_of(scene, inherited_material).drf, (Color{0.7, 0.7, 0.7}));
    EXPECT_EQ(material_of(scene, MaterialId{0}).sdi, (Color{1, 0, 0}));
}

} // namespace
} // namespace vera
