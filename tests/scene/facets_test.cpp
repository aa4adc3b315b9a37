// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/math/elementary.h"
#include "vera/scene/facets.h"
#include "vera/scene/surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "scene/make_scene.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::add;
using test::add_polygon;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Deviation everywhere(double deviation) {
    return [deviation](Vec3) { return deviation; };
}

Facets facets_of(Scene& scene, double deviation = 0.01) {
    number_primitives(scene);
    return facets(scene, everywhere(deviation));
}

Vec3 doubled_area(const Facets& facets, const Facets::Triangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    return cross(facets.corners[b] - facets.corners[a], facets.corners[c] - facets.corners[a]);
}

std::vector<Vec3> all_corners(const Facets& facets) {
    std::vector<Vec3> all;
    for (std::size_t i = 0; i < facets.corners.size(); ++i)
        all.push_back(facets.corners[i]);
    return all;
}

std::array<Vec3, 3> corners_of(const Facets& facets, std::size_t triangle) {
    const auto& [a, b, c] = facets.triangles[triangle].corners;
    return {facets.corners[a], facets.corners[b], facets.corners[c]};
}

SubsceneCall call_of(std::uint32_t subscene, const Affine3& map) {
    return {SubsceneId{subscene}, map, *inverse(map)};
}

const std::array<Vec3, 3> triangle_corners = {Vec3{0.1, 0, 1}, Vec3{1, 0, 1}, Vec3{0, 1, 1}};

TEST(Facets, OfNothingAreNone) {
    Scene scene;
    const Facets none = facets_of(scene);
    EXPECT_EQ(none.corners.size(), 0U);
    EXPECT_TRUE(none.triangles.empty());
}

/// Few positions, of which several faces have each.
Mesh some_mesh(std::mt19937& random) {
    Mesh mesh;
    std::uint32_t next = 0; // the position that no face has had
    const std::size_t corners = 3 * (1 + random() % 6);
    for (std::size_t i = 0; i < corners; ++i) {
        // Now and then one is left out.
        const std::uint32_t position = static_cast<std::uint32_t>(random() % (next + 1));
        mesh.position_indices.push_back(random() % 40 == 0 ? position + 1 : position);
        next = std::max(next, mesh.position_indices.back() + 1);
    }
    for (std::uint32_t i = 0; i < next; ++i) {
        const double x = random() % 3 == 0 ? -0.0 : i;
        mesh.positions.push_back({x, static_cast<double>(random() % 3), 1});
    }
    return mesh;
}

TEST(Facets, ThatShareTheCornersOfAMeshAreTheSame) {
    std::size_t in_order = 0;
    std::size_t others = 0;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        Scene scene;
        const std::size_t meshes = 1 + seed % 8 / 7;
        for (std::size_t i = 0; i < meshes; ++i)
            add(scene.geometry, some_mesh(random));
        number_primitives(scene);
        const Facets copied = facets(scene, everywhere(0.01));
        const Facets shared = facets(scene, everywhere(0.01), nullptr, MeshCorners::shared);
        ASSERT_EQ(shared.corners.size(), copied.corners.size()) << seed;
        ASSERT_EQ(shared.triangles.size(), copied.triangles.size()) << seed;
        for (std::size_t i = 0; i < copied.corners.size(); ++i) {
            const Vec3 a = shared.corners[i];
            const Vec3 b = copied.corners[i];
            EXPECT_EQ(a, b) << seed;
            EXPECT_EQ(std::signbit(a.x), std::signbit(b.x)) << seed;
        }
        for (std::size_t i = 0; i < copied.triangles.size(); ++i)
            EXPECT_EQ(shared.triangles[i].corners, copied.triangles[i].corners) << seed;
        ++(shared.corners.capacity() == 0 ? in_order : others);
    }
    EXPECT_GT(in_order, 50U);
    EXPECT_GT(others, 20U);
}

TEST(Facets, OfATriangleAreItsCornersTurnedToTheOutside) {
    for (const auto& [outside, z] :
         {std::pair{Outside::by_normal, 1.0},
          std::pair{Outside::along_normal, 1.0},
          std::pair{Outside::against_normal, -1.0}}) {
        Scene scene;
        add(scene.geometry, Triangle{triangle_corners});
        scene.geometry.items[0].outside = outside;
        const Facets one = facets_of(scene);
        ASSERT_EQ(one.triangles.size(), 1U);
        EXPECT_EQ(normalized(doubled_area(one, one.triangles[0])), (Vec3{0, 0, z}));
        EXPECT_THAT(
            all_corners(one),
            ElementsAre(triangle_corners[0], triangle_corners[1], triangle_corners[2]));
    }
}

