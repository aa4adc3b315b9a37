// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/draw_scene.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scene/make_scene.h"
#include "visible/painted_color.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::add;
using test::add_polygon;

Camera camera_from_the_front() {
    Camera camera;
    camera.projection = Camera::Projection::parallel;
    camera.direction = {0, 0, -1};
    camera.lower_left = {-3, -3, 0};
    camera.lower_right = {3, -3, 0};
    camera.upper_left = {-3, 3, 0};
    return camera;
}

constexpr double per_unit = 512 / 6.0; // pixels

/// A wall of that grey between two heights.
void add_wall(Scene& scene, double from, double to, double grey) {
    Material material;
    material.sdi = {grey, grey, grey};
    add_polygon(scene.geometry, {{-2, from, 0}, {2, from, 0}, {2, to, 0}, {-2, to, 0}});
    scene.geometry.items.back().material = static_cast<MaterialId>(scene.materials.size());
    scene.materials.push_back(material);
}

/// Whether the outline of face number i, the underlay left out, covers the point at that height.
bool goes_below(const Drawing& drawing, std::size_t i, double height) {
    const DrawingPoint at = {256.3, 256 - height};
    return testing::turns_about(testing::flattened_rings(drawing.fills[i]), at) != 0;
}

TEST(DrawnSeams, MixNoOtherColorIntoWhatLiesBeyondAThinNeighbour) {
    // Above, below, and between them, painted last, a strip of 8 pixels, of another colour than
    // what is below it or of much the same.
    for (const bool is_alike : {false, true}) {
        Scene scene;
        const double width = 8 / per_unit;
        add_wall(scene, width, 2, 0.5);
        add_wall(scene, -2, 0, is_alike ? 0.85 : 0.1);
        add_wall(scene, 0, width, 0.9);
        number_primitives(scene);
        DrawSettings settings;
        const Drawing drawing = draw_scene(scene, camera_from_the_front(), {}, settings).drawing;
        ASSERT_EQ(drawing.fills.size(), 4U);
        ASSERT_EQ(drawing.fills[0].id, "underlay");
        ASSERT_EQ(drawing.fills[2].id, "face-2");
        EXPECT_TRUE(goes_below(drawing, 2, -1)) << is_alike;
        EXPECT_TRUE(goes_below(drawing, 2, 0.6)) << is_alike; // below the strip near it
        EXPECT_EQ(goes_below(drawing, 2, 7.4), is_alike);     // and not as far as what is above
        EXPECT_FALSE(goes_below(drawing, 2, 9)) << is_alike;
    }
}

/// A rectangle of that grey before the wall at z = 0.
void add_rectangle(Scene& scene, Vec3 lower, Vec3 upper, double grey) {
    Material material;
    material.sdi = {grey, grey, grey};
    add_polygon(scene.geometry, {lower, {upper.x, lower.y, 0}, upper, {lower.x, upper.y, 0}});
    scene.geometry.items.back().material = static_cast<MaterialId>(scene.materials.size());
    scene.materials.push_back(material);
}

/// Two walls that meet at one corner, beyond which a crack of half a hundredth of a pixel opens.
TEST(DrawnSeams, LieOnUnderlaysWithoutCracks) {
    for (const DrawingStyle style : {DrawingStyle::flat, DrawingStyle::shaded}) {
        Scene scene;
        add_wall(scene, 0, 2, 0.5);
        const double crack = 0.005 / per_unit;
        add_polygon(scene.geometry, {{-2, -2, 0}, {2, -2, 0}, {2, -crack, 0}, {-2, 0, 0}});
        add_polygon(scene.geometry, {{-2, -2, 0}, {-2, 2, 0}, {-2.5, 0, 0}});
        number_primitives(scene);
        DrawSettings settings;
        settings.style = style;
        const Drawing drawing = draw_scene(scene, camera_from_the_front(), {}, settings).drawing;
        ASSERT_EQ(drawing.fills.front().id, "underlay");
        const DrawingPoint in_crack = {400, 256.002};
        EXPECT_NE(
            testing::turns_about(testing::flattened_rings(drawing.fills.front()), in_crack), 0);
    }
}

