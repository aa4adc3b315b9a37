// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/scene/surface.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"
#include "vera/visible/shadows.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include "accel/random_scene.h"
#include "visible/map_turns.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// Cameras all round a scene about the origin, some of parallel rays, some within it.
Camera camera_number(int number) {
    const Vec3 to = normalized(std::array<Vec3, 5>{
        {{1, 0.3, 0.2},
         {-0.2, 1, 0.4},
         {0.3, -0.2, 1},
         {-1, -0.7, 0.1},
         {0, 0, 1}}}[static_cast<std::size_t>(number) % 5]);
    const Vec3 across = normalized(cross(to, {0.1, 0.2, 1}));
    const Vec3 up = cross(across, to);
    const double distance = number % 3 == 0 ? 1 : 8;
    Camera camera;
    camera.projection =
        number % 4 == 3 ? Camera::Projection::parallel : Camera::Projection::perspective;
    camera.viewpoint = -distance * to;
    camera.direction = to;
    const double half = number % 4 == 3 ? 3 : 0.5 * distance;
    camera.lower_left = -half * across - half * up;
    camera.lower_right = half * across - half * up;
    camera.upper_left = -half * across + half * up;
    return camera;
}

constexpr std::uint64_t nothing = ~std::uint64_t{0};

std::uint64_t seen_by_ray(const RayIndex& index, const Camera& camera, double x, double y) {
    QueryRay query;
    query.ray = view_ray(camera, x, y);
    std::array<Hit, 1> hits;
    QueryCounts counts;
    index.nearest_hits(std::array{query}, hits, counts);
    return hits[0].found() ? hits[0].face.primitive : nothing;
}

/// What the ray sees and, if it is the same, those close around it.
std::optional<std::uint64_t>
seen_around(const RayIndex& index, const Camera& camera, double x, double y, double off) {
    const std::uint64_t middle = seen_by_ray(index, camera, x, y);
    for (const auto& [step_x, step_y] :
         {std::pair{off, off}, {-off, off}, {off, -off}, {-off, -off}})
        if (seen_by_ray(index, camera, x + step_x, y + step_y) != middle)
            return std::nullopt;
    return middle;
}

TEST(DrawingAgainstRays, TheSamePrimitivesAreSeenInRandomScenes) {
    constexpr double pixels = 512;
    constexpr double deviation = 0.5 / pixels;
    int compared = 0;
    for (int number = 0; number < 8 && !HasFailure(); ++number) {
        testing::RandomSceneSettings settings;
        settings.items = 8 + static_cast<std::size_t>(number) % 3 * 6;
        const Scene scene = testing::random_scene(static_cast<std::uint64_t>(number), settings);
        const Camera camera = camera_number(number);
        const CameraMap map(camera);
        const Facets all =
            facets(scene, [&](Vec3 point) { return deviation * map.size_of_pixel(1, 1, point); });
        const DrawnFaces faces = drawn_faces(scene, all, FaceUnit::primitive);
        ScreenScene screen = screen_scene(all, map, faces.of_facet);
        const double cut = screen.cut_nearness;
        sort_by_place(screen);
        const WholePieces whole = whole_pieces(screen);
        EXPECT_EQ(whole.left, 0U) << "scene " << number;
        const VisibleMap visible = visible_map(screen, whole.pieces);
        const auto index = make_brute_force(scene);
        std::mt19937_64 random(static_cast<std::uint64_t>(number));
        for (int i = 0; i < 100; ++i) {
            const double x = std::uniform_real_distribution(0.01, 0.99)(random);
            const double y = std::uniform_real_distribution(0.01, 0.99)(random);
            const auto expected = seen_around(*index, camera, x, y, 2 * deviation);
            if (!expected || cut > 0)
                continue;
            ++compared;
            const auto turns = testing::turns_about(visible, x * screen_size, y * screen_size);
            const std::string what = "scene " + std::to_string(number) + " at " + std::to_string(x)
                + " " + std::to_string(y);
            ASSERT_EQ(turns.size(), *expected == nothing ? 0U : 1U) << what;
            if (turns.empty())
                continue;
            EXPECT_EQ(turns.begin()->second, 1) << what;
            const std::uint32_t face = visible.regions[turns.begin()->first].source;
            EXPECT_EQ(all.triangles[faces.first_facet[face]].primitive, *expected)
                << what;
        }
    }
    EXPECT_GT(compared, 200);
}

/// What a ray through the picture tells of the place that it meets.
struct LitAt {
    std::uint64_t primitive = nothing;
    LightSet faces = 0; ///< the lights that the viewer's side of the face is turned to
    LightSet unlit = 0; ///< those of them that do not reach it

    friend bool operator==(const LitAt&, const LitAt&) = default;
};

