// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include "accel/random_scene.h"
#include "scene/make_scene.h"
#include "visible/cameras.h"
#include "visible/map_turns.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::camera_number;

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
        const DrawnFaces faces = drawn_faces(scene, all, FaceUnit::primitive, camera);
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
            EXPECT_EQ(all.triangles[faces.first_facet[face]].primitive, *expected) << what;
        }
    }
    EXPECT_GT(compared, 200);
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

// Near the corners of wide pictures, and where parallel rays meet the picture at a slant, it moves
// farther than in the middle.
TEST(CameraMap, TellsHowFarWhatMovesAPixelMoves) {
    Camera camera;
    camera.lower_left = {-2, -1, 0};
    camera.lower_right = {2, -1, 0};
    camera.upper_left = {-2, 1, 0};
    for (const bool is_parallel : {false, true}) {
        camera.projection =
            is_parallel ? Camera::Projection::parallel : Camera::Projection::perspective;
        camera.viewpoint = {0.5, 0.25, 1};
        camera.direction = {1, 0.5, -1};
        const CameraMap map(camera);
        double farthest = 0;
        for (const double x : {0.0, 0.25, 0.5, 1.0})
            for (const double y : {0.0, 0.5, 1.0})
                for (const double t : {0.25, 1.0, 40.0}) {
                    const Ray ray = view_ray(camera, x, y);
                    const Vec3 at = point_at(ray, t);
                    const double way = 1e-3 * map.size_of_pixel_around(80, 40, at);
                    const Vec3 across = normalized(cross(ray.direction, {0.3, 1, 0.2}));
                    for (int i = 0; i < 32; ++i) {
                        const Vec3 to = std::cos(i * 0.2) * across
                            + std::sin(i * 0.2) * cross(ray.direction, across);
                        const ImagePoint from = map.image_point(at);
                        const ImagePoint moved = map.image_point(at + way * to);
                        const double pixels = 1e3
                            * std::hypot(80 * (moved.x / moved.w - from.x / from.w),
                                         40 * (moved.y / moved.w - from.y / from.w));
                        EXPECT_LE(pixels, 1.01);
                        farthest = std::max(farthest, pixels);
                    }
                }
        EXPECT_GE(farthest, 0.98);
    }
}

/// A place of a facet, none of its corners.
Vec3 place_on(const Facets& facets, const Facets::Triangle& facet, double part, double other) {
    const Vec3 a = facets.corners[facet.corners[0]];
    const Vec3 b = facets.corners[facet.corners[1]];
    const Vec3 c = facets.corners[facet.corners[2]];
    return a + part * (b - a) + other * (1 - part) * (c - a);
}

TEST(DeviationInPixels, OfSurfacesRoundTheViewerIsKeptInThePictureWithFewFacetsBesideIt) {
    constexpr double pixels = 512;
    constexpr double deviation = 0.1;
    for (int number = 0; number < 8; ++number) {
        Camera camera = camera_number(number);
        camera.projection = Camera::Projection::perspective;
        const CameraMap map(camera);
        Scene scene;
        Sphere sphere;
        sphere.center = camera.viewpoint + Vec3{1, -2, 0.5};
        sphere.radius = 50;
        test::add(scene.geometry, sphere);
        number_primitives(scene);
        for (const FacetReach reach : {FacetReach::seen, FacetReach::throwing}) {
            const Facets all =
                facets(scene, deviation_in_pixels(map, pixels, pixels, deviation, reach));
            EXPECT_LT(all.triangles.size(), 110'000U) << number;
            int compared = 0;
            for (const Facets::Triangle& facet : all.triangles)
                for (const double part : {0.25, 0.5, 0.75}) {
                    const Vec3 at = place_on(all, facet, part, 0.5);
                    const ImagePoint p = map.image_point(at);
                    if (p.w <= 0 || p.x < 0 || p.x > p.w || p.y < 0 || p.y > p.w)
                        continue;
                    ++compared;
                    EXPECT_LE(
                        sphere.radius - length(at - sphere.center),
                        1.001 * deviation * map.size_of_pixel(pixels, pixels, at))
                        << number;
                }
            EXPECT_GT(compared, 100) << number;
        }
    }
}

/// Close to the wall of a large ball, whatever its first facets are: what bulges before the viewer
/// may belong to one of which all corners lie behind.
TEST(DeviationInPixels, OfASurfaceCloseBeforeTheViewerCountsWhereItsFacetLiesBehind) {
    constexpr double radius = 100;
    constexpr double before = radius - 1;
    for (const Vec3 along :
         {Vec3{0.98, 0.14, 0.14},
          Vec3{1, 0, 0},
          Vec3{1, 1, 0},
          Vec3{1, 1, 1},
          Vec3{0.9, 0.3, 0.1},
          Vec3{-0.3, 0.2, 0.7}}) {
        const Vec3 forward = normalized(along);
        const Vec3 across = normalized(cross(forward, {0.1, 0.9, -0.2}));
        const Vec3 up = cross(across, forward);
        Camera camera;
        camera.viewpoint = before * forward;
        const Vec3 middle = camera.viewpoint + 0.5 * forward;
        camera.lower_left = middle - across - up;
        camera.lower_right = middle + across - up;
        camera.upper_left = middle - across + up;
        const CameraMap map(camera);
        Scene scene;
        test::add(scene.geometry, Sphere{{}, radius});
        number_primitives(scene);
        const Facets all = facets(scene, deviation_in_pixels(map, 512, 512, 0.1, FacetReach::seen));
        double farthest = 0;
        for (std::size_t i = 0; i < all.corners.size(); ++i)
            farthest = std::max(farthest, dot(all.corners[i] - camera.viewpoint, forward));
        EXPECT_GT(farthest, 0.99) << "the wall is there";
    }
}

TEST(DeviationInPixels, BehindTheViewerCountsWhereShadowsAreThrown) {
    Camera camera;
    camera.viewpoint = {0, 0, 4};
    camera.lower_left = {-1, -1, 0};
    camera.lower_right = {1, -1, 0};
    camera.upper_left = {-1, 1, 0};
    const CameraMap map(camera);
    const auto count = [&](double distance, FacetReach reach) {
        Scene scene;
        test::add(scene.geometry, Sphere{{0, 0, 4 - distance}, 1});
        number_primitives(scene);
        const Deviation deviation = deviation_in_pixels(map, 512, 512, 0.1, reach);
        return static_cast<double>(facets(scene, deviation).triangles.size());
    };
    const double before = count(8, FacetReach::seen);
    EXPECT_EQ(count(8, FacetReach::throwing), before);
    EXPECT_LT(count(-8, FacetReach::seen), 50);
    EXPECT_GT(count(-8, FacetReach::throwing), 0.6 * before);
    EXPECT_LT(count(-8, FacetReach::throwing), 1.2 * before);
}

} // namespace
} // namespace vera
