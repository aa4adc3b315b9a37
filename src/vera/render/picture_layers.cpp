// SPDX-License-Identifier: Apache-2.0
#include "vera/render/picture_layers.h"

#include "vera/image/develop.h"
#include "vera/render/tiles.h"
#include "vera/render/workspaces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

namespace vera {

namespace {

/// Of the tiles, and of the rows that are held at a time: fewer where there are very many layers.
std::size_t tile_side(std::size_t channels, std::size_t width) {
    constexpr std::size_t most_words = std::size_t{1} << 25; // 128 MiB
    std::size_t side = 32;
    while (side > 1 && channels * width * side > most_words)
        side /= 2;
    return side;
}

constexpr std::array<const char*, light_way_count> way_names = {"direct", "mirrored", "refracted"};

/// Behind the colours of the layers.
constexpr std::array<const char*, 9> seen_channels = {
    "Z",
    "normal.X",
    "normal.Y",
    "normal.Z",
    "position.X",
    "position.Y",
    "position.Z",
    "object.id",
    "material.id"};
constexpr std::size_t float_channels = 7;

/// "light07" where there are ten lights or more, so that names are in the order of the lights.
std::string light_name(std::size_t light, std::size_t count) {
    return fmt::format("light{:0{}}", light + 1, fmt::formatted_size("{}", count));
}

bool has_way(const TracedScene& traced, LightWay way) {
    if (way == LightWay::direct)
        return true;
    const auto& materials = traced.scene.materials;
    return traced.depth > 1
        && std::any_of(materials.begin(), materials.end(), [&](const Material& material) {
               return !is_black(way == LightWay::mirrored ? material.rab : material.tab);
           });
}

/// The float nearest to the value that is developed to the same byte.
float picture_sample(double value) {
    const auto nearest = static_cast<float>(value);
    if (developed_byte(static_cast<double>(nearest)) == developed_byte(value))
        return nearest;
    // Rounding has carried it over a border.
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return std::nextafter(nearest, static_cast<double>(nearest) > value ? -infinity : infinity);
}

/// What added to the sum gives the wanted float. Where nothing is negative the two are so close
/// together that their difference is a float.
float rounding_sample(float sum, float wanted) {
    if (sum == wanted || !std::isfinite(sum) || !std::isfinite(wanted))
        return 0;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const float difference = wanted - sum;
    for (const float rounding :
         {std::nextafter(difference, -infinity), std::nextafter(difference, infinity)})
        if (sum + difference != wanted && sum + rounding == wanted)
            return rounding;
    return difference;
}

/// What a thread needs for the tiles that it renders, one after another.
struct LayerWork {
    explicit LayerWork(const TracedScene& traced)
        : tracer(traced) {}

    GenerationTracer tracer;
    std::vector<QueryRay> rays;
    std::vector<Hit> hits;
    std::vector<SurfacePoint> surfaces;
    std::vector<Color> colors;
    std::vector<Color> terms;
};

void trace_tile(const Raster& raster, const Tile& tile, LayerWork& work) {
    const std::size_t count = tile.width * tile.height;
    work.rays.resize(count);
    work.hits.resize(count);
    work.surfaces.resize(count);
    work.colors.resize(count);
    work.terms.resize(count * light_way_count * work.tracer.terms().count());
    QueryRay* ray = work.rays.data();
    for_each_pixel(tile, [&](std::size_t x, std::size_t y) {
        *ray++ = raster.ray(static_cast<double>(x), static_cast<double>(y));
    });
    work.tracer.nearest(work.rays, work.hits);
    work.tracer.surfaces(work.rays, work.hits, work.surfaces);
    work.tracer.shade(work.rays, work.hits, work.surfaces, work.colors, work.terms);
    work.tracer.statistics.view_rays += count;
}

/// The rows that are in work.
struct Band {
    std::size_t width = 0;
    std::size_t y = 0;
    std::size_t rows = 0;
    std::vector<std::uint32_t> words;

