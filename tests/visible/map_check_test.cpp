// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/accel/wide_bvh.h"
#include "vera/visible/brute_force.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/map_check.h"
#include "vera/visible/map_locator.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "accel/random_scene.h"
#include "visible/cameras.h"
#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

std::vector<ScreenScene> scenes() {
    std::vector<ScreenScene> result;
    for (std::uint64_t seed = 0; seed < 60; ++seed)
        result.push_back(testing::layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4)));
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        result.push_back(testing::scattered(seed, 300, screen_size >> seed));
        result.push_back(testing::terrain(seed, 4 << (seed % 3)));
    }
    result.emplace_back();
    return result;
}

VisibleMap map_of(const ScreenScene& scene) {
    return visible_map(scene, cell_raster(scene));
}

/// In half steps, where one in two lies on few rows and columns, on which corners lie as well.
std::int64_t half_steps(std::mt19937_64& random) {
    const std::uint64_t whole = 2 * std::uint64_t{screen_size};
    return static_cast<std::int64_t>(
        random() % 2 == 0 ? random() % whole : random() % 32 * (whole / 32));
}

TEST(MapLocator, FindsWhatAskingEveryTriangleTells) {
    std::mt19937_64 random(1);
    int compared = 0;
    for (const ScreenScene& scene : scenes()) {
        const MapLocator locator(map_of(scene));
        for (int i = 0; i < 200; ++i) {
            const std::int64_t x = half_steps(random);
            const std::int64_t y = half_steps(random);
            const SeenAt expected = seen_at(scene, x, y);
            const MapPlace found =
                locator.at(static_cast<double>(x) / 2, static_cast<double>(y) / 2);
            EXPECT_TRUE(found.is_sound) << x << " " << y;
            if (expected.has_side_at)
                continue;
            ++compared;
            ASSERT_EQ(found.source, expected.source) << x << " " << y;
        }
    }
    EXPECT_GT(compared, 5000);
}

/// By all rings, and not by the shortest way to a side but by many places on it.
bool has_side_near(
    const VisibleMap& map, double x, double y, double reach_x, double reach_y, double slack) {
    for (const VisibleMap::Ring& ring : map.rings) {
        const auto vertices = map.vertices_of(ring);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const RationalPoint& a = map.vertices[vertices[i]];
            const RationalPoint& b = map.vertices[vertices[(i + 1) % vertices.size()]];
            constexpr int parts = 2000;
            for (int part = 0; part <= parts; ++part) {
                const double at = static_cast<double>(part) / parts;
                const double off_x = (a.x() + at * (b.x() - a.x()) - x) / reach_x;
                const double off_y = (a.y() + at * (b.y() - a.y()) - y) / reach_y;
                if (std::hypot(off_x, off_y) <= slack)
                    return true;
            }
        }
    }
    return false;
}

TEST(MapLocator, TellsWhetherASideIsNear) {
    std::mt19937_64 random(2);
    const double reach_x = screen_size / 40.0;
    const double reach_y = screen_size / 60.0;
    int near = 0;
    int far = 0;
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        const VisibleMap map = map_of(testing::layers(seed, 1 + seed % 6, 8));
        const MapLocator locator(map);
        for (int i = 0; i < 20; ++i) {
            const double x = static_cast<double>(half_steps(random)) / 2;
            const double y = static_cast<double>(half_steps(random)) / 2;
            const bool found = locator.has_side_near(x, y, reach_x, reach_y);
            // The places on a side are up to a fiftieth of the reach from each other.
            if (has_side_near(map, x, y, reach_x, reach_y, 0.999)) {
                EXPECT_TRUE(found) << seed << " " << x << " " << y;
                ++near;
            } else if (!has_side_near(map, x, y, reach_x, reach_y, 1.02)) {
                EXPECT_FALSE(found) << seed << " " << x << " " << y;
                ++far;
            }
        }
    }
    EXPECT_GT(near, 50);
    EXPECT_GT(far, 50);
}

/// A scene with the map that a drawing of it is made from.
struct Drawn {
    Scene scene;
    Camera camera;
    std::unique_ptr<RayIndex> index;
    VisibleMap map;
    std::vector<std::uint64_t> primitives;
    double cut_nearness = 0;

    MapCheck check(std::size_t points) const {
        return check_map(
            {map, primitives, cut_nearness}, scene, camera, *index, {points, 512, 512, 0.5});
    }
};

