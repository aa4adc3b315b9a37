// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/simd_level.h"
#include "vera/scene/surface.h"
#include "vera/shade/surface_blocks.h"

#include <array>
#include <bit>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

bool same_bits(double a, double b) {
    // The sign of a zero is nothing that a picture shows.
    return std::bit_cast<std::uint64_t>(a + 0.0) == std::bit_cast<std::uint64_t>(b + 0.0)
        || (a != a && b != b);
}

void expect_same(Vec3 found, Vec3 expected, const char* what) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        ASSERT_TRUE(same_bits(found[axis], expected[axis]))
            << what << " along axis " << axis << ": found " << found[axis] << ", expected "
            << expected[axis];
}

/// Scenes and hits of few values, so that points lie in centers, on axes, in corners and in planes,
/// and also where squares of lengths overflow or vanish.
class Random {
public:
    explicit Random(std::uint32_t seed)
        : random_(seed) {}

    std::size_t below(std::size_t count) { return random_() % count; }

    template <std::size_t Count>
    double one_of(const double (&values)[Count]) {
        return values[below(Count)];
    }

    Vec3 vector() {
        static constexpr double values[] = {-2, -1, -0.5, -0.0, 0, 0.1, 0.5, 1, 3};
        Vec3 result;
        for (std::size_t axis = 0; axis < 3; ++axis)
            result[axis] = one_of(values);
        static constexpr double scales[] = {1, 1, 1, 1, 1, 1, 1e-150, 1e150};
        return one_of(scales) * result;
    }

    Vec3 direction() {
        while (true)
            if (const Vec3 a = vector(); !(a == Vec3{}))
                return normalized(a);
    }

    std::array<Vec3, 3> three() {
        std::array<Vec3, 3> result;
        for (Vec3& a : result)
            a = vector();
        return result;
    }

    std::array<Vec3, 3> three_directions() {
        std::array<Vec3, 3> result;
        for (Vec3& a : result)
            a = direction();
        return result;
    }

    double length() {
        static constexpr double values[] = {0.1, 0.5, 1, 2};
        return one_of(values);
    }

private:
    std::mt19937 random_;
};

Polygon random_polygon(Random& random, Geometry& geometry) {
    Polygon polygon;
    polygon.first_corner = static_cast<std::uint32_t>(geometry.corners.size());
    polygon.corner_count = 4;
    polygon.shape =
        random.below(2) == 0 ? Polygon::Shape::split_quadrangle : Polygon::Shape::convex;
    for (int i = 0; i < 4; ++i)
        geometry.corners.push_back(random.vector());
    polygon.normal = random.direction();
    return polygon;
}

RotationalShape random_shape(Random& random) {
    RotationalShape shape;
    shape.base = random.vector();
    shape.axis = random.direction();
    shape.start.r = random.length();
    ContourPiece::Point at = shape.start;
    for (int i = 0; i < 3; ++i) {
        ContourPiece piece;
        piece.kind = i == 1 ? ContourPiece::Kind::conic : ContourPiece::Kind::line;
        piece.control[0] = {at.r + 1, at.h};
        at = {random.length(), at.h + random.length()};
        piece.end = at;
        shape.contour.push_back(piece);
    }
    return shape;
}

Mesh random_mesh(Random& random) {
    Mesh mesh;
    for (int i = 0; i < 4; ++i)
        mesh.positions.push_back(random.vector());
    mesh.position_indices = {0, 1, 2, 1, 3, 2};
    const std::size_t kind = random.below(3);
    for (int i = 0; kind > 0 && i < 4; ++i)
        mesh.normals.push_back(random.direction());
    if (kind == 2)
        mesh.normal_indices = {3, 2, 1, 0, 1, 2};
    return mesh;
}

template <typename Primitive>
void add(
    Random& random,
    Geometry& geometry,
    std::vector<Primitive>& of_kind,
    ItemKind kind,
    Primitive one) {
    Item item;
    item.kind = kind;
    item.index = static_cast<std::uint32_t>(of_kind.size());
    item.material = static_cast<MaterialId>(random.below(3));
    item.outside = static_cast<Outside>(random.below(3));
    of_kind.push_back(std::move(one));
    geometry.items.push_back(item);
}

