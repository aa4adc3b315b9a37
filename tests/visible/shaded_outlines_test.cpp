// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/shade/firmament.h"
#include "vera/shade/lighting.h"
#include "vera/visible/draw_scene.h"
#include "vera/visible/projection.h"
#include "vera/visible/shaded_outlines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "accel/random_scene.h"
#include "visible/painted_color.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double tolerance = 1.0 / 255;

Camera camera_number(int number) {
    const Vec3 to = normalized(std::array<Vec3, 4>{
        {{1, -0.3, 0.2},
         {-0.2, -1, 0.4},
         {0.3, 0.2, 1},
         {-1, -0.7, 0.1}}}[static_cast<std::size_t>(number % 4)]);
    const Vec3 across = normalized(cross(to, {0.1, 1, 0.2}));
    const Vec3 up = cross(across, to);
    Camera camera;
    camera.projection =
        number % 3 == 2 ? Camera::Projection::parallel : Camera::Projection::perspective;
    camera.viewpoint = -8 * to;
    camera.direction = to;
    const double half = number % 3 == 2 ? 3 : 4;
    camera.lower_left = -half * across - half * up;
    camera.lower_right = half * across - half * up;
    camera.upper_left = -half * across + half * up;
    return camera;
}

/// Lights and materials drawn from few values: in the planes of faces, behind them, without
/// falloff; with highlights as wide as can be.
void light_scene(Scene& scene, std::mt19937& random) {
    const double places[] = {-6, -2, 0, 1, 4};
    const double parts[] = {0, 0.2, 0.5};
    const auto place = [&] { return places[random() % std::size(places)]; };
    const auto part = [&] { return parts[random() % std::size(parts)]; };
    for (int i = 0; i < 3; ++i) {
        PointLight light;
        light.position = {place(), place() + 0.5, place()};
        light.falloff = i == 0 ? Falloff::none : Falloff::inverse_square;
        light.intensity = i == 0 ? 0.5 : 20;
        light.color = {1, 0.5 + part(), 0.5 + part()};
        scene.lights.push_back(light);
    }
    for (Material& material : scene.materials) {
        material.drf = {part(), part(), 0.3};
        material.san = {part(), 0, 0};
        material.spc = std::array{1.0, 0.9, 0.3}[random() % 3];
    }
}

/// The picture that rays see, without mirrors, glass and shadows.
class Rays {
public:
    Rays(const Scene& scene, const Camera& camera, const PictureSettings& picture)
        : scene_(scene)
        , camera_(camera)
        , picture_(picture)
        , index_(make_brute_force(scene)) {}

    Hit hit(DrawingPoint at) const {
        QueryRay query;
        query.ray = view_ray(camera_, at.x / picture_.width, at.y / picture_.height);
        std::array<Hit, 1> hits;
        QueryCounts counts;
        index_->nearest_hits(std::array{query}, hits, counts);
        return hits[0];
    }

    Color color(DrawingPoint at, const Hit& hit) const {
        const Ray ray = view_ray(camera_, at.x / picture_.width, at.y / picture_.height);
        if (!hit.found())
            return clamped(firmament_color(picture_.firmament, ray.direction));
        const SurfacePoint surface = surface_at(scene_, ray, hit);
        const Incidence incident = incidence(surface, ray.direction);
        const Material& material = material_of(scene_, surface.material);
        LocalTerms terms = unlit(incident, material, picture_.ambient);
        for (const PointLight& light : scene_.lights)
            terms += unshadowed(incident, material, light);
        return clamped(sum(terms));
    }

private:
    const Scene& scene_;
    const Camera& camera_;
    const PictureSettings& picture_;
    std::unique_ptr<RayIndex> index_;
};