Drawn drawn_scene(int number) {
    constexpr double deviation = 0.5 / 512;
    Drawn drawn;
    testing::RandomSceneSettings settings;
    settings.items = 8 + static_cast<std::size_t>(number) % 3 * 6;
    drawn.scene = testing::random_scene(static_cast<std::uint64_t>(number), settings);
    drawn.camera = testing::camera_number(number);
    drawn.index = make_brute_force(drawn.scene);
    const CameraMap map(drawn.camera);
    const Facets all =
        facets(drawn.scene, [&](Vec3 point) { return deviation * map.size_of_pixel(1, 1, point); });
    const DrawnFaces faces = drawn_faces(drawn.scene, all, FaceUnit::plane, drawn.camera);
    ScreenScene screen = screen_scene(all, map, faces.of_facet);
    sort_by_place(screen);
    drawn.cut_nearness = screen.cut_nearness;
    drawn.map = visible_map(screen, whole_pieces(screen).pieces);
    for (const std::uint32_t facet : faces.first_facet)
        drawn.primitives.push_back(all.triangles[facet].primitive);
    return drawn;
}

TEST(MapCheck, FindsNothingWrongWithMapsOfRandomScenes) {
    std::size_t near = 0;
    std::size_t points = 0;
    for (int number = 0; number < 12; ++number) {
        const MapCheck check = drawn_scene(number).check(600);
        EXPECT_EQ(check.points, 600U);
        EXPECT_EQ(check.far, 0U) << "scene " << number;
        if (check.first_far)
            ADD_FAILURE() << check.first_far->x << " " << check.first_far->y << " shows "
                          << check.first_far->drawn << ", not " << check.first_far->traced;
        near += check.near;
        points += check.points;
    }
    EXPECT_LT(near, points / 100);
}

TEST(MapCheck, IsTheSameForAnyNumberOfThreads) {
    Drawn drawn = drawn_scene(2);
    drawn.map.rings.erase(drawn.map.rings.begin());
    const auto by_threads = [&](std::size_t threads) {
        const ThreadLimit limit(threads);
        return drawn.check(2000);
    };
    const MapCheck one = by_threads(1);
    ASSERT_TRUE(one.first_far);
    for (const std::size_t threads : {std::size_t{2}, std::size_t{7}}) {
        const MapCheck more = by_threads(threads);
        EXPECT_EQ(more.near, one.near);
        EXPECT_EQ(more.far, one.far);
        EXPECT_EQ(more.first_far->x, one.first_far->x);
        EXPECT_EQ(more.first_far->y, one.first_far->y);
    }
}

std::size_t largest_ring(const VisibleMap& map) {
    std::size_t largest = 0;
    for (std::size_t i = 0; i < map.rings.size(); ++i)
        if (doubled_area(map, map.rings[i]) > doubled_area(map, map.rings[largest]))
            largest = i;
    return largest;
}

TEST(MapCheck, FindsARingThatIsLost) {
    Drawn drawn = drawn_scene(1);
    const std::size_t largest = largest_ring(drawn.map);
    const std::uint64_t lost = drawn.primitives[drawn.map.rings[largest].source];
    drawn.map.rings.erase(drawn.map.rings.begin() + static_cast<std::ptrdiff_t>(largest));
    const MapCheck check = drawn.check(3000);
    EXPECT_GT(check.far, 0U);
    ASSERT_TRUE(check.first_far);
    EXPECT_EQ(check.first_far->drawn, no_primitive);
    EXPECT_EQ(check.first_far->traced, lost);
    EXPECT_TRUE(check.first_far->is_sound);
}

TEST(MapCheck, FindsARingOfAnotherFace) {
    Drawn drawn = drawn_scene(1);
    VisibleMap::Ring& ring = drawn.map.rings[largest_ring(drawn.map)];
    const std::uint64_t right = drawn.primitives[ring.source];
    drawn.primitives.push_back(right == 0 ? 1 : 0);
    ring.source = static_cast<std::uint32_t>(drawn.primitives.size() - 1);
    std::stable_sort(
        drawn.map.rings.begin(), drawn.map.rings.end(), [](const auto& a, const auto& b) {
            return a.source < b.source;
        });
    const MapCheck check = drawn.check(3000);
    EXPECT_GT(check.far, 0U);
    ASSERT_TRUE(check.first_far);
    EXPECT_EQ(check.first_far->drawn, drawn.primitives.back());
    EXPECT_EQ(check.first_far->traced, right);
}

TEST(MapCheck, FindsARingBeforeTheBackground) {
    Drawn drawn;
    drawn.scene.geometry.spheres.push_back({{1000, 0, 0}, 1}); // out of sight
    drawn.scene.geometry.items.emplace_back();
    number_primitives(drawn.scene);
    drawn.camera = testing::camera_number(1);
    drawn.index = make_brute_force(drawn.scene);
    drawn.primitives = {0};
    const ScreenPoint corner = {screen_size / 8, screen_size / 8};
    for (const ScreenPoint point :
         {ScreenPoint{0, 0}, {corner.x, 0}, corner, ScreenPoint{0, corner.y}}) {
        drawn.map.ring_vertices.push_back(static_cast<std::uint32_t>(drawn.map.vertices.size()));
        drawn.map.vertices.push_back(RationalPoint{point});
    }
    drawn.map.rings = {{0, 0, 0, 4}};
    const MapCheck check = drawn.check(1000);
    ASSERT_TRUE(check.first_far);
    EXPECT_EQ(check.first_far->drawn, 0U);
    EXPECT_EQ(check.first_far->traced, no_primitive);
    EXPECT_LE(check.first_far->x, 64);
    EXPECT_LE(check.first_far->y, 64);
    // A 64th of the picture.
    EXPECT_GT(check.far, 5U);
    EXPECT_LT(check.far, 30U);
}