Geometry random_geometry(Random& random, bool with_call) {
    Geometry geometry;
    for (int i = 0; i < 12; ++i) {
        add(random, geometry, geometry.spheres, ItemKind::sphere, Sphere{random.vector(), 1});
        geometry.spheres.back().radius = random.length();
        add(random, geometry, geometry.triangles, ItemKind::triangle, Triangle{random.three()});
        Patch patch;
        patch.corners = random.three();
        patch.normals = random.three_directions();
        add(random, geometry, geometry.patches, ItemKind::patch, patch);
        const Polygon polygon = random_polygon(random, geometry);
        add(random, geometry, geometry.polygons, ItemKind::polygon, polygon);
        add(random,
            geometry,
            geometry.rotational_shapes,
            ItemKind::rotational_shape,
            random_shape(random));
        if (i % 4 == 0)
            add(random, geometry, geometry.meshes, ItemKind::mesh, random_mesh(random));
        if (with_call && i % 4 == 0)
            add(random, geometry, geometry.calls, ItemKind::subscene_call, SubsceneCall{});
    }
    return geometry;
}

Scene random_scene(Random& random) {
    Scene scene;
    scene.materials.resize(3);
    scene.subscenes.push_back(random_geometry(random, false));
    scene.geometry = random_geometry(random, true);
    number_primitives(scene);
    return scene;
}

void expect_surfaces(
    const Scene& scene, const std::vector<Ray>& rays, const std::vector<Hit>& hits) {
    std::vector<MetFace> met;
    for (std::size_t i = 0; i < rays.size(); ++i)
        met.push_back({&rays[i], &hits[i]});
    PlaceBlock block;
    const std::array<MaterialId, block_size> materials = put_surfaces(scene, met, block);
    ASSERT_EQ(block.lanes, (BlockLanes{1} << met.size()) - 1);
    for (std::size_t lane = 0; lane < met.size(); ++lane) {
        const SurfacePoint expected = surface_at(scene, rays[lane], hits[lane]);
        const SurfacePoint found = surface_in(block, lane, materials[lane], hits[lane].face);
        ASSERT_EQ(found.material, expected.material);
        ASSERT_EQ(found.face, expected.face);
        expect_same(found.point, expected.point, "point");
        ASSERT_TRUE(same_bits(found.point_error, expected.point_error));
        expect_same(found.geometric_normal, expected.geometric_normal, "face's normal");
        expect_same(found.shading_normal, expected.shading_normal, "shading normal");
        expect_same(vector_at(block.to_viewer, lane), -rays[lane].direction, "to the viewer");
    }
}

void expect_the_surfaces_of_one(std::uint32_t seed) {
    Random random(seed);
    const Scene scene = random_scene(random);
    for (int round = 0; round < 40; ++round) {
        std::vector<Ray> rays(1 + random.below(block_size));
        std::vector<Hit> hits(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            rays[i].origin = random.vector();
            rays[i].direction = random.direction();
            static constexpr double distances[] = {0, 0.5, 1, 2};
            hits[i].t = random.one_of(distances);
            hits[i].face.primitive = random.below(scene.geometry.primitive_count);
            const PrimitivePath path = path_to(scene, hits[i].face.primitive);
            const ItemKind kind = path.geometry->items[path.element.item].kind;
            hits[i].face.piece = static_cast<std::uint32_t>(
                kind == ItemKind::rotational_shape ? random.below(3)
                    : kind == ItemKind::polygon    ? random.below(2)
                                                   : 0);
        }
        expect_surfaces(scene, rays, hits);
    }
}

TEST(SurfaceBlocks, PlaceOnFacesAsTheFunctionForOneDoesWithEveryInstructionSet) {
    EXPECT_FALSE(simd_levels().empty());
    for (const std::string& level : simd_levels()) {
        ASSERT_TRUE(limit_simd(level));
        for (std::uint32_t seed = 0; seed < 60 && !HasFatalFailure(); ++seed) {
            SCOPED_TRACE(level + ", seed " + std::to_string(seed));
            expect_the_surfaces_of_one(seed);
        }
    }
    EXPECT_TRUE(limit_simd(""));
}

} // namespace
} // namespace vera