TEST(DrawnSeams, GoOnAlongTheOtherSideOfAThinNeighbour) {
    // A post of less than two pixels, painted last: what is white is below it and on its right, and
    // its border there comes near to the corner on the left, where black begins.
    constexpr double wide = 1.9;
    Scene scene;
    const double right = wide / per_unit;
    add_polygon(
        scene.geometry,
        {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {right, 2, 0}, {right, 0, 0}, {0, 0, 0}, {-2, 0, 0}});
    scene.geometry.items.back().material = static_cast<MaterialId>(0);
    scene.materials.emplace_back().sdi = {0.9, 0.9, 0.9};
    add_rectangle(scene, {-2, 0, 0}, {0, 2, 0}, 0.1);
    add_rectangle(scene, {0, 0, 0}, {right, 2, 0}, 0.5);
    number_primitives(scene);
    Drawing drawing = draw_scene(scene, camera_from_the_front(), {}, {}).drawing;
    ASSERT_EQ(drawing.fills.size(), 4U);
    ASSERT_EQ(drawing.fills.front().id, "underlay");
    drawing.fills.erase(drawing.fills.begin());
    drawing.fills.pop_back();
    for (const double up : {3.0, 20.0, 150.0}) {
        const auto color = testing::painted_color(drawing.fills, {256 + wide - 0.5, 256 - up});
        ASSERT_TRUE(color) << up;
        EXPECT_GT(color->g, 0.6) << up;
    }
}

TEST(DrawnSeams, EndAtCornersAsFarFromTheOneBorderAsFromTheOther) {
    // White below, black on the left, and grey, painted last, in the corner between them: black
    // that goes on below all of a strip of grey comes through where grey's edge along white is
    // smoothed.
    for (const DrawingStyle style : {DrawingStyle::flat, DrawingStyle::shaded}) {
        Scene scene;
        add_rectangle(scene, {-2, -2, 0}, {2, 0, 0}, 0.9);
        add_rectangle(scene, {-2, 0, 0}, {0, 2, 0}, 0.1);
        add_rectangle(scene, {0, 0, 0}, {2, 2, 0}, 0.5);
        number_primitives(scene);
        DrawSettings settings;
        settings.style = style;
        Drawing drawing = draw_scene(scene, camera_from_the_front(), {}, settings).drawing;
        ASSERT_EQ(drawing.fills.size(), 4U);
        ASSERT_EQ(drawing.fills.front().id, "underlay");
        drawing.fills.erase(drawing.fills.begin());
        drawing.fills.pop_back();
        const auto below = [&](double right, double up) {
            const auto color = testing::painted_color(drawing.fills, {256 + right, 256 - up});
            return color ? color->g : -1;
        };
        for (const double far : {0.2, 0.5, 0.9}) {
            EXPECT_GT(below(far, 0.05), 0.6) << far;
            EXPECT_GT(below(far, far - 0.05), 0.6) << far;
            EXPECT_NEAR(below(0.05, far), 0.1, 0.05) << far;
            EXPECT_NEAR(below(far - 0.05, far), 0.1, 0.05) << far;
        }
    }
}

TEST(DrawnSeams, OfAHairDoNotComeOutOnItsOtherSide) {
    // A hair of a third of a pixel along the border of what is painted later and has many corners:
    // half of a line along that border would stand before the background.
    Scene scene;
    const double width = 0.3 / per_unit;
    add_wall(scene, -width, 0, 0.1);
    std::vector<Vec3> corners = {{-2, 0, 0}, {2, 0, 0}};
    for (int i = 0; i < 20; ++i)
        corners.push_back({2 - 0.2 * i, 1 + 0.1 * (i % 2), 0});
    add_polygon(scene.geometry, corners);
    Material light;
    light.sdi = {0.9, 0.9, 0.9};
    scene.geometry.items.back().material = static_cast<MaterialId>(scene.materials.size());
    scene.materials.push_back(light);
    number_primitives(scene);
    const Drawing drawing = draw_scene(scene, camera_from_the_front(), {}, {}).drawing;
    ASSERT_EQ(drawing.fills.size(), 3U);
    ASSERT_EQ(drawing.fills[0].id, "underlay");
    EXPECT_TRUE(drawing.fills[1].seams.empty());
    EXPECT_TRUE(goes_below(drawing, 1, 0.6));
    EXPECT_FALSE(goes_below(drawing, 1, -0.4));
}

/// So many leaves of a pixel or two before a floor of which as many crumbs are in their shadow.
std::size_t corners_of_leaves_and_shadows(int leaves) {
    std::mt19937 random(4);
    const auto between = [&](double least, double most) {
        return least + (most - least) * static_cast<double>(random() % 4096) / 4096;
    };
    Scene scene;
    Material material;
    material.drf = {0.8, 0.8, 0.8};
    scene.materials.push_back(material);
    for (int i = 0; i < leaves; ++i) {
        const double x = between(-2.5, 2.5);
        const double y = between(-2.5, 2.5);
        const double z = between(0.5, 1);
        add_polygon(scene.geometry, {{x, y, z}, {x + 0.03, y, z}, {x, y + 0.03, z + 0.01}});
    }
    add_polygon(scene.geometry, {{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}});
    for (Item& item : scene.geometry.items)
        item.material = MaterialId{0};
    scene.lights = {{.position = {4, 3, 8}}};
    number_primitives(scene);
    const Drawing drawing = draw_scene(scene, camera_from_the_front(), {}, {}).drawing;
    std::size_t corners = 0;
    for (const FilledOutline& fill : drawing.fills)
        for (const auto& ring : testing::flattened_rings(fill))
            corners += ring.size();
    return corners;
}

