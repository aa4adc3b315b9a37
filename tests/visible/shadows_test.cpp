// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/scene/surface.h"
#include "vera/visible/closed_bodies.h"
#include "vera/visible/map_locator.h"
#include "vera/visible/shadows.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "visible/cameras.h"
#include "visible/drawn_shadows.h"
#include "visible/map_turns.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::drawn_shadows;
using testing::DrawnShadows;
using testing::region_at;
using testing::scene_of_planes;

constexpr std::uint64_t nothing = ~std::uint64_t{0};

/// What a ray through the picture tells of the place that it meets.
struct LitAt {
    std::uint64_t primitive = nothing;
    LightSet faces = 0; ///< the lights that the viewer's side of the face is turned to
    LightSet unlit = 0; ///< those of them that do not reach it

    friend bool operator==(const LitAt&, const LitAt&) = default;
};

LitAt lit_at(const Scene& scene, const RayIndex& index, const Camera& camera, double x, double y) {
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
int compare_shadows(const Scene& scene, const Camera& camera, std::uint64_t seed, double off) {
    const DrawnShadows drawn = drawn_shadows(scene, camera);
    const bool is_cut = drawn.screen.cut_nearness > 0 || drawn.counts.cut_nearness > 0;
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
        const auto turns = testing::turns_about(drawn.map, x * screen_size, y * screen_size);
        EXPECT_EQ(turns.size(), 1U) << what;
        if (turns.size() != 1)
            continue;
        const VisibleMap::Region region = drawn.map.regions[turns.begin()->first];
        const std::uint32_t facet = drawn.faces.first_facet[region.source];
        EXPECT_EQ(drawn.facets.triangles[facet].primitive, expected->primitive) << what;
        EXPECT_EQ(region.unlit & expected->faces, expected->unlit) << what;
    }
    return compared;
}

TEST(Shadows, AreWhereRaysTowardsLightsMeetSomething) {
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 12 && !HasFailure(); ++seed)
        compared += compare_shadows(
            scene_of_planes(seed), testing::camera_number(static_cast<int>(seed)), seed, 1e-5);
    EXPECT_GT(compared, 400);
}

TEST(Shadows, AreTheSameToTheBitInAnyPowerOfTwoOfTheSize) {
    std::size_t shadows = 0;
    for (std::uint64_t seed = 0; seed < 8; ++seed)
        for (const double scale : {0.125, 64.0}) {
            const Camera camera = testing::camera_number(static_cast<int>(seed));
            Camera other = camera;
            for (Vec3* of :
                 {&other.viewpoint, &other.lower_left, &other.lower_right, &other.upper_left})
                *of = scale * *of;
            const DrawnShadows expected = drawn_shadows(scene_of_planes(seed), camera);
            const DrawnShadows found = drawn_shadows(scene_of_planes(seed, scale), other);
            EXPECT_EQ(expected.counts.shadows, found.counts.shadows) << seed;
            EXPECT_TRUE(expected.map.vertices == found.map.vertices) << seed;
            EXPECT_TRUE(expected.map.regions == found.map.regions) << seed;
            EXPECT_EQ(expected.map.ring_vertices, found.map.ring_vertices) << seed;
            EXPECT_EQ(expected.map.ring_across, found.map.ring_across) << seed;
            shadows += expected.counts.shadows;
        }
    EXPECT_GT(shadows, 1000U);
}

