// SPDX-License-Identifier: Apache-2.0
#include <iterator>
#include <limits>
#include <random>

#include "scene/make_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::crossings;

constexpr double infinity = std::numeric_limits<double>::infinity();

class FewValues {
public:
    explicit FewValues(unsigned seed)
        : random_(seed) {}

    Vec3 point() { return {coordinate(), coordinate(), coordinate()}; }

    double coordinate() {
        constexpr double values[] = {-2, -1, -0.5, -0.1, 0, 0, 0.1, 0.3, 0.5, 1, 2};
        return values[random_() % std::size(values)];
    }

private:
    std::mt19937 random_;
};

/// The surface of the cube from 0 to 1, as triangles, polygons and a mesh, after a map that rounds.
struct Cubes {
    Geometry triangles;
    Geometry polygons;
    Geometry mesh;
};

Cubes cubes(const Affine3& map) {
    constexpr int faces[6][4] = {
        {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    Cubes result;
    Mesh mesh;
    for (unsigned i = 0; i < 8; ++i)
        mesh.positions.push_back(transformed_point(map, corner({{0, 0, 0}, {1, 1, 1}}, i)));
    for (const auto& face : faces) {
        const auto at = [&](int i) { return mesh.positions[static_cast<std::size_t>(face[i])]; };
        test::add(result.triangles, Triangle{{at(0), at(1), at(2)}});
        test::add(result.triangles, Triangle{{at(0), at(2), at(3)}});
        test::add_polygon(result.polygons, {at(0), at(1), at(2), at(3)});
        for (const int i : {0, 1, 2, 0, 2, 3})
            mesh.position_indices.push_back(static_cast<std::uint32_t>(face[i]));
    }
    test::add(result.mesh, mesh);
    return result;
}

std::size_t faces_met(const Geometry& geometry, const Ray& ray) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < geometry.items.size(); ++i) {
        const auto triangles = static_cast<std::uint32_t>(
            geometry.meshes.empty() ? 1 : geometry.meshes[0].triangle_count());
        for (std::uint32_t triangle = 0; triangle < triangles; ++triangle)
            count += crossings(geometry, ray, i, no_piece, triangle).size();
    }
    return count;
}

TEST(PlaneFaces, LetNoRayOutThroughTheirCommonEdges) {
    FewValues few(1988);
    for (int round = 0; round < 1000; ++round) {
        const Affine3 map = composed(
            translation(few.point()),
            composed(rotation(360 * few.point()), scaling(round % 3 == 0 ? 1 : 0.3)));
        const Cubes cube = cubes(map);
        // From the middle of the cube through its corners and edges.
        const auto part = [&] {
            return 0.5 * static_cast<double>(round % 2 + 1) * few.coordinate();
        };
        const Vec3 middle = transformed_point(map, {0.5, 0.5, 0.5});
        for (const Vec3 aim :
             {Vec3{0, 0, 0}, Vec3{1, 0, 1}, Vec3{0, part(), 1}, Vec3{part(), 1, 1}}) {
            const Vec3 target = transformed_point(map, aim);
            if (target == middle)
                continue;
            const Ray ray = {middle, target - middle};
            for (const Geometry* geometry : {&cube.triangles, &cube.polygons, &cube.mesh})
                ASSERT_GE(faces_met(*geometry, ray), 1U) << "round " << round;
        }
    }
}

TEST(PlaneFaces, AreNotMetAgainFromTheirOwnPlane) {
    FewValues few(7);
    for (int round = 0; round < 20000; ++round) {
        const Triangle triangle = {{few.point(), few.point(), few.point()}};
        const Vec3& a = triangle.corners[0];
        const Vec3 ab = triangle.corners[1] - a;
        const Vec3 ac = triangle.corners[2] - a;
        if (cross(ab, ac) == Vec3{})
            continue;
        Geometry geometry;
        test::add(geometry, triangle);
        test::add_polygon(geometry, {a, triangle.corners[1], triangle.corners[2]});
        const Vec3 origin = a + few.coordinate() * ab + few.coordinate() * ac;
        const Vec3 direction = few.point();
        for (const std::uint32_t item : {0U, 1U})
            ASSERT_TRUE(crossings(geometry, {origin, direction}, item).empty())
                << "round " << round << " item " << item;
    }
}