TEST(Facets, OfAPatchFaceTheSideOfTheNormalInItsMiddle) {
    for (const double side : {1.0, -1.0}) {
        Scene scene;
        Patch patch;
        patch.corners = triangle_corners;
        patch.normals = {Vec3{0, 0, -side}, Vec3{1, 0, side}, Vec3{0, 1, side}};
        add(scene.geometry, patch);
        Mesh mesh;
        mesh.positions.assign(triangle_corners.begin(), triangle_corners.end());
        mesh.position_indices = {0, 1, 2};
        mesh.normals = {{1, 0, side}, {0, 1, side}, {0, 0, -side}};
        mesh.normal_indices = {2, 1, 0};
        add(scene.geometry, mesh);
        const Facets two = facets_of(scene);
        ASSERT_EQ(two.triangles.size(), 2U);
        for (const auto& triangle : two.triangles)
            EXPECT_EQ(normalized(doubled_area(two, triangle)), (Vec3{0, 0, side}));
    }
}

TEST(Facets, OfASplitQuadrangleAreItsPieces) {
    Scene scene;
    add_polygon(
        scene.geometry,
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}},
        Polygon::Shape::split_quadrangle);
    const Facets two = facets_of(scene);
    ASSERT_EQ(two.triangles.size(), 2U);
    EXPECT_EQ(two.corners.size(), 4U);
    EXPECT_THAT(two.triangles[0].corners, ElementsAre(0, 1, 2));
    EXPECT_THAT(two.triangles[1].corners, ElementsAre(0, 2, 3));
    EXPECT_EQ(two.triangles[0].piece, 0U);
    EXPECT_EQ(two.triangles[1].piece, 1U);
    EXPECT_EQ(two.triangles[1].primitive, 0U);
}

TEST(Facets, CoverAPolygonOfManyCorners) {
    std::vector<Vec3> star;
    for (int i = 0; i < 144; ++i) {
        const double reach = i % 2 == 0 ? 2 : 1;
        star.push_back({reach * cos_degrees(2.5 * i), reach * sin_degrees(2.5 * i), 3});
    }
    for (const Outside outside : {Outside::by_normal, Outside::against_normal}) {
        Scene scene;
        add_polygon(scene.geometry, star, Polygon::Shape::simple);
        scene.geometry.items[0].outside = outside;
        const Facets all = facets_of(scene);
        EXPECT_EQ(all.triangles.size(), 142U);
        EXPECT_EQ(all_corners(all), star);
        const double side = outside == Outside::by_normal ? 1 : -1;
        double doubled = 0;
        for (const auto& triangle : all.triangles) {
            const Vec3 area = doubled_area(all, triangle);
            EXPECT_GT(side * area.z, 0);
            doubled += side * area.z;
        }
        // 144 triangles from the middle, with sides 1 and 2.
        EXPECT_NEAR(doubled, 144 * 2 * sin_degrees(2.5), 1e-12);
    }
}

TEST(Facets, OfAMeshShareTheCornersThatAreUsed) {
    Scene scene;
    Mesh mesh;
    mesh.positions = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {-0.0, 1, 0}, {0, 0, 1}};
    mesh.position_indices = {1, 3, 2, 1, 2, 4};
    add(scene.geometry, Sphere{{0, 0, 0}, 1e-3});
    add(scene.geometry, mesh);
    const Facets all = facets_of(scene, 1);
    const std::size_t n = all.triangles.size();
    const auto& first = all.triangles[n - 2];
    const auto& second = all.triangles[n - 1];
    EXPECT_EQ(first.primitive, 1U);
    EXPECT_EQ(second.primitive, 2U);
    EXPECT_EQ(first.corners[0], second.corners[0]);
    EXPECT_EQ(first.corners[2], second.corners[1]);
    EXPECT_EQ(all.corners.size() - first.corners[0], 4U);
    EXPECT_FALSE(std::signbit(all.corners[first.corners[1]].x)) << "one zero is like the other";
}