double difference(Color a, Color b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

constexpr DrawingPoint corners_about[] = {{1, 1}, {-1, 1}, {1, -1}, {-1, -1}};

/// By how much the rays' colours change within so many pixels, or nothing where they see other
/// things there.
std::optional<double> slack_at(const Rays& rays, DrawingPoint at, const Hit& hit, double within) {
    double slack = 0;
    const Color middle = rays.color(at, hit);
    for (const DrawingPoint way : corners_about) {
        const DrawingPoint beside = {at.x + within * way.x, at.y + within * way.y};
        const Hit other = rays.hit(beside);
        if (other.face != hit.face)
            return std::nullopt;
        slack = std::max(slack, difference(rays.color(beside, other), middle));
    }
    return slack;
}

TEST(ShadedDrawing, ShowsWhatRaysSee) {
    int compared = 0;
    int off = 0;
    double worst = 0;
    for (int number = 0; number < 6; ++number) {
        std::mt19937 random(static_cast<std::uint32_t>(number));
        testing::RandomSceneSettings settings;
        settings.items = 5 + static_cast<std::size_t>(number) % 3 * 4;
        Scene scene = testing::random_scene(static_cast<std::uint64_t>(number), settings);
        light_scene(scene, random);
        const Camera camera = camera_number(number);
        PictureSettings picture;
        picture.width = picture.height = 120;
        picture.shadows = false; // where these are, another test tells
        picture.ambient = {0.2, 0.2, 0.25};
        picture.firmament = Firmament{{0.2, 0.3, 0.8}, {0.9, 0.8, 0.7}, {0.3, 0.4, 0.1}};
        DrawSettings draw;
        draw.style = DrawingStyle::shaded;
        const DrawnScene drawn = draw_scene(scene, camera, picture, draw);
        ASSERT_TRUE(drawn.drawing.background);
        const Color background = {
            drawn.drawing.background->r / 255.0,
            drawn.drawing.background->g / 255.0,
            drawn.drawing.background->b / 255.0};
        const Rays rays(scene, camera, picture);
        for (int i = 0; i < 150; ++i) {
            const DrawingPoint at = {
                std::uniform_real_distribution(1.0, 119.0)(random),
                std::uniform_real_distribution(1.0, 119.0)(random)};
            const Hit hit = rays.hit(at);
            const auto slack = slack_at(rays, at, hit, draw.deviation);
            if (!slack || drawn.penetrating > 0 || drawn.cut_nearness > 0)
                continue;
            ++compared;
            const Color shown =
                testing::painted_color(drawn.drawing.fills, at).value_or(background);
            const double error = difference(shown, rays.color(at, hit)) - *slack;
            worst = std::max(worst, error);
            off += error > 1.001 * tolerance ? 1 : 0;
            EXPECT_LT(error, 4 * tolerance) << "scene " << number << " at " << at.x << ' ' << at.y;
        }
    }
    EXPECT_GT(compared, 400);
    // Between the samples, and where fits end at the size of a pixel, colours may be off by more.
    EXPECT_LT(off, compared / 100) << "at worst by " << 255 * worst;
}

/// A face seen from straight above, with a light near to it.
struct LitWall {
    Scene scene;
    Camera camera;
    PictureSettings picture;
    Facets all;
};

LitWall lit_wall(std::mt19937& random) {
    const auto in = [&](double from, double to) {
        return std::uniform_real_distribution(from, to)(random);
    };
    LitWall wall;
    wall.camera = camera_number(static_cast<int>(random() % 8));
    wall.picture.width = wall.picture.height = 200;
    wall.picture.ambient = {0.1, 0.1, 0.1};
    const Vec3 at = {in(-0.5, 0.5), in(-0.5, 0.5), in(-0.5, 0.5)};
    Triangle triangle;
    for (Vec3& corner : triangle.corners)
        corner = at + Vec3{in(-2, 2), in(-2, 2), in(-2, 2)};
    Material material;
    material.drf = {0.7, 0.5, 0.3};
    material.arf = {0.1, 0.2, 0};
    material.spc = random() % 2 == 0 ? 1 : 0.8;
    wall.scene.materials = {material};
    wall.scene.geometry.triangles = {triangle};
    Item item;
    item.kind = ItemKind::triangle;
    item.material = MaterialId{0};
    wall.scene.geometry.items = {item};
    number_primitives(wall.scene);
    const Vec3 normal = normalized(cross(
        triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]));
    for (int i = 0; i < 2; ++i) {
        PointLight light;
        // One after the other: which argument a compiler takes first is its own choice.
        const bool is_before = random() % 2 == 0;
        const double away = in(0.3, 4);
        light.position = at + away * (is_before ? normal : -normal);
        light.intensity = 6;
        light.color = {1, in(0.5, 1), in(0.5, 1)};
        wall.scene.lights.push_back(light);
    }
    wall.all = facets(wall.scene, [](Vec3) { return 1.0; });
    return wall;
}