TEST(PlaneFaces, AreMetWhereTheyAre) {
    FewValues few(3);
    for (int round = 0; round < 20000; ++round) {
        // Not convex: an arrow head.
        const std::vector<Vec3> corners = {{-1, -1, 0}, {0, -0.5, 0}, {1, -1, 0}, {0, 1, 0}};
        Geometry geometry;
        test::add_polygon(geometry, corners, Polygon::Shape::simple);
        const Vec3 aim = {few.coordinate(), few.coordinate(), 0};
        Vec3 direction = few.point();
        direction.z = 1;
        const Ray ray = {aim - 2 * direction, direction};
        // Between the lower sides' roof and the upper sides, boundary included.
        const double x = std::abs(aim.x);
        // Below 0 within both, above 0 beyond one of them; near 0 the rounding of the ray decides.
        const double beyond = std::max(-0.5 - 0.5 * x - aim.y, aim.y - (1 - 2 * x));
        const auto found = crossings(geometry, ray);
        if (std::abs(beyond) > 1e-9) {
            ASSERT_EQ(found.size(), beyond < 0 ? 1U : 0U) << "round " << round;
        }
        for (const auto& crossing : found)
            ASSERT_NEAR(crossing.t, 2, 1e-12);
    }
}

TEST(Crossings, ScaleExactlyWithPowersOfTwo) {
    FewValues few(5);
    for (int round = 0; round < 5000; ++round) {
        for (const double scale : {0x1p20, 0x1p-20}) {
            Geometry geometry;
            Geometry scaled;
            const Vec3 a = few.point();
            const Vec3 b = few.point();
            const Vec3 c = few.point();
            test::add(geometry, Triangle{{a, b, c}});
            test::add(scaled, Triangle{{scale * a, scale * b, scale * c}});
            test::add_polygon(geometry, {a, b, c});
            test::add_polygon(scaled, {scale * a, scale * b, scale * c});
            test::add(geometry, Sphere{a, 0.7});
            test::add(scaled, Sphere{scale * a, scale * 0.7});
            const Vec3 origin = few.point() + Vec3{0.01, 0.02, 0.03};
            const Vec3 direction = few.point();
            for (std::uint32_t item = 0; item < 3; ++item) {
                const auto found = crossings(geometry, {origin, direction}, item);
                const auto found_scaled = crossings(scaled, {scale * origin, direction}, item);
                ASSERT_EQ(found.size(), found_scaled.size());
                for (std::size_t i = 0; i < found.size(); ++i)
                    ASSERT_EQ(scale * found[i].t, found_scaled[i].t);
            }
        }
    }
}

TEST(Crossings, AreNumbersWhateverTheRay) {
    constexpr double values[] = {0, -0.0, 1, -1, 5e-324, 1e-300, 1e300, -1e308, 1e-160, 1e160};
    std::mt19937 random(11);
    const auto value = [&] { return values[random() % std::size(values)]; };
    const auto point = [&] { return Vec3{value(), value(), value()}; };
    for (int round = 0; round < 3000; ++round) {
        Geometry geometry;
        test::add(geometry, Triangle{{point(), point(), point()}});
        test::add_polygon(geometry, {point(), point(), point(), point()});
        test::add(geometry, Sphere{point(), std::abs(value()) + 1e-300});
        RotationalShape shape;
        shape.base = point();
        shape.start = {std::abs(value()), value()};
        for (int i = 0; i < 3; ++i) {
            ContourPiece piece;
            piece.kind = static_cast<ContourPiece::Kind>(i);
            piece.control = {
                ContourPiece::Point{std::abs(value()), value()}, {std::abs(value()), value()}};
            piece.end = {std::abs(value()), value()};
            shape.contour.push_back(piece);
        }
        test::add(geometry, shape);
        Ray ray = {point(), point()};
        if (round % 2 == 0)
            ray.t_min = -infinity;
        for (std::uint32_t item = 0; item < 4; ++item)
            for (const auto& crossing : crossings(geometry, ray, item)) {
                ASSERT_TRUE(std::isfinite(crossing.t));
                ASSERT_GE(crossing.t, ray.t_min);
            }
    }
}

} // namespace
} // namespace vera