TEST(Shadows, AreTheSameWhenThePictureIsMirroredOrTurnedButForAFewSteps) {
    // Coordinates of corners are rounded to the grid, which is a matter of where they lie.
    constexpr double reach = 8; // steps
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        const Scene scene = scene_of_planes(seed);
        const Camera camera = testing::camera_number(static_cast<int>(seed));
        const Vec3 across = camera.lower_right - camera.lower_left;
        Camera mirrored = camera;
        mirrored.lower_left = camera.lower_right;
        mirrored.lower_right = camera.lower_left;
        mirrored.upper_left = camera.upper_left + across;
        Camera turned = mirrored; // a quarter
        turned.lower_right = mirrored.upper_left;
        turned.upper_left = mirrored.lower_right;
        const DrawnShadows expected = drawn_shadows(scene, camera);
        const DrawnShadows of_mirrored = drawn_shadows(scene, mirrored);
        const DrawnShadows of_turned = drawn_shadows(scene, turned);
        const MapLocator locator(expected.map);
        std::mt19937_64 random(seed);
        for (int i = 0; i < 300; ++i) {
            const double x = std::uniform_real_distribution(0.0, double{screen_size})(random);
            const double y = std::uniform_real_distribution(0.0, double{screen_size})(random);
            const auto here = region_at(expected.map, x, y);
            if (locator.has_side_near(x, y, reach, reach) || !here)
                continue;
            ++compared;
            EXPECT_EQ(region_at(of_mirrored.map, screen_size - x, y), here) << seed;
            EXPECT_EQ(region_at(of_turned.map, screen_size - y, x), here) << seed;
        }
    }
    EXPECT_GT(compared, 1000);
}

/// The area of the picture, as a part of it, where the light does not reach the face.
double unlit_area(const DrawnShadows& drawn, std::uint32_t face, std::uint32_t light) {
    double area = 0;
    for (const VisibleMap::Ring& ring : drawn.map.rings)
        if (ring.source == face && (drawn.map.regions[ring.region].unlit >> light & 1U) != 0)
            area += 0.5 * doubled_area(drawn.map, ring);
    return area / std::ldexp(1.0, 2 * screen_bits);
}

Mesh box_mesh(Vec3 corner, Vec3 size) {
    Mesh mesh;
    for (unsigned i = 0; i < 8; ++i)
        mesh.positions.push_back(
            corner + Vec3{(i & 1U) * size.x, (i >> 1U & 1U) * size.y, (i >> 2U) * size.z});
    mesh.position_indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                             2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return mesh;
}

void add_mesh(Scene& scene, Mesh mesh) {
    Item item;
    item.kind = ItemKind::mesh;
    item.index = static_cast<std::uint32_t>(scene.geometry.meshes.size());
    item.material = MaterialId{0};
    scene.geometry.meshes.push_back(std::move(mesh));
    scene.geometry.items.push_back(item);
    number_primitives(scene);
}

/// Tetrahedra and boxes that touch each other and pass through each other and through faces, some
/// turned inside out; lights and viewers are outside most of them.
Scene scene_of_bodies(std::uint64_t seed) {
    Scene scene = scene_of_planes(seed);
    std::mt19937_64 random(seed);
    const auto some = [&] { return 0.5 * static_cast<double>(random() % 9) - 2; };
    for (int i = 0; i < 5; ++i) {
        std::array<Vec3, 4> points;
        for (Vec3& point : points)
            point = {some(), some(), some()};
        if (i % 2 == 0) {
            Mesh mesh;
            mesh.positions.assign(points.begin(), points.end());
            mesh.position_indices = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
            add_mesh(scene, std::move(mesh));
        } else {
            const Vec3 size = max(points[1], -points[1]) + Vec3{0.5, 0.5, 0.5};
            add_mesh(scene, box_mesh(points[0], size));
        }
    }
    return scene;
}

TEST(Shadows, OfClosedBodiesAreWhereRaysTowardsLightsMeetSomething) {
    int compared = 0;
    std::size_t bodies = 0;
    for (std::uint64_t seed = 0; seed < 8 && !HasFailure(); ++seed) {
        const Scene scene = scene_of_bodies(seed);
        bodies += closed_bodies(facets(scene, [](Vec3) { return 1.0; })).boxes.size();
        compared +=
            compare_shadows(scene, testing::camera_number(static_cast<int>(seed)), seed, 1e-5);
    }
    EXPECT_GT(bodies, 30U);
    EXPECT_GT(compared, 300);
}

