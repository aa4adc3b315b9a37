// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/accel/wide_bvh.h"
#include "vera/depth_buffer/depth_buffer.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/map_raster.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accel/random_scene.h"
#include "reference/example_scenes.h"
#include "visible/cameras.h"

namespace vera {
namespace {

constexpr std::uint64_t nothing = no_primitive;

/// What the pixels of a picture show, row by row: primitives, or nothing.
struct Labels {
    std::vector<std::uint64_t> by_depth;
    std::vector<std::uint64_t> by_map;
    double cut_nearness = 0;
};

constexpr double deviation = 1.0 / 64; // in pixels

Labels labels(const Scene& scene, const Camera& camera, std::size_t width, std::size_t height) {
    const CameraMap map(camera);
    const Facets all = facets(scene, [&](Vec3 point) {
        return deviation
            * map.size_of_pixel(static_cast<double>(width), static_cast<double>(height), point);
    });
    const DrawnFaces faces = drawn_faces(scene, all, FaceUnit::primitive, camera);
    const auto primitive_of = [&](std::uint32_t face) {
        return face == PixelPart::background ? nothing
                                             : all.triangles[faces.first_facet[face]].primitive;
    };
    ScreenScene screen = screen_scene(all, map, faces.of_facet);
    Labels result;
    result.cut_nearness = screen.cut_nearness;

    std::vector<DepthTriangle> triangles;
    for (const ScreenTriangle& triangle : screen.triangles)
        triangles.push_back({corners_of(screen, triangle), triangle.source});
    const DepthBuffer buffer(triangles, {width, height});
    std::vector<std::uint32_t> sources;
    for (std::size_t band = 0; band < buffer.bands().count(); ++band) {
        buffer.see(band, sources);
        for (const std::uint32_t source : sources)
            result.by_depth.push_back(primitive_of(source));
    }

    sort_by_place(screen);
    const WholePieces whole = whole_pieces(screen);
    const MapRaster raster(visible_map(screen, whole.pieces), width, height);
    std::vector<PixelPart> parts;
    for (std::size_t band = 0; band < raster.bands().count(); ++band)
        raster.add_centers(band, parts);
    for (const PixelPart& part : parts)
        result.by_map.push_back(primitive_of(part.source));
    return result;
}

/// What the ray through the middle of a pixel sees and, if it is the same, those close around it.
std::optional<std::uint64_t> seen_around(
    const RayIndex& index, const Camera& camera, double x, double y, double across, double down) {
    std::optional<std::uint64_t> seen;
    for (const auto& [step_x, step_y] :
         {std::pair{0, 0}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        QueryRay query;
        query.ray = view_ray(camera, x + step_x * across, y + step_y * down);
        std::array<Hit, 1> hits;
        QueryCounts counts;
        index.nearest_hits(std::array{query}, hits, counts);
        if (seen && *seen != hits[0].face.primitive)
            return std::nullopt;
        seen = hits[0].face.primitive;
    }
    return seen;
}

struct Compared {
    int pixels = 0;
    int near_edge = 0; ///< not compared with rays
    int apart = 0;     ///< the map and the depth buffer, which see the same grid, differ
};

/// All three strategies show the same in the middle of each pixel, but within two deviations from
/// an edge.
Compared compare(
    const Scene& scene,
    const Camera& camera,
    const RayIndex& index,
    std::size_t width,
    std::size_t height,
    const std::string& what) {
    const Labels found = labels(scene, camera, width, height);
    Compared compared;
    if (found.cut_nearness > 0)
        return compared;
    const double across = 1 / static_cast<double>(width);
    const double down = 1 / static_cast<double>(height);
    for (std::size_t pixel = 0; pixel < width * height; ++pixel) {
        const double x = (static_cast<double>(pixel % width) + 0.5) * across;
        const double y = (static_cast<double>(pixel / width) + 0.5) * down;
        ++compared.pixels;
        compared.apart += found.by_depth[pixel] == found.by_map[pixel] ? 0 : 1;
        const auto expected =
            seen_around(index, camera, x, y, 2 * deviation * across, 2 * deviation * down);
        if (!expected) {
            ++compared.near_edge;
            continue;
        }
        EXPECT_EQ(found.by_depth[pixel], *expected) << what << " pixel " << pixel;
        EXPECT_EQ(found.by_map[pixel], *expected) << what << " pixel " << pixel;
    }
    return compared;
}

TEST(DepthAgainstRays, ShowsTheSamePrimitivesOfRandomScenes) {
    Compared all;
    for (int number = 0; number < 8 && !HasFailure(); ++number) {
        testing::RandomSceneSettings settings;
        settings.items = 8 + static_cast<std::size_t>(number) % 3 * 6;
        const Scene scene = testing::random_scene(static_cast<std::uint64_t>(number), settings);
        const auto index = make_brute_force(scene);
        const Compared compared = compare(
            scene,
            testing::camera_number(number),
            *index,
            40,
            30,
            "scene " + std::to_string(number));
        all.pixels += compared.pixels;
        all.near_edge += compared.near_edge;
        all.apart += compared.apart;
    }
    EXPECT_GT(all.pixels, 4000);
    EXPECT_LT(all.near_edge, all.pixels / 10);
    EXPECT_EQ(all.apart, 0);
    RecordProperty("pixels", all.pixels);
    RecordProperty("near_edge", all.near_edge);
    RecordProperty("apart", all.apart);
}

class DepthOfExample : public ::testing::TestWithParam<std::string> {};

TEST_P(DepthOfExample, ShowsTheSamePrimitivesAsRays) {
    const auto [scene, settings] = reference::example(GetParam(), 64);
    const auto index = make_wide_bvh(scene);
    const Compared compared =
        compare(scene, *scene.camera, *index, settings.width, settings.height, GetParam());
    EXPECT_GT(compared.pixels, 0);
    EXPECT_LT(compared.near_edge, compared.pixels / 4);
    EXPECT_EQ(compared.apart, 0);
    RecordProperty("pixels", compared.pixels);
    RecordProperty("near_edge", compared.near_edge);
    RecordProperty("apart", compared.apart);
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    DepthOfExample,
    ::testing::ValuesIn(reference::example_files()),
    reference::example_name);

} // namespace
} // namespace vera
