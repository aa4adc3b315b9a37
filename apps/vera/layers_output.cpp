// SPDX-License-Identifier: Apache-2.0
#include "layers_output.h"

#include "vera/image/image_file.h"
#include "vera/render/exposure.h"
#include "vera/render/picture_layers.h"

#include "interrupt.h"
#include "layer_attributes.h"
#include "progress_display.h"
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vera {

namespace {

/// What each light was multiplied by, by LIGHTS and by EXPMES.
std::vector<double> light_factors(const PreparedScene& prepared, double exposure) {
    std::vector<double> factors = prepared.settings.light_factors;
    factors.resize(prepared.scene.lights.size(), 1);
    for (double& factor : factors)
        factor *= exposure;
    return factors;
}

PictureMetadata
layer_metadata(const PreparedScene& prepared, const TracedScene& traced, double exposure) {
    const Color ambient = traced.illumination.ambient;
    std::vector<std::string> materials;
    for (const Material& material : prepared.scene.materials)
        materials.push_back(material.name);
    return {
        {layer_attributes::encoding,
         "display-referred (sRGB), not linear light: 1 is what a screen shows as full"},
        {layer_attributes::sum,
         "the picture is the sum of all layers with R, G and B, in floats, in the order of their "
         "names"},
        {layer_attributes::light_factors,
         fmt::format("{}", fmt::join(light_factors(prepared, exposure), " "))},
        {layer_attributes::ambient, fmt::format("{} {} {}", ambient.r, ambient.g, ambient.b)},
        {layer_attributes::materials, fmt::format("{}", fmt::join(materials, " "))}};
}

} // namespace

void check_layers_name(const std::string& path) {
    const auto format = format_from_extension(path);
    if (!format || sample_type(*format) != SampleType::float32 || *format == ImageFileFormat::pfm)
        throw CommandLineError(fmt::format(
            "--layers writes EXR; name the file so, as in layers.exr; found '{}'", path));
}

void write_layers(
    const PreparedScene& prepared,
    const RayIndex& index,
    const PictureMetadata& metadata,
    OutputFile& file,
    const Console& console) {
    const PictureSettings& settings = prepared.settings;
    TracedScene traced = traced_scene(prepared.scene, index, settings, &console.cancel);
    RenderStatistics statistics;
    double exposure = 1;
    if (settings.exposure)
        exposure = expose(traced, prepared.camera, *settings.exposure, statistics).factor;

    PictureMetadata all = metadata;
    const PictureMetadata more = layer_metadata(prepared, traced, exposure);
    all.insert(all.end(), more.begin(), more.end());
    const std::vector<PictureLayer> layers = picture_layers(traced);
    LayersWriter writer(file, settings.width, settings.height, layer_channels(layers), all);
    const CancellableWork work;
    ProgressDisplay display(console, "layers");
    render_layers(
        traced,
        {ViewRays(prepared.camera), settings.width, settings.height},
        layers,
        [&](std::size_t /*y*/, std::size_t rows, std::span<const std::uint32_t> words) {
            writer.write_rows(rows, words);
        },
        display.callback());
    writer.finish();
}

} // namespace vera