LitAt lit_at(
    const Scene& scene, const RayIndex& index, const Camera& camera, double x, double y) {
    QueryRay query;
    query.ray = view_ray(camera, x, y);
    std::array<Hit, 1> hits;
    QueryCounts counts;
    index.nearest_hits(std::array{query}, hits, counts);
    if (!hits[0].found())
        return {};
    const SurfacePoint surface = surface_at(scene, query.ray, hits[0]);
    LitAt lit = {hits[0].face.primitive, 0, 0};
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Vec3 to_light = scene.lights[i].position - surface.point;
        if (dot(to_light, surface.geometric_normal)
                * dot(query.ray.direction, surface.geometric_normal)
            >= 0)
            continue;
        lit.faces |= LightSet{1} << i;
        QueryRay shadow;
        shadow.ray.origin = surface.point;
        shadow.ray.origin_error = surface.point_error;
        shadow.ray.direction = to_light;
        shadow.ray.t_max = 1;
        shadow.start = hits[0].face;
        std::array<Color, 1> transmitted;
        index.transmittances(std::array{shadow}, transmitted, counts);
        if (is_black(transmitted[0]))
            lit.unlit |= LightSet{1} << i;
    }
    return lit;
}

/// The same, if it is the same close around.
std::optional<LitAt> lit_around(
    const Scene& scene,
    const RayIndex& index,
    const Camera& camera,
    double x,
    double y,
    double off) {
    const LitAt middle = lit_at(scene, index, camera, x, y);
    for (const auto& [step_x, step_y] :
         {std::pair{off, off}, {-off, off}, {off, -off}, {-off, -off}})
        if (lit_at(scene, index, camera, x + step_x, y + step_y) != middle)
            return std::nullopt;
    return middle;
}

/// Compares shadows with rays at places that have the same around them, to both sides, for `off` of
/// the picture.
int compare_shadows(std::uint64_t seed, double off) {
    testing::RandomSceneSettings settings;
    settings.items = 4 + seed % 4 * 5;
    settings.curved = false;
    Scene scene = testing::random_scene(seed, settings);
    // None in the plane of a face, of which rays from there may see either side.
    scene.lights = {
        {.position = {5.1, 3.2, 9.3}},
        {.position = {0.31, -0.213, 0.737}},
        {.position = {-4.07, -4.11, 2.03}}};
    const Camera camera = camera_number(static_cast<int>(seed));
    const CameraMap map(camera);
    const Facets all = facets(scene, [](Vec3) { return 1.0; });
    const DrawnFaces faces = drawn_faces(scene, all, FaceUnit::plane);
    ScreenScene screen = screen_scene(all, map, faces.of_facet);
    const WholePieces whole = whole_pieces(screen);
    const ShadowCounts shadows =
        add_shadows({scene, all, faces, camera, map, whole.pieces}, screen);
    const bool is_cut = screen.cut_nearness > 0 || shadows.cut_nearness > 0;
    const VisibleMap visible = visible_map(screen, cell_raster(screen));
    const auto index = make_brute_force(scene);
    std::mt19937_64 random(seed);
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
        const double x = std::uniform_real_distribution(0.01, 0.99)(random);
        const double y = std::uniform_real_distribution(0.01, 0.99)(random);
        const auto expected = lit_around(scene, *index, camera, x, y, off);
        if (!expected || expected->primitive == nothing || is_cut)
            continue;
        ++compared;
        const std::string what =
            "scene " + std::to_string(seed) + " at " + std::to_string(x) + " " + std::to_string(y);
        const auto turns = testing::turns_about(visible, x * screen_size, y * screen_size);
        EXPECT_EQ(turns.size(), 1U) << what;
        if (turns.size() != 1)
            continue;
        const VisibleMap::Region region = visible.regions[turns.begin()->first];
        EXPECT_EQ(all.triangles[faces.first_facet[region.source]].primitive, expected->primitive)
            << what;
        EXPECT_EQ(region.unlit & expected->faces, expected->unlit) << what;
    }
    return compared;
}

TEST(DrawingAgainstRays, TheSameLightsReachWhatIsSeenOfPlaneFaces) {
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 12 && !HasFailure(); ++seed)
        compared += compare_shadows(seed, 1e-5);
    EXPECT_GT(compared, 400);
}

TEST(CameraMap, SeesThroughALongLensAndNothingBehind) {
    Camera camera;
    camera.viewpoint = {1e8, 1.3e8, 0.7e8};
    const Vec3 to = normalized(-camera.viewpoint);
    const Vec3 across = normalized(cross(to, {0, 0, 1}));
    const Vec3 up = cross(across, to);
    camera.lower_left = -across - up;
    camera.lower_right = across - up;
    camera.upper_left = up - across;
    const CameraMap map(camera);
    const ImagePoint middle = map.image_point({0, 0, 0});
    EXPECT_NEAR(middle.x / middle.w, 0.5, 1e-6);
    EXPECT_NEAR(middle.y / middle.w, 0.5, 1e-6);
    EXPECT_NEAR(middle.w, 1, 1e-6);
    EXPECT_NEAR(map.size_of_pixel(100, 50, {0, 0, 0}), 0.02, 1e-6);
    EXPECT_TRUE(std::isinf(map.size_of_pixel(100, 50, 2 * camera.viewpoint)));
}

} // namespace
} // namespace vera
