// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/strategies.h"

#include "vera/base/check.h"
#include "vera/visible/map_raster.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vera {

namespace {

constexpr double depth_scale = static_cast<double>(screen_size) / static_cast<double>(depth_size);

/// Nearness, scaled, ends before it.
constexpr double start_of_rays = 2.0 * screen_size;

Vec3 in_space(const ScreenVertex& vertex) {
    return {
        static_cast<double>(vertex.point.x),
        static_cast<double>(vertex.point.y),
        static_cast<double>(vertex.nearness) * depth_scale};
}

/// Of so many pixels, one behind the other.
Vec3 middle_of(std::size_t pixel, std::size_t side) {
    const double width = static_cast<double>(screen_size) / static_cast<double>(side);
    const std::size_t row = pixel / side;
    const std::size_t column = pixel % side;
    return {
        (static_cast<double>(column) + 0.5) * width, (static_cast<double>(row) + 0.5) * width, 0};
}

} // namespace

PixelSources sources_by_depth(const ScreenScene& scene, std::size_t side, DepthCounts& counts) {
    std::vector<DepthTriangle> triangles;
    triangles.reserve(scene.triangles.size());
    for (const ScreenTriangle& triangle : scene.triangles)
        triangles.push_back({corners_of(scene, triangle), triangle.source});
    const DepthBuffer buffer(triangles, {side, side, 1, 1});
    PixelSources result;
    result.reserve(side * side);
    std::vector<std::uint32_t> of_band;
    for (std::size_t band = 0; band < buffer.bands().count(); ++band) {
        buffer.see(band, of_band, &counts);
        result.insert(result.end(), of_band.begin(), of_band.end());
    }
    return result;
}

PixelSources
sources_by_map(const ScreenScene& scene, const VisiblePieces& pieces, std::size_t side) {
    const VisibleMap map = visible_map(scene, pieces);
    const MapRaster raster(map, side, side);
    PixelSources result(side * side, no_source);
    std::vector<PixelPart> parts;
    for (std::size_t band = 0; band < raster.bands().count(); ++band) {
        parts.clear();
        raster.add_centers(band, parts);
        for (const PixelPart& part : parts)
            result[part.y * side + part.x] = part.source;
    }
    return result;
}

GridRays::GridRays(const ScreenScene& scene) {
    // Of coincident surfaces that of the smaller source is in front, and of the first of the text.
    std::vector<std::uint32_t> order(scene.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return scene.triangles[a].source < scene.triangles[b].source;
    });
    scene_.materials.emplace_back();
    Mesh mesh;
    for (const ScreenVertex& vertex : scene.vertices)
        mesh.positions.push_back(in_space(vertex));
    for (const std::uint32_t i : order) {
        const auto& vertices = scene.triangles[i].vertices;
        mesh.position_indices.insert(mesh.position_indices.end(), vertices.begin(), vertices.end());
        sources_.push_back(scene.triangles[i].source);
    }
    scene_.geometry.meshes.push_back(std::move(mesh));
    Item item;
    item.kind = ItemKind::mesh;
    item.material = MaterialId{0};
    scene_.geometry.items.push_back(item);
    number_primitives(scene_);
    index_ = make_wide_bvh(scene_);
}

std::vector<Hit> GridRays::hits(std::size_t side, QueryCounts& counts) const {
    std::vector<Hit> hits(side * side);
    // Row by row, as a picture asks them.
    std::vector<QueryRay> rays(side);
    for (std::size_t row = 0; row < side; ++row) {
        for (std::size_t i = 0; i < side; ++i) {
            QueryRay& ray = rays[i];
            ray.ray.origin = middle_of(row * side + i, side);
            ray.ray.origin.z = start_of_rays;
            ray.ray.direction = {0, 0, -1};
        }
        index_->nearest_hits(rays, std::span(hits).subspan(row * side, side), counts);
    }
    return hits;
}

PixelSources GridRays::sources(std::span<const Hit> hits) const {
    PixelSources result;
    result.reserve(hits.size());
    for (const Hit& hit : hits)
        result.push_back(hit.found() ? sources_[hit.face.primitive] : no_source);
    return result;
}

std::size_t GridRays::lit(std::span<const Hit> hits, Light light, QueryCounts& counts) const {
    const auto side = static_cast<std::size_t>(std::lround(std::sqrt(hits.size())));
    std::size_t lit = 0;
    std::vector<QueryRay> rays;
    std::vector<Color> transmitted;
    for (std::size_t row = 0; row < side; ++row) {
        rays.clear();
        for (std::size_t i = row * side; i < (row + 1) * side; ++i) {
            if (!hits[i].found())
                continue;
            QueryRay ray;
            ray.ray.origin = middle_of(i, side);
            ray.ray.origin.z = start_of_rays - hits[i].t;
            ray.ray.direction = {-light.x, -light.y, 1};
            ray.ray.origin_error = 1;
            ray.start = hits[i].face;
            rays.push_back(ray);
        }
        transmitted.resize(rays.size());
        index_->transmittances(rays, transmitted, counts);
        lit += static_cast<std::size_t>(std::count_if(
            transmitted.begin(), transmitted.end(), [](const Color& part) { return part.r > 0; }));
    }
    return lit;
}

ScreenScene seen_from(const ScreenScene& scene, GridRays::Light light) {
    constexpr double most = 0.3;
    VERA_CHECK(std::abs(light.x) <= most && std::abs(light.y) <= most);
    ScreenScene result;
    result.vertices = scene.vertices;
    const auto moved = [](double place, double by) {
        constexpr double reach = most * screen_size;
        return static_cast<std::int32_t>(std::lround((place + by + reach) / (1 + 2 * most)));
    };
    for (ScreenVertex& vertex : result.vertices) {
        const double near = static_cast<double>(vertex.nearness) * depth_scale;
        vertex.point = {
            moved(vertex.point.x, light.x * near), moved(vertex.point.y, light.y * near)};
    }
    for (const ScreenTriangle& triangle : scene.triangles)
        add_triangle(result, triangle.vertices, triangle.source);
    return result;
}

} // namespace vera