TEST(Shadows, AreEverywhereWithinAClosedBody) {
    for (const bool is_inside_out : {false, true}) {
        Scene scene;
        scene.materials.emplace_back();
        Mesh mesh = box_mesh({-9, -8, -7}, {19, 17, 15});
        for (std::size_t i = 0; i < mesh.position_indices.size() && is_inside_out; i += 3)
            std::swap(mesh.position_indices[i], mesh.position_indices[i + 1]);
        add_mesh(scene, std::move(mesh));
        scene.lights = {{.position = {20.3, 31.7, 10.9}}};
        for (int i = 0; i < 3; ++i)
            EXPECT_GT(compare_shadows(scene, testing::camera_number(i), 0, 1e-5), 150);
    }
}

/// Slabs made of small tiles over a floor to the horizon, and a sun
/// so far away that its view has steps larger than the tiles.
Scene tiles_over_far_floor(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Scene scene;
    scene.materials.emplace_back();
    const auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
        Item item;
        item.kind = ItemKind::triangle;
        item.index = static_cast<std::uint32_t>(scene.geometry.triangles.size());
        item.material = MaterialId{0};
        scene.geometry.triangles.push_back({{a, b, c}});
        scene.geometry.items.push_back(item);
    };
    constexpr double far = 2e5;
    add({-far, 0, -far}, {-far, 0, far}, {far, 0, far});
    add({-far, 0, -far}, {far, 0, far}, {far, 0, -far});
    for (int slab = 0; slab < 2; ++slab) {
        constexpr int tiles = 24;
        constexpr double size = 0.1;
        const auto some = [&](unsigned values) { return static_cast<double>(random() % values); };
        const Vec3 corner = {some(4) - 3, 0.5 + some(3) / 2, some(4) - 3};
        for (int i = 0; i < tiles; ++i)
            for (int j = 0; j < tiles; ++j) {
                const auto at = [&](int x, int z) {
                    return corner + Vec3{size * (i + x), 0, size * (j + z)};
                };
                add(at(0, 0), at(0, 1), at(1, 1));
                add(at(0, 0), at(1, 1), at(1, 0));
            }
    }
    number_primitives(scene);
    scene.lights = {{.position = {3e6, 4e6, 1e6}}, {.position = {-1.1e7, 2.3e7, 0.7e7}}};
    return scene;
}

Camera over_far_floor() {
    Camera camera;
    camera.viewpoint = {0, 4, 12};
    camera.lower_left = {-3, 1.5, 8};
    camera.lower_right = {3, 1.5, 8};
    camera.upper_left = {-3, 5, 8};
    return camera;
}

TEST(Shadows, OfSmallThingsAreWholeOnAFloorToTheHorizon) {
    const Camera camera = over_far_floor();
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 3 && !HasFailure(); ++seed) {
        const Scene scene = tiles_over_far_floor(seed);
        compared += compare_shadows(scene, camera, seed, 1e-5);
        const DrawnShadows drawn = drawn_shadows(scene, camera);
        EXPECT_EQ(drawn.counts.light_step, 0);
        EXPECT_GT(unlit_area(drawn, 0, 0) + unlit_area(drawn, 1, 0), 0.001);
    }
    EXPECT_GT(compared, 300);
}

/// A floor seen from above by parallel rays, from -4 to 4, and a square over it.
Scene square_over_floor(double half, double height) {
    Scene scene;
    scene.materials.emplace_back();
    for (const auto& [size, y] : {std::pair{4.0, 0.0}, {half, height}}) {
        Polygon polygon;
        polygon.first_corner = static_cast<std::uint32_t>(scene.geometry.corners.size());
        polygon.corner_count = 4;
        polygon.normal = {0, 1, 0};
        for (const auto& [x, z] : {std::pair{-1, -1}, {-1, 1}, {1, 1}, {1, -1}})
            scene.geometry.corners.push_back({size * x, y, size * z});
        Item item;
        item.kind = ItemKind::polygon;
        item.index = static_cast<std::uint32_t>(scene.geometry.polygons.size());
        item.material = MaterialId{0};
        scene.geometry.polygons.push_back(polygon);
        scene.geometry.items.push_back(item);
    }
    number_primitives(scene);
    return scene;
}

