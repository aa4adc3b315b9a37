// SPDX-License-Identifier: Apache-2.0
#include "vera/render/render_parts.h"

#include "vera/image/develop.h"
#include "vera/render/facet_hit.h"
#include "vera/render/generations.h"
#include "vera/render/raster.h"
#include "vera/render/sample_positions.h"
#include "vera/render/workspaces.h"
#include "vera/shade/firmament.h"

#include <memory>

namespace vera {

namespace {

/// What a thread needs for the bands that it renders, one after another.
struct BandWork {
    explicit BandWork(const TracedScene& traced)
        : tracer(traced) {}

    GenerationTracer tracer;
    std::vector<PixelPart> parts;
    std::vector<QueryRay> rays;
    std::vector<Hit> hits;
    std::vector<SurfacePoint> surfaces;
    std::vector<Color> colors;
    std::vector<Color> row;
};

void find_hits(const Scene& scene, const Facets& facets, const Raster& raster, BandWork& work) {
    work.rays.resize(work.parts.size());
    work.hits.resize(work.parts.size());
    work.surfaces.resize(work.parts.size());
    work.colors.resize(work.parts.size());
    for (std::size_t i = 0; i < work.parts.size(); ++i) {
        const PixelPart& part = work.parts[i];
        work.rays[i] = raster.ray(part.x, part.y, {part.across, part.down});
        work.hits[i] = part.source == PixelPart::background
            ? Hit{}
            : facet_hit(scene, facets, part.source, work.rays[i].ray);
    }
    work.tracer.surfaces(work.rays, work.hits, work.surfaces);
}

/// Gives the background of a pixel that shows sky and earth the mean of what is seen in the pixel.
void soften_horizon(const TracedScene& traced, const Raster& raster, BandWork& work) {
    constexpr std::uint32_t samples = 16;
    const auto& firmament = traced.firmament;
    if (!firmament)
        return;
    const auto direction = [&](const PixelPart& part, SamplePosition position) {
        return raster.ray(part.x, part.y, position).ray.direction;
    };
    for (std::size_t i = 0; i < work.parts.size(); ++i) {
        const PixelPart& part = work.parts[i];
        if (part.source != PixelPart::background)
            continue;
        const bool own = is_earth(*firmament, work.rays[i].ray.direction);
        const auto differs = [&](double across, double down) {
            return is_earth(*firmament, direction(part, {across, down})) != own;
        };
        if (!differs(0, 0) && !differs(1, 0) && !differs(0, 1) && !differs(1, 1))
            continue;
        Color sum;
        const SampleNet net(std::uint64_t{part.y} * raster.width + part.x);
        for (std::uint32_t sample = 0; sample < samples; ++sample)
            sum += clamped(firmament_color(firmament, direction(part, net[sample])));
        work.colors[i] = (1.0 / samples) * sum;
    }
}

/// Averages the parts of each pixel.
void develop_parts(const PictureSettings& settings, BandWork& work, Image& image) {
    for (std::size_t i = 0; i < work.parts.size();) {
        const std::uint32_t y = work.parts[i].y;
        work.row.assign(settings.width, {});
        for (; i < work.parts.size() && work.parts[i].y == y; ++i) {
            const PixelPart& part = work.parts[i];
            work.row[part.x] +=
                settings.antialiasing.on ? part.area * clamped(work.colors[i]) : work.colors[i];
        }
        develop(work.row, image, 0, y);
    }
}

} // namespace

RenderResult render_parts(
    const Scene& scene,
    const Camera& camera,
    const RayIndex& index,
    const PictureParts& seen,
    const PictureSettings& settings,
    SampleType sample_type,
    const Progress& progress,
    const CancelFlag* cancel) {
    RenderResult result;
    TracedScene traced = traced_scene(scene, index, settings, cancel);
    if (settings.exposure)
        result.exposure = expose(traced, camera, *settings.exposure, result.statistics);

    const Raster raster = {ViewRays(camera), settings.width, settings.height};
    result.image = blank_image(raster.width, raster.height, sample_type);
    const PixelBands bands = {settings.width, settings.height};
    ProgressMeter done(progress, static_cast<double>(bands.count()));
    Workspaces<BandWork> workspaces([&] { return std::make_unique<BandWork>(traced); });
    parallel_ranges(bands.count(), 1, [&](std::size_t first, std::size_t last) {
        workspaces.lend([&](BandWork& work) {
            for (std::size_t band = first; band < last; ++band) {
                if (cancel != nullptr)
                    cancel->throw_if_raised();
                work.parts.clear();
                seen.of_band(band, work.parts);
                find_hits(scene, seen.facets, raster, work);
                work.tracer.shade(work.rays, work.hits, work.surfaces, work.colors);
                if (settings.antialiasing.on)
                    soften_horizon(traced, raster, work);
                work.tracer.statistics.parts += work.parts.size();
                develop_parts(settings, work, result.image);
                done.add(1);
            }
        });
    });
    workspaces.for_each([&](const BandWork& work) { result.statistics += work.tracer.statistics; });
    return result;
}

} // namespace vera