TEST(Facets, AreCarriedThroughCallsAndNumberedAsTheyAreHit) {
    Scene scene;
    scene.materials.resize(4);
    scene.subscenes.resize(3); // the last one is empty
    add(scene.subscenes[0], Triangle{triangle_corners});
    add(scene.subscenes[0], Sphere{{0, 0, 5}, 1});
    scene.subscenes[0].items[1].material = MaterialId{3};
    Affine3 mirror = scaling(2);
    mirror.linear.rows[0].x = -2;
    mirror.translation = {10, 0, 0};
    add(scene.subscenes[1], call_of(0, mirror));
    add(scene.subscenes[1], Mesh{});
    add(scene.subscenes[1], Triangle{triangle_corners});
    scene.subscenes[1].items[0].material = MaterialId{2};
    add(scene.geometry, call_of(2, {}));
    add(scene.geometry, call_of(1, rotation({30, 40, 50})));
    add(scene.geometry, call_of(1, translation({0, 0, 7})));
    scene.geometry.items[2].material = MaterialId{1};
    const Facets all = facets_of(scene, 0.1);

    std::set<std::uint64_t> numbers;
    for (std::size_t i = 0; i < all.triangles.size(); ++i) {
        const auto& triangle = all.triangles[i];
        numbers.insert(triangle.primitive);
        const PrimitivePath path = path_to(scene, triangle.primitive);
        EXPECT_EQ(triangle.material, path.material);
        const Vec3 normal = normalized(doubled_area(all, triangle));
        if (path.geometry->items[path.element.item].kind == ItemKind::sphere) {
            const Vec3 center = transformed_point(path.to_world, {0, 0, 5});
            for (const Vec3& corner : corners_of(all, i))
                EXPECT_NEAR(length(corner - center), 2, 1e-14);
            EXPECT_GT(dot(normal, corners_of(all, i)[0] - center), 0);
        } else {
            const Vec3 carried =
                normalized(transposed_times(path.from_world.linear, Vec3{0, 0, 1}));
            EXPECT_NEAR(dot(normal, carried), 1, 1e-14);
            // The first corner stays the first one.
            EXPECT_EQ(corners_of(all, i)[0], transformed_point(path.to_world, triangle_corners[0]));
        }
    }
    EXPECT_EQ(numbers.size(), scene.geometry.primitive_count);
    EXPECT_EQ(*numbers.rbegin() + 1, scene.geometry.primitive_count);
}

TEST(Facets, AreFinerWhereACallMakesThemLarger) {
    const auto count = [](const Affine3& map, double deviation) {
        Scene scene;
        scene.subscenes.resize(1);
        add(scene.subscenes[0], Sphere{});
        add(scene.geometry, call_of(0, map));
        return facets_of(scene, deviation).triangles.size();
    };
    const std::size_t usual = count({}, 0.01);
    EXPECT_EQ(count(composed(rotation({10, 20, 30}), scaling(100)), 1), usual);
    EXPECT_GT(count(scaling(100), 0.01), 50 * usual);
}

TEST(Facets, GoThroughTenThousandCalls) {
    Scene scene;
    constexpr std::uint32_t levels = 10000;
    scene.subscenes.resize(levels + 1);
    add(scene.subscenes[0], Triangle{triangle_corners});
    for (std::uint32_t level = 0; level < levels; ++level) {
        Geometry& geometry = level + 1 == levels ? scene.geometry : scene.subscenes[level + 1];
        add(geometry, call_of(level, translation({1, 0, 0})));
        // Of what is empty, 2^10000 calls are as many as none.
        add(geometry, call_of(level == 0 ? levels : level, translation({0, 1e-9, 0})));
        if (level > 0)
            geometry.calls.back().subscene = SubsceneId{levels};
        add(geometry, Triangle{triangle_corners});
    }
    for (int i = 0; i < 2; ++i)
        add(scene.subscenes[levels], Mesh{});
    const Facets all = facets_of(scene);
    ASSERT_EQ(all.triangles.size(), levels + 1);
    EXPECT_EQ(corners_of(all, 0)[1], (Vec3{levels + 1, 0, 1}));
    EXPECT_EQ(corners_of(all, levels)[1], triangle_corners[1]);
    EXPECT_EQ(all.triangles[levels].primitive, levels);
}

TEST(Facets, LeaveOutWhatIsCalledAndEmptyWithoutGoingThere) {
    Scene scene;
    constexpr std::uint32_t levels = 100;
    scene.subscenes.resize(levels);
    for (std::uint32_t level = 1; level < levels; ++level)
        for (int i = 0; i < 2; ++i)
            add(scene.subscenes[level], call_of(level - 1, {}));
    add(scene.geometry, call_of(levels - 1, {}));
    EXPECT_TRUE(facets_of(scene).triangles.empty());
}

TEST(Facets, RefuseWhatTheyCannotNumber) {
    Scene scene;
    constexpr std::uint32_t levels = 40;
    scene.files = {"many.vera"};
    scene.subscenes.resize(levels);
    add(scene.subscenes[0], Triangle{triangle_corners});
    for (std::uint32_t level = 1; level < levels; ++level)
        for (int i = 0; i < 2; ++i)
            add(scene.subscenes[level], call_of(level - 1, {}));
    add(scene.geometry, call_of(levels - 1, {}));
    try {
        facets_of(scene);
        FAIL() << "was not refused";
    } catch (const InputError& error) {
        ASSERT_EQ(error.diagnostics().size(), 1U);
        EXPECT_EQ(error.diagnostics()[0].place.file, "many.vera");
        EXPECT_THAT(error.diagnostics()[0].problem, HasSubstr("2147483648 plane faces"));
        EXPECT_THAT(error.diagnostics()[0].remedy, HasSubstr("less often"));
    }
}

TEST(Facets, CanBeCancelled) {
    Scene scene;
    add(scene.geometry, Triangle{triangle_corners});
    number_primitives(scene);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(facets(scene, everywhere(1), &cancel), Cancelled);
}

} // namespace
} // namespace vera