Camera from_above() {
    Camera camera;
    camera.projection = Camera::Projection::parallel;
    camera.direction = {0, -1, 0};
    camera.lower_left = {-4, 5, 4};
    camera.lower_right = {4, 5, 4};
    camera.upper_left = {-4, 5, -4};
    return camera;
}

TEST(Shadows, OfASquareIsTwiceAsLargeFromTwiceItsHeight) {
    Scene scene = square_over_floor(1, 1);
    scene.lights = {{.position = {0, 2, 0}}, {.position = {-3, 2, 0}}};
    const DrawnShadows drawn = drawn_shadows(scene, from_above());
    // 4 x 4 of 8 x 8, less the square itself, which hides the middle of it.
    EXPECT_NEAR(unlit_area(drawn, 0, 0), 12.0 / 64, 1e-12);
    // From -1 - 3 + 2 * (x + 3) on: 1 to 5, of which the picture shows 3 x 4 beside the square.
    EXPECT_NEAR(unlit_area(drawn, 0, 1), 12.0 / 64, 1e-12);
    EXPECT_EQ(unlit_area(drawn, 1, 0), 0);
}

TEST(Shadows, OfTheSunFallAsFromParallelLight) {
    Scene scene = square_over_floor(1, 1);
    scene.lights = {{.position = {1e11, 2e11, 0}}};
    const DrawnShadows drawn = drawn_shadows(scene, from_above());
    // Half a unit of it looks out from below the square.
    EXPECT_NEAR(unlit_area(drawn, 0, 0), 1.0 / 64, 1e-6);
    EXPECT_EQ(drawn.counts.light_step, 0);
}

TEST(Shadows, AreNotLostForWhatIsFarBehind) {
    Scene scene = square_over_floor(1, 1);
    // Through all that the light sees, from nearby to a million units away.
    scene.geometry.triangles.push_back(
        {{Vec3{-1e6, -1e3, -1e6}, {1e6, -1e3, -1e6}, {0, -2e5, 1e6}}});
    Item item;
    item.kind = ItemKind::triangle;
    item.material = MaterialId{0};
    scene.geometry.items.push_back(item);
    number_primitives(scene);
    scene.lights = {{.position = {0, 2, 0}}};
    const DrawnShadows drawn = drawn_shadows(scene, from_above());
    EXPECT_NEAR(unlit_area(drawn, 0, 0), 12.0 / 64, 1e-6);
    EXPECT_EQ(drawn.counts.cut_nearness, 0);
}

TEST(Shadows, FallFromWhatStandsOnAFaceWithoutACrumbBetween) {
    Scene scene = square_over_floor(1, 0.7);
    // A wall from the floor up to the square.
    scene.geometry.triangles.push_back({{Vec3{-1, 0, 1}, {1, 0, 1}, {1, 0.7, 1}}});
    Item item;
    item.kind = ItemKind::triangle;
    item.material = MaterialId{0};
    scene.geometry.items.push_back(item);
    number_primitives(scene);
    scene.lights = {{.position = {0.3, 2.1, 3.3}}};
    const DrawnShadows drawn = drawn_shadows(scene, from_above());
    // The floor, one shadow on it, and the square.
    EXPECT_EQ(drawn.map.regions.size(), 3U);
    EXPECT_EQ(drawn.counts.cut_nearness, 0);
}

TEST(Shadows, AreNotThrownByWhatLetsLightThrough) {
    Scene scene = square_over_floor(1, 1);
    scene.materials[0].tab = {0.5, 0, 0};
    scene.lights = {{.position = {0, 2, 0}}};
    const DrawnShadows drawn = drawn_shadows(scene, from_above());
    EXPECT_EQ(drawn.counts.shadows, 0U);
    EXPECT_EQ(unlit_area(drawn, 0, 0), 0);
}

} // namespace
} // namespace vera
