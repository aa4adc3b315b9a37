// SPDX-License-Identifier: Apache-2.0
#include "vera/render/render_scene.h"

#include "vera/base/available_memory.h"
#include "vera/image/develop.h"
#include "vera/render/antialiasing.h"
#include "vera/render/center_rays.h"
#include "vera/render/generations.h"
#include "vera/render/raster.h"
#include "vera/render/tiles.h"
#include "vera/render/workspaces.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace vera {

namespace {

/// A tile is a few generations of view rays.
constexpr std::size_t usual_tile_side = 32;

/// What a thread needs for the tiles that it renders, one after another.
struct TileWork {
    GenerationTracer tracer;
    CenterRays center_rays;
    std::vector<QueryRay> rays;
    std::vector<Color> colors;
};

void render_tile(const Raster& raster, const Tile& tile, TileWork& work, Image& image) {
    work.center_rays.find(raster, tile, work.rays);
    work.colors.resize(work.rays.size());
    work.tracer.trace(work.rays, work.colors);
    work.tracer.statistics.view_rays += work.rays.size();

    std::span<const Color> colors = work.colors;
    for_each_run(tile, [&](std::size_t x, std::size_t y, std::size_t count) {
        develop(colors.first(count), image, x, y);
        colors = colors.subspan(count);
    });
}

/// One ray a pixel.
RenderStatistics
render_centers(const TracedScene& traced, const Raster& raster, Image& image, ProgressMeter& done) {
    const Tiling tiling = {
        raster.width,
        raster.height,
        tile_side(usual_tile_side, traced.generation_size, raster.width, raster.height)};
    Workspaces<TileWork> workspaces([&] {
        return std::make_unique<TileWork>(TileWork{GenerationTracer(traced), {}, {}, {}});
    });
    parallel_ranges(tiling.count(), 1, [&](std::size_t first, std::size_t last) {
        workspaces.lend([&](TileWork& work) {
            for (std::size_t number = first; number < last; ++number) {
                const Tile tile = tiling.tile(number);
                render_tile(raster, tile, work, image);
                done.add(static_cast<double>(tile.width * tile.height));
            }
        });
    });

    RenderStatistics statistics;
    workspaces.for_each([&](const TileWork& work) { statistics += work.tracer.statistics; });
    return statistics;
}

/// What the view rays take; what they send on is not known yet.
void require_generation(const PictureSettings& settings, std::size_t generation_size) {
    const std::size_t rays =
        std::min(std::size_t{settings.width} * settings.height, generation_size);
    require_memory(
        static_cast<double>(rays) * static_cast<double>(GenerationTracer::bytes_per_ray()),
        "a generation of " + std::to_string(rays) + " view rays",
        "a smaller picture, or generations in parts, take less");
}

} // namespace

RenderResult render_scene(
    const Scene& scene,
    const Camera& camera,
    const RayIndex& index,
    const PictureSettings& settings,
    SampleType sample_type,
    const Progress& progress,
    const CancelFlag* cancel,
    std::size_t generation_size) {
    require_generation(settings, generation_size);
    RenderResult result;
    TracedScene traced = traced_scene(scene, index, settings, cancel);
    traced.generation_size = generation_size;
    if (settings.exposure)
        result.exposure = expose(traced, camera, *settings.exposure, result.statistics);

    const Raster raster = {ViewRays(camera), settings.width, settings.height};
    result.image = blank_image(raster.width, raster.height, sample_type);
    ProgressMeter done(
        progress, static_cast<double>(raster.width) * static_cast<double>(raster.height));
    result.statistics += settings.antialiasing.on
        ? render_antialiased(traced, raster, settings.antialiasing, result.image, done)
        : render_centers(traced, raster, result.image, done);
    return result;
}

} // namespace vera
