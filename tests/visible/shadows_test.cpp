// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/exact/front_order.h"
#include "vera/scene/surface.h"
#include "vera/visible/closed_bodies.h"
#include "vera/visible/map_locator.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/shadows.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "accel/random_scene.h"
#include "visible/cameras.h"
#include "visible/map_turns.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr std::uint64_t nothing = ~std::uint64_t{0};

/// Everything of a drawing with shadows.
struct DrawnShadows {
    Facets facets;
    DrawnFaces faces;
    ScreenScene screen; ///< with the shadows
    VisibleMap without; ///< shadows
    VisibleMap map;
    ShadowCounts counts;
};

DrawnShadows drawn_shadows(const Scene& scene, const Camera& camera) {
    const CameraMap map(camera);
    DrawnShadows drawn;
    drawn.facets = facets(scene, [](Vec3) { return 1.0; });
    drawn.faces = drawn_faces(scene, drawn.facets, FaceUnit::plane, camera);
    drawn.screen = screen_scene(drawn.facets, map, drawn.faces.of_facet);
    const WholePieces whole = whole_pieces(drawn.screen);
    drawn.without = visible_map(drawn.screen, whole.pieces);
    drawn.counts = add_shadows(
        {scene, drawn.facets, drawn.faces, camera, map, 512, 512, whole.pieces}, drawn.screen);
    drawn.map = visible_map(drawn.screen, cell_raster(drawn.screen));
    return drawn;
}

/// Plane faces, and lights none of which lies in the plane of one, where rays may see either side.
Scene scene_of_planes(std::uint64_t seed, double scale = 1) {
    testing::RandomSceneSettings settings;
    settings.items = 4 + seed % 4 * 5;
    settings.curved = false;
    settings.scale = scale;
    Scene scene = testing::random_scene(seed, settings);
    scene.lights = {
        {.position = scale * Vec3{5.1, 3.2, 9.3}},
        {.position = scale * Vec3{0.31, -0.213, 0.737}},
        {.position = scale * Vec3{-4.07, -4.11, 2.03}}};
    return scene;
}

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