/// A flat square of 2 * cells * cells triangles, at that height.
Mesh flat_square(std::uint32_t cells, double z) {
    Mesh mesh;
    for (std::uint32_t row = 0; row <= cells; ++row)
        for (std::uint32_t column = 0; column <= cells; ++column)
            mesh.positions.push_back({8.0 * column / cells - 4, 8.0 * row / cells - 4, z});
    for (std::uint32_t row = 0; row < cells; ++row)
        for (std::uint32_t column = 0; column < cells; ++column) {
            const std::uint32_t a = row * (cells + 1) + column;
            const std::uint32_t c = a + cells + 2;
            mesh.position_indices.insert(mesh.position_indices.end(), {a, a + 1, c, a, c, c - 1});
        }
    return mesh;
}

/// What is told where the lower of two flat squares is drawn, so far below the one that rays meet.
MapCheck check_of_squares(std::uint32_t cells, double below) {
    Scene scene;
    scene.geometry.meshes = {flat_square(cells, 0), flat_square(cells, -below)};
    scene.geometry.items = {
        {.kind = ItemKind::mesh, .index = 0}, {.kind = ItemKind::mesh, .index = 1}};
    number_primitives(scene);
    Camera camera;
    camera.projection = Camera::Projection::parallel;
    camera.direction = {0.3, 0.1, -1};
    camera.lower_left = {-1, -1, 5};
    camera.lower_right = {1, -1, 5};
    camera.upper_left = {-1, 1, 5};
    VisibleMap map;
    for (const ScreenPoint point :
         {ScreenPoint{0, 0}, {screen_size, 0}, {screen_size, screen_size}, {0, screen_size}}) {
        map.ring_vertices.push_back(static_cast<std::uint32_t>(map.vertices.size()));
        map.vertices.push_back(RationalPoint{point});
    }
    map.rings = {{1, 0, 0, 4}};
    const std::uint64_t count = 2 * std::uint64_t{cells} * cells;
    PrimitiveMap drawn = {map, {0, count}};
    for (const std::uint32_t source : {0U, 1U})
        for (std::uint64_t i = 1; i < count; ++i)
            drawn.joined.push_back({source, source * count + i});
    const auto index = make_wide_bvh(scene);
    return check_map(drawn, scene, camera, *index, {400, 512, 512, 0});
}

/// Each such place asked all triangles of the square before.
TEST(MapCheck, AsksFewTrianglesWhereHugeFlatMeshesAllButCoincide) {
    for (const double below : {0.0, 1e-13, 1e-9, 1.0}) {
        const MapCheck few = check_of_squares(2, below); // one by one
        const MapCheck many = check_of_squares(60, below);
        EXPECT_EQ(few.far > 0, below == 1) << below;
        EXPECT_GT(few.near + few.far, 300U) << below;
        EXPECT_EQ(many.near, few.near) << below;
        EXPECT_EQ(many.far, few.far) << below;
        EXPECT_GT(few.asked, 300U);
        EXPECT_LT(many.asked, 4 * 7200U) << below; // of 400 places: of some, near an edge, all
    }
}

TEST(MapCheck, FindsARingThatIsThereTwiceAndACornerThatHasMoved) {
    Drawn drawn = drawn_scene(1);
    const VisibleMap right = drawn.map;
    drawn.map.rings.push_back(drawn.map.rings[largest_ring(drawn.map)]);
    std::stable_sort(
        drawn.map.rings.begin(), drawn.map.rings.end(), [](const auto& a, const auto& b) {
            return a.source < b.source;
        });
    const MapCheck twice = drawn.check(3000);
    ASSERT_TRUE(twice.first_far);
    EXPECT_FALSE(twice.first_far->is_sound);
    EXPECT_EQ(twice.first_far->drawn, twice.first_far->traced);

    drawn.map = right;
    const std::size_t largest = largest_ring(right);
    // By twenty pixels: what is between the old and the new sides is shown wrongly.
    const std::uint32_t moved = right.ring_vertices[right.rings[largest].first];
    RationalPoint corner = drawn.map.vertices[moved];
    corner.whole.x += screen_size / 512 * (corner.whole.x > screen_size / 2 ? -20 : 20);
    drawn.map.vertices[moved] = corner;
    EXPECT_GT(drawn.check(30000).far, 0U);
}

} // namespace
} // namespace vera