    std::uint32_t& word(std::size_t channel, std::size_t x, std::size_t picture_y) {
        return words[(channel * rows + picture_y - y) * width + x];
    }
};

std::uint32_t object_number(const Hit& hit) {
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    return static_cast<std::uint32_t>(hit.face.primitive % most) + 1;
}

std::uint32_t material_number(const Scene& scene, MaterialId material) {
    return static_cast<std::uint32_t>(
               std::min(static_cast<std::size_t>(material), scene.materials.size()))
        + 1;
}

/// What the pixel sees, as in seen_channels.
std::array<std::uint32_t, seen_channels.size()>
seen_words(const Scene& scene, const QueryRay& ray, const Hit& hit, const SurfacePoint& surface) {
    std::array<std::uint32_t, seen_channels.size()> words = {};
    words[0] = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
    if (!hit.found())
        return words;
    const Vec3 normal = incidence(surface, ray.ray.direction).normal;
    const std::array<double, float_channels> values = {
        hit.t, normal.x, normal.y, normal.z, surface.point.x, surface.point.y, surface.point.z};
    for (std::size_t i = 0; i < values.size(); ++i)
        words[i] = std::bit_cast<std::uint32_t>(static_cast<float>(values[i]));
    words[float_channels] = object_number(hit);
    words[float_channels + 1] = material_number(scene, surface.material);
    return words;
}

void put_tile(
    const TracedScene& traced,
    std::span<const PictureLayer> layers,
    const Tile& tile,
    const LayerWork& work,
    Band& band) {
    const std::size_t term_count = light_way_count * work.tracer.terms().count();
    std::size_t i = 0;
    for_each_pixel(tile, [&](std::size_t x, std::size_t y) {
        const auto samples = layer_samples(
            layers, std::span(work.terms).subspan(i * term_count, term_count), work.colors[i]);
        std::size_t channel = 0;
        for (const LayerSample& sample : samples)
            for (const float value : sample)
                band.word(channel++, x, y) = std::bit_cast<std::uint32_t>(value);
        for (const std::uint32_t word :
             seen_words(traced.scene, work.rays[i], work.hits[i], work.surfaces[i]))
            band.word(channel++, x, y) = word;
        ++i;
    });
}

} // namespace

std::vector<PictureLayer> picture_layers(const TracedScene& traced) {
    const RayTerms terms = {traced.illumination.lights.size()};
    std::vector<PictureLayer> layers;
    for (std::size_t i = 0; i < light_way_count; ++i) {
        const auto way = static_cast<LightWay>(i);
        if (!has_way(traced, way))
            continue;
        const auto add = [&](const std::string& name, std::size_t term) {
            layers.push_back(
                {fmt::format("{}.{}", way_names[i], name), term_number(terms, way, term)});
        };
        add("ambient", RayTerms::ambient());
        add("luminosity", terms.luminosity());
        add("firmament", terms.firmament());
        for (std::size_t light = 0; light < terms.lights; ++light) {
            const std::string name = light_name(light, terms.lights);
            add(name + ".diffuse", terms.diffuse(light));
            add(name + ".highlight", terms.highlight(light));
        }
    }
    std::sort(
        layers.begin(), layers.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return layers;
}

std::vector<LayerSample>
layer_samples(std::span<const PictureLayer> layers, std::span<const Color> terms, Color color) {
    std::vector<LayerSample> samples;
    samples.reserve(layers.size() + 1);
    for (const PictureLayer& layer : layers) {
        const Color& term = terms[layer.number];
        samples.push_back(
            {static_cast<float>(term.r), static_cast<float>(term.g), static_cast<float>(term.b)});
    }
    const LayerSample sum = layer_sum(samples);
    samples.push_back(
        {rounding_sample(sum[0], picture_sample(color.r)),
         rounding_sample(sum[1], picture_sample(color.g)),
         rounding_sample(sum[2], picture_sample(color.b))});
    return samples;
}

LayerSample layer_sum(std::span<const LayerSample> samples) {
    LayerSample sum = {};
    for (const LayerSample& sample : samples)
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += sample[i];
    return sum;
}

std::vector<LayerChannel> layer_channels(std::span<const PictureLayer> layers) {
    std::vector<LayerChannel> channels;
    const auto add_layer = [&](const std::string& name) {
        for (const char* color : {".R", ".G", ".B"})
            channels.push_back({name + color, LayerChannel::Type::float32});
    };
    for (const PictureLayer& layer : layers)
        add_layer(layer.name);
    add_layer(PictureLayer::rounding);
    for (std::size_t i = 0; i < seen_channels.size(); ++i)
        channels.push_back(
            {seen_channels[i],
             i < float_channels ? LayerChannel::Type::float32 : LayerChannel::Type::uint32});
    return channels;
}

RenderStatistics render_layers(
    const TracedScene& traced,
    const Raster& raster,
    std::span<const PictureLayer> layers,
    const LayerRowsSink& sink,
    const Progress& progress) {
    const std::size_t channels = layer_channels(layers).size();
    const Tiling tiling = {raster.width, raster.height, tile_side(channels, raster.width)};
    ProgressMeter done(progress, static_cast<double>(tiling.count()));
    Workspaces<LayerWork> workspaces([&] { return std::make_unique<LayerWork>(traced); });
    Band band;
    band.width = raster.width;
    for (std::size_t row = 0; row < tiling.rows(); ++row) {
        const std::size_t first_tile = row * tiling.columns();
        band.y = row * tiling.side;
        band.rows = tiling.tile(first_tile).height;
        band.words.resize(channels * band.rows * band.width);
        parallel_ranges(tiling.columns(), 1, [&](std::size_t first, std::size_t last) {
            workspaces.lend([&](LayerWork& work) {
                for (std::size_t column = first; column < last; ++column) {
                    const Tile tile = tiling.tile(first_tile + column);
                    trace_tile(raster, tile, work);
                    put_tile(traced, layers, tile, work, band);
                    done.add(1);
                }
            });
        });
        sink(band.y, band.rows, band.words);
    }
    RenderStatistics statistics;
    workspaces.for_each([&](const LayerWork& work) { statistics += work.tracer.statistics; });
    return statistics;
}

} // namespace vera