/// What the map shows at a place, or nothing where it is not one region.
std::optional<VisibleMap::Region> region_at(const VisibleMap& map, double x, double y) {
    const auto turns = testing::turns_about(map, x, y);
    if (turns.size() != 1)
        return std::nullopt;
    return map.regions[turns.begin()->first];
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

/// Calls visit(corners) for trapezoids that together are the region, cut at each of its corners.
template <typename Visit>
void for_each_trapezoid(const VisibleMap& map, std::uint32_t region, const Visit& visit) {
    struct Side {
        NearnessPlace from;
        NearnessPlace to;

        double height(double x) const {
            return from.y + (x - from.x) / (to.x - from.x) * (to.y - from.y);
        }
    };

    std::vector<Side> sides;
    std::set<double> columns;
    for (const VisibleMap::Ring& ring : map.rings) {
        const auto vertices = map.vertices_of(ring);
        for (std::size_t i = 0; i < vertices.size() && ring.region == region; ++i) {
            const RationalPoint& a = map.vertices[vertices[i]];
            const RationalPoint& b = map.vertices[vertices[(i + 1) % vertices.size()]];
            columns.insert(a.x());
            if (a.x() < b.x())
                sides.push_back({{a.x(), a.y()}, {b.x(), b.y()}});
            else if (b.x() < a.x())
                sides.push_back({{b.x(), b.y()}, {a.x(), a.y()}});
        }
    }
    for (auto left = columns.begin(); std::next(left) != columns.end(); ++left) {
        const double right = *std::next(left);
        const double middle = 0.5 * (*left + right);
        std::vector<Side> here;
        for (const Side& side : sides)
            if (side.from.x < middle && side.to.x > middle)
                here.push_back(side);
        std::sort(here.begin(), here.end(), [&](const Side& a, const Side& b) {
            return a.height(middle) < b.height(middle);
        });
        for (std::size_t i = 0; i + 1 < here.size(); i += 2)
            visit(std::array<NearnessPlace, 4>{
                {{*left, here[i].height(*left)},
                 {right, here[i].height(right)},
                 {right, here[i + 1].height(right)},
                 {*left, here[i + 1].height(*left)}}});
    }
}

/// The construct of 3.4: what is seen of each face becomes a part of its own in front of the face.
/// Of what the light then sees, these parts are lit.
class ShadowsByUnion {
public:
    ShadowsByUnion(const Camera& camera, const DrawnShadows& drawn)
        : camera_(camera)
        , drawn_(drawn) {
        const VisibleMap& map = drawn.without;
        for (std::uint32_t region = 0; region < map.regions.size(); ++region)
            for_each_trapezoid(map, region, [&](const std::array<NearnessPlace, 4>& corners) {
                const std::uint32_t face = map.regions[region].source;
                const auto first = static_cast<std::uint32_t>(all_.corners.size());
                for (const NearnessPlace& corner : corners)
                    all_.corners.push_back(on_face(face, corner));
                for (const std::uint32_t i : {1U, 2U}) {
                    all_.triangles.push_back({{first, first + i, first + i + 1}});
                    sources_.push_back(face);
                }
            });
        // The parts come before the faces that they are parts of.
        const auto faces = static_cast<std::uint32_t>(drawn.faces.first_facet.size());
        const auto corners = static_cast<std::uint32_t>(all_.corners.size());
        for (std::size_t i = 0; i < drawn.facets.triangles.size(); ++i) {
            const auto& [a, b, c] = drawn.facets.triangles[i].corners;
            all_.triangles.push_back({{corners + a, corners + b, corners + c}});
            sources_.push_back(faces + drawn.faces.of_facet[i]);
        }
        all_.corners.insert(
            all_.corners.end(), drawn.facets.corners.begin(), drawn.facets.corners.end());
    }

    /// Whether the light reaches the place of the face; nothing where its view does not show it.
    class View {
    public:
        View(const ShadowsByUnion& shadows, Vec3 light)
            : shadows_(shadows)
            , map_(camera_at(light)) {
            ScreenScene screen = screen_scene(shadows.all_, map_, shadows.sources_);
            sort_by_place(screen);
            const WholePieces whole = whole_pieces(screen);
            seen_ = visible_map(screen, whole.pieces);
        }

        std::optional<bool> is_lit(std::uint32_t face, NearnessPlace place) const {
            const ImagePoint at = map_.image_point(shadows_.on_face(face, place));
            if (!(at.w > 0 && at.x > 0 && at.x < at.w && at.y > 0 && at.y < at.w))
                return std::nullopt;
            const auto turns = testing::turns_about(
                seen_, at.x / at.w * screen_size, (1 - at.y / at.w) * screen_size);
            if (turns.size() != 1)
                return std::nullopt;
            const std::uint32_t source = seen_.regions[turns.begin()->first].source;
            const auto faces = static_cast<std::uint32_t>(shadows_.drawn_.faces.first_facet.size());
            return source % faces == face;
        }

    private:
        static Camera camera_at(Vec3 light) {
            const Vec3 forward = normalized(-light);
            const Vec3 across = 3 * normalized(cross(forward, {0.1, 0.2, 1}));
            const Vec3 up = 3 * normalized(cross(across, forward));
            Camera camera;
            camera.viewpoint = light;
            camera.lower_left = light + forward - across - up;
            camera.lower_right = light + forward + across - up;
            camera.upper_left = light + forward - across + up;
            return camera;
        }

        const ShadowsByUnion& shadows_;
        CameraMap map_;
        VisibleMap seen_;
    };

    /// Whether the light is on the viewer's side of the face.
    bool faces(std::uint32_t face, NearnessPlace place, Vec3 light) const {
        const auto [corner, normal] = plane(face);
        const Ray ray = ray_through(place);
        return dot(normal, light - corner) * dot(normal, ray.direction) < 0;
    }

private:
    std::pair<Vec3, Vec3> plane(std::uint32_t face) const {
        const auto& corners = drawn_.facets.triangles[drawn_.faces.first_facet[face]].corners;
        const auto corner = [&](std::size_t i) { return drawn_.facets.corners[corners[i]]; };
        return {corner(0), normalized(cross(corner(1) - corner(0), corner(2) - corner(0)))};
    }

    Ray ray_through(NearnessPlace place) const {
        return view_ray(camera_, place.x / screen_size, place.y / screen_size);
    }

    Vec3 on_face(std::uint32_t face, NearnessPlace place) const {
        const auto [corner, normal] = plane(face);
        const Ray ray = ray_through(place);
        return point_at(ray, dot(normal, corner - ray.origin) / dot(normal, ray.direction));
    }

    const Camera& camera_;
    const DrawnShadows& drawn_;
    Facets all_;
    std::vector<std::uint32_t> sources_;
};

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

/// Whether the view's light reaches the face there, if it is the same some steps around.
std::optional<bool>
is_lit_around(const ShadowsByUnion::View& view, std::uint32_t source, const NearnessPlace& place) {
    std::set<std::optional<bool>> found;
    constexpr double off = 40;
    for (const auto& [x, y] :
         {std::pair{0.0, 0.0}, {off, off}, {-off, off}, {off, -off}, {-off, -off}})
        found.insert(view.is_lit(source, {place.x + x, place.y + y}));
    return found.size() == 1 ? *found.begin() : std::nullopt;
}

TEST(Shadows, AreThoseOfTheConstructOfTheText) {
    int compared = 0;
    int unlit = 0;
    for (std::uint64_t seed = 0; seed < 8 && !HasFailure(); ++seed) {
        const Scene scene = scene_of_planes(seed);
        const Camera camera = testing::camera_number(static_cast<int>(seed));
        const DrawnShadows drawn = drawn_shadows(scene, camera);
        if (drawn.screen.cut_nearness > 0 || drawn.counts.cut_nearness > 0)
            continue;
        const ShadowsByUnion by_union(camera, drawn);
        for (std::size_t light = 0; light < scene.lights.size(); ++light) {
            const Vec3 position = scene.lights[light].position;
            const ShadowsByUnion::View view(by_union, position);
            std::mt19937_64 random(seed);
            for (int i = 0; i < 60; ++i) {
                const NearnessPlace place = {
                    std::uniform_real_distribution(0.0, 1.0 * screen_size)(random),
                    std::uniform_real_distribution(0.0, 1.0 * screen_size)(random)};
                const auto region = region_at(drawn.map, place.x, place.y);
                if (!region)
                    continue;
                const auto is_lit = is_lit_around(view, region->source, place);
                if (!is_lit || !by_union.faces(region->source, place, position))
                    continue;
                ++compared;
                const bool is_unlit = contains(region->unlit, light);
                unlit += is_unlit ? 1 : 0;
                EXPECT_EQ(!is_unlit, *is_lit) << "scene " << seed << " light " << light << " at "
                                              << place.x << " " << place.y;
            }
        }
    }
    EXPECT_GT(compared, 300);
    EXPECT_GT(unlit, 60);
}

} // namespace
} // namespace vera