TEST(DrawnSeams, OfLeavesBeforeTheirShadowsDoNotHoldAllShadowsEach) {
    EXPECT_LT(corners_of_leaves_and_shadows(1600), 3 * corners_of_leaves_and_shadows(800));
}

/// The inner half of a ring, which is convex nowhere, of quarter circles about the axis.
RotationalShape inner_half_of_ring(Vec3 axis, double radius, double r) {
    RotationalShape shape;
    shape.axis = normalized(axis);
    shape.start = {radius, r};
    const auto arc_to = [&](ContourPiece::Point control, ContourPiece::Point end) {
        ContourPiece piece;
        piece.kind = ContourPiece::Kind::conic;
        piece.control[0] = control;
        piece.weight = std::sqrt(0.5);
        piece.end = end;
        shape.contour.push_back(piece);
    };
    arc_to({radius - r, r}, {radius - r, 0});
    arc_to({radius - r, -r}, {radius, -r});
    return shape;
}

/// In style shaded, of one light and no shadows, the underlays apart.
struct ShadedFills {
    std::vector<FilledOutline> underlays;
    std::vector<FilledOutline> faces;
};

ShadedFills shaded_fills(Scene& scene) {
    number_primitives(scene);
    PointLight light;
    light.position = {5, 8, 9};
    light.falloff = Falloff::none;
    light.intensity = 1;
    scene.lights.push_back(light);
    PictureSettings picture;
    picture.ambient = {0.2, 0.2, 0.2};
    picture.shadows = false;
    DrawSettings settings;
    settings.style = DrawingStyle::shaded;
    settings.deviation = 0.5;
    ShadedFills fills;
    for (const FilledOutline& fill :
         draw_scene(scene, camera_from_the_front(), picture, settings).drawing.fills)
        (fill.id == "underlay" ? fills.underlays : fills.faces).push_back(fill);
    return fills;
}

TEST(DrawnSeams, OfPiecesThatAreShadedFacetByFacetHaveTheirColorBelowRoughly) {
    Scene scene;
    add(scene.geometry, inner_half_of_ring({0.3, 1, 0.8}, 1.5, 0.6));
    const ShadedFills fills = shaded_fills(scene);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(0, 512);
    int compared = 0;
    double off = 0;
    for (int i = 0; i < 1000; ++i) {
        DrawingPoint at;
        at.x = any(random);
        at.y = any(random);
        const auto below = testing::painted_color(fills.underlays, at);
        const auto shown = testing::painted_color(fills.faces, at);
        ASSERT_EQ(below.has_value(), shown.has_value()) << at.x << ' ' << at.y;
        if (below) {
            ++compared;
            off += std::abs(below->g - shown->g);
        }
    }
    EXPECT_GT(compared, 150);
    EXPECT_LT(off / compared, 8.0 / 255);
}

TEST(DrawnSeams, OfShadedThingsBesideEachOtherShowNothingOfTheBackground) {
    // A hair of an own between two walls, and one that touches nothing.
    Scene scene;
    const double width = 0.3 / per_unit;
    add_wall(scene, width, 1, 0.5);
    add_wall(scene, -1, 0, 0.1);
    add_wall(scene, 0, width, 0.9);
    add_wall(scene, 2, 2.5, 0.9);
    const ShadedFills fills = shaded_fills(scene);
    ASSERT_FALSE(fills.underlays.empty());
    ASSERT_EQ(fills.faces.size(), 4U);
    for (const double height : {-80.0, -0.1, 0.1, 0.2, 0.4, 80.0}) {
        const DrawingPoint at = {256.3, 256 - height};
        EXPECT_TRUE(testing::painted_color(fills.underlays, at)) << height;
    }
    // One region in one colour lets nothing through, and its silhouette stays sharp.
    EXPECT_FALSE(testing::painted_color(fills.underlays, {256.3, 256 - 2.2 * per_unit}));
}

TEST(DrawnSeams, OfTwoShadedThingsBesideEachOtherLieOnAnUnderlay) {
    Scene scene;
    add_wall(scene, -1, 0, 0.1);
    add_wall(scene, 0, 1, 0.9);
    const ShadedFills fills = shaded_fills(scene);
    ASSERT_EQ(fills.faces.size(), 2U);
    for (const double across : {-0.9, 0.0, 0.9})
        EXPECT_TRUE(testing::painted_color(fills.underlays, {256 + across * per_unit, 256.3}));
}

} // namespace
} // namespace vera
