// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/facets.h"
#include "vera/scene/surface.h"

#include <cmath>
#include <limits>
#include <random>

#include "scene/make_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::add;

constexpr double deviation = 0.002;

class RandomScene {
public:
    explicit RandomScene(unsigned seed)
        : random_(seed) {}

    Scene scene() {
        Scene scene;
        scene.subscenes.resize(3);
        fill(scene.subscenes[0]);
        fill(scene.subscenes[1]);
        add_call(scene.subscenes[1], 0);
        fill(scene.subscenes[1]);
        add_call(scene.geometry, 2); // empty
        fill(scene.geometry);
        add_call(scene.geometry, 1);
        fill(scene.geometry);
        add_call(scene.geometry, 0);
        number_primitives(scene);
        return scene;
    }

private:
    double coordinate() {
        constexpr double values[] = {-3, -2, -1, -0.5, 0, 0, 0.1, 0.5, 1, 1.5, 2.5};
        return values[random_() % std::size(values)];
    }

    double size() {
        constexpr double values[] = {0.25, 0.5, 1, 1, 1.5};
        return values[random_() % std::size(values)];
    }

    Vec3 point() { return {coordinate(), coordinate(), coordinate()}; }

    std::array<Vec3, 3> triangle() {
        while (true) {
            const std::array<Vec3, 3> corners = {point(), point(), point()};
            if (length(cross(corners[1] - corners[0], corners[2] - corners[0])) > 0.1)
                return corners;
        }
    }

    void add_call(Geometry& geometry, std::uint32_t subscene) {
        Affine3 map = rotation({10 * coordinate(), 90, coordinate()});
        map = composed(map, scaling(size()));
        map.linear.rows[0] = (random_() % 2 == 0 ? -1 : 2) * map.linear.rows[0];
        map.translation = point();
        add(geometry, SubsceneCall{SubsceneId{subscene}, map, *inverse(map)});
    }

    RotationalShape rotational_shape() {
        RotationalShape shape;
        shape.base = point();
        const Vec3 axis = point();
        shape.axis = axis == Vec3{} ? Vec3{0, 0, 1} : normalized(axis);
        shape.start = {random_() % 2 == 0 ? 0 : size(), 0};
        double h = 0;
        for (int i = 0; i < 4; ++i) {
            ContourPiece piece;
            const double from = h;
            piece.kind = static_cast<ContourPiece::Kind>(random_() % 3);
            // Going up, no piece folds back onto another.
            const bool is_ring = piece.kind == ContourPiece::Kind::line && i % 2 == 1;
            h += is_ring ? 0 : size();
            piece.control = {ContourPiece::Point{size(), 0.75 * from + 0.25 * h}, {size(), h}};
            piece.end = {size(), h};
            shape.contour.push_back(piece);
        }
        return shape;
    }

    void fill(Geometry& geometry) {
        for (int i = 0; i < 3; ++i) {
            add(geometry, Sphere{point(), size()});
            add(geometry, Triangle{triangle()});
            add(geometry, Patch{triangle(), {point(), point(), point()}});
            add(geometry, rotational_shape());
            Mesh mesh;
            for (int k = 0; k < 2; ++k)
                for (const Vec3& corner : triangle()) {
                    mesh.position_indices.push_back(
                        static_cast<std::uint32_t>(mesh.positions.size()));
                    mesh.positions.push_back(corner);
                    mesh.normals.push_back(point());
                }
            if (random_() % 2 == 0)
                mesh.normals.clear();
            add(geometry, mesh);
            const double s = size();
            const Vec3 at = point();
            test::add_polygon(
                geometry,
                {at, at + Vec3{s, 0, 0}, at + Vec3{s, s, 0}, at + Vec3{0.75 * s, 0.25 * s, 0}},
                Polygon::Shape::simple);
            test::add_polygon(
                geometry,
                {at, at + Vec3{s, 0, 0}, at + Vec3{s, s, s}, at + Vec3{0, s, 0}},
                Polygon::Shape::split_quadrangle);
        }
        for (Item& item : geometry.items) {
            item.outside = static_cast<Outside>(random_() % 3);
            item.material = random_() % 2 == 0 ? inherited_material
                                               : MaterialId{static_cast<unsigned>(random_() % 7)};
        }
    }

    std::mt19937 random_;
};

/// The crossing of the ray with the primitive that is nearest to t = 1.
Hit crossing_near_one(const Scene& scene, const Ray& ray, std::uint64_t primitive) {
    const PrimitivePath path = path_to(scene, primitive);
    Hit nearest;
    for_each_crossing(
        *path.geometry,
        path.element,
        path.in_main_scene ? ray : transformed_ray(path.from_world, ray),
        no_piece,
        [&](double t, std::uint32_t piece) {
            if (std::abs(t - 1) < std::abs(nearest.t - 1))
                nearest = {t, {primitive, piece}};
        });
    return nearest;
}

TEST(FacetsOfRandomScenes, LieWhereRaysMeetTheirPrimitives) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Scene scene = RandomScene(seed).scene();
        const Facets all = facets(scene, [](Vec3) { return deviation; });
        std::vector<bool> met(scene.geometry.primitive_count);
        std::size_t other_pieces = 0;
        for (const Facets::Triangle& triangle : all.triangles) {
            const auto& [a, b, c] = triangle.corners;
            const Vec3 middle = (all.corners[a] + all.corners[b] + all.corners[c]) / 3;
            const Vec3 normal =
                normalized(cross(all.corners[b] - all.corners[a], all.corners[c] - all.corners[a]));
            Ray ray = {middle + normal, -normal};
            const Hit hit = crossing_near_one(scene, ray, triangle.primitive);
            // Where the surface is strongly curved it stands askew to the facet.
            ASSERT_NEAR(hit.t, 1, 1.5 * deviation) << "seed " << seed << " " << triangle.primitive;
            other_pieces += hit.face.piece != triangle.piece ? 1 : 0;
            const SurfacePoint at = surface_at(scene, ray, hit);
            ASSERT_GT(dot(at.geometric_normal, normal), 0.5) << triangle.primitive;
            ASSERT_EQ(at.material, triangle.material);
            met[triangle.primitive] = true;
        }
        EXPECT_LE(other_pieces, all.triangles.size() / 1000);
        EXPECT_EQ(std::count(met.begin(), met.end(), false), 0);
    }
}

} // namespace
} // namespace vera