/// To the lines along the sides of a triangle, in pixels.
double distance_to_border(DrawingPoint point, const BorderRing& corners) {
    double least = 1e9;
    for (std::size_t i = 0; i < 3; ++i) {
        const DrawingPoint a = corners[i];
        const DrawingPoint b = corners[(i + 1) % 3];
        const double across = (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
        least = std::min(least, std::abs(across) / std::hypot(b.x - a.x, b.y - a.y));
    }
    return least;
}

TEST(ShadedOutlines, AreWithinTheToleranceOnRandomFacesInRandomLight) {
    std::mt19937 random(7);
    int compared = 0;
    int beyond = 0; // all that the light is within a tenth of a pixel
    int inner = 0;
    int off = 0;
    double worst = 0;
    for (int round = 0; round < 40; ++round) {
        const LitWall wall = lit_wall(random);
        const CameraMap map(wall.camera);
        BorderRing corners;
        for (std::size_t i = 0; i < wall.all.corners.size(); ++i) {
            const ImagePoint seen = map.image_point(wall.all.corners[i]);
            corners.push_back({200 * seen.x / seen.w, 200 - 200 * seen.y / seen.w});
        }
        LitOutline lit;
        lit.region.rings = {corners};
        // Without one of the lights now and then.
        lit.lights = round % 3 == 0 ? LightSet{1} : all_lights;
        const RegionLight light(wall.scene, wall.camera, wall.picture, wall.all, 0, lit.lights);
        const auto fills =
            shaded_outlines({lit}, {wall.scene, wall.camera, wall.picture, wall.all, {}});
        for (int i = 0; i < 300; ++i) {
            // Anywhere in the triangle.
            double u = std::uniform_real_distribution(0.0, 1.0)(random);
            double v = std::uniform_real_distribution(0.0, 1.0)(random);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            const DrawingPoint at = {
                corners[0].x + u * (corners[1].x - corners[0].x)
                    + v * (corners[2].x - corners[0].x),
                corners[0].y + u * (corners[1].y - corners[0].y)
                    + v * (corners[2].y - corners[0].y)};
            const auto shown = testing::painted_color(fills, at);
            ASSERT_TRUE(shown) << "round " << round;
            double slack = 0;
            for (const DrawingPoint way : corners_about)
                slack = std::max(
                    slack, difference(light({at.x + 0.1 * way.x, at.y + 0.1 * way.y}), light(at)));
            const double error = difference(*shown, light(at));
            ++compared;
            beyond += error - slack > 1.001 * tolerance ? 1 : 0;
            if (distance_to_border(at, corners) < 1.5)
                continue;
            ++inner;
            worst = std::max(worst, error);
            off += error > 1.001 * tolerance ? 1 : 0;
        }
    }
    // Seen from the side, where a pixel is much of a face, most are.
    EXPECT_LT(worst, 3 * tolerance);
    EXPECT_LE(beyond, compared / 4000);
    EXPECT_LE(off, inner / 200) << "at worst by " << 255 * worst;
}

TEST(RegionLight, LeavesOutTheLightsThatDoNotReachIt) {
    std::mt19937 random(8);
    LitWall wall = lit_wall(random);
    const RegionLight none(wall.scene, wall.camera, wall.picture, wall.all, 0, LightSet{0});
    const RegionLight second(wall.scene, wall.camera, wall.picture, wall.all, 0, LightSet{2});
    Scene dark = wall.scene;
    dark.lights.clear();
    Scene one = wall.scene;
    one.lights.erase(one.lights.begin());
    const RegionLight in_dark(dark, wall.camera, wall.picture, wall.all, 0);
    const RegionLight with_one(one, wall.camera, wall.picture, wall.all, 0);
    const Vec3 middle =
        (1.0 / 3) * (wall.all.corners[0] + wall.all.corners[1] + wall.all.corners[2]);
    const ImagePoint seen = CameraMap(wall.camera).image_point(middle);
    const DrawingPoint at = {200 * seen.x / seen.w, 200 - 200 * seen.y / seen.w};
    EXPECT_EQ(none(at), in_dark(at));
    EXPECT_EQ(second(at), with_one(at));
    EXPECT_TRUE(contains(LightSet{0}, 32));
}

class ShapedFirmament : public ::testing::TestWithParam<std::optional<HorizonProfile>> {};

TEST_P(ShapedFirmament, IsWithinTheToleranceAboveTheHorizonAndBelow) {
    PictureSettings picture;
    picture.width = 160;
    picture.height = 120;
    picture.firmament = Firmament{{0.1, 0.3, 0.9}, {0.9, 0.8, 0.6}, {0.3, 0.4, 0.1}, GetParam()};
    int earth = 0;
    for (int number = 0; number < 12; ++number) {
        Camera camera = camera_number(number);
        if (number >= 8) { // up and down, and along the horizon
            camera.projection = Camera::Projection::perspective;
            camera.viewpoint = {0, number == 9 ? -3.0 : number == 10 ? 3.0 : 0.0, 0};
            camera.lower_left = {-4, -3, -4};
            camera.lower_right = {4, -3, -4};
            camera.upper_left = {-4, 3, -4};
        }
        if (number == 11) { // straight up
            camera.lower_left = {-4, 4, 4};
            camera.lower_right = {4, 4, 4};
            camera.upper_left = {-4, 4, -4};
        }
        const DrawnFirmament drawn = drawn_firmament(camera, picture, {});
        for (int i = 0; i < 400; ++i) {
            const DrawingPoint at = {i % 20 * 8 + 3.7, i / 20 * 6.0 + 2.9};
            const Color background = {
                drawn.background.r / 255.0, drawn.background.g / 255.0, drawn.background.b / 255.0};
            const Color shown = testing::painted_color(drawn.sky, at).value_or(background);
            const Vec3 direction = view_ray(camera, at.x / 160, at.y / 120).direction;
            earth += is_earth(*picture.firmament, direction) ? 1 : 0;
            ASSERT_LT(
                difference(shown, firmament_color(picture.firmament, direction)), 2 * tolerance)
                << "camera " << number << " at " << at.x << ' ' << at.y;
        }
    }
    EXPECT_GT(earth, 100);
    EXPECT_LT(earth, 4780);
}

std::string profile_name(const ::testing::TestParamInfo<ShapedFirmament::ParamType>& profile) {
    constexpr const char* names[] = {
        "None", "Flat", "Peaks", "Gorges", "PeaksAndGorges", "Mountains"};
    return names[profile.index];
}

// Also steep peaks and gorges, which are seen from below and from above all round.
INSTANTIATE_TEST_SUITE_P(
    Profiles,
    ShapedFirmament,
    ::testing::Values(
        std::nullopt,
        HorizonProfile({{0, 0}, {90, 0}, {180, 0}, {270, 0}}),
        HorizonProfile({{0, 60}, {120, 60}, {240, 40}}),
        HorizonProfile({{-30, -70}, {90, -80}, {210, -60}}),
        HorizonProfile(
            {{-90, 10}, {-45, -30}, {-20, 45}, {0, 0}, {10, 60}, {45, -20}, {100, 70}, {180, 0}}),
        HorizonProfile(Mountains{3, 25, 0.8})),
    profile_name);

TEST(DrawnFirmament, IsTheBackgroundAloneWhereItIsOfOneColor) {
    PictureSettings picture;
    EXPECT_EQ(drawn_firmament(camera_number(0), picture, {}).background, DrawingColor());
    picture.firmament = Firmament{{0.2, 0.4, 0.6}, {0.2, 0.4, 0.6}, {0, 0, 0}};
    const DrawnFirmament parallel = drawn_firmament(camera_number(2), picture, {});
    EXPECT_TRUE(parallel.sky.empty());
    const DrawingColor sky = {51, 102, 153};
    EXPECT_EQ(parallel.background, sky);
}

TEST(ShadedDrawing, DoesNotDependOnThreads) {
    testing::RandomSceneSettings settings;
    settings.items = 20; // of hundreds of facets

    Scene scene = testing::random_scene(5, settings);
    std::mt19937 random(5);
    light_scene(scene, random);
    PictureSettings picture;
    picture.width = picture.height = 60;
    DrawSettings draw;
    draw.style = DrawingStyle::shaded;
    const auto drawn = [&](std::size_t threads) {
        const ThreadLimit limit(threads);
        return draw_scene(scene, camera_number(0), picture, draw).drawing.fills;
    };
    const auto one = drawn(1);
    EXPECT_TRUE(std::ranges::any_of(
        one, [](const FilledOutline& outline) { return outline.id == "underlay"; }));
    for (const std::size_t threads : {2U, 7U}) {
        const auto more = drawn(threads);
        ASSERT_EQ(more.size(), one.size());
        for (std::size_t i = 0; i < one.size(); ++i) {
            ASSERT_EQ(more[i].rings, one[i].rings) << i;
            ASSERT_EQ(more[i].arcs, one[i].arcs) << i;
            ASSERT_EQ(more[i].gradient, one[i].gradient) << i;
            ASSERT_EQ(more[i].color, one[i].color) << i;
        }
    }
}

} // namespace
} // namespace vera
