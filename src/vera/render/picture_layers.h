// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/layers_file.h"
#include "vera/math/color.h"
#include "vera/render/generations.h"
#include "vera/render/raster.h"
#include "vera/render/ray_terms.h"
#include "vera/render/statistics.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace vera {

/// A part of the picture's light: one term of the lighting formula (VERA 2.3), on one way.
struct PictureLayer {
    std::string name;       ///< "mirrored.light2.diffuse"
    std::size_t number = 0; ///< as of term_number()

    static constexpr const char* rounding = "rounding"; ///< the name of the last layer
};

/// The layers whose sum is the scene's picture, in the order in which they are to be added: that of
/// their names, by bytes. Behind them comes one more, PictureLayer::rounding.
std::vector<PictureLayer> picture_layers(const TracedScene& traced);

/// The red, green and blue of a layer at a pixel.
using LayerSample = std::array<float, 3>;

/// What the layers, and behind them the rounding, hold where a ray sees the colour, of which these
/// are the terms. The samples are not linear light: 1 is what a screen shows as full. Added in
/// floats, in order, they give the float nearest to the colour that is developed to the same byte;
/// or one within rounding of it where a negative colour of the scene makes terms cancel each other
/// almost wholly.
std::vector<LayerSample>
layer_samples(std::span<const PictureLayer> layers, std::span<const Color> terms, Color color);

/// The sum that layers stand for: in floats, one after another.
LayerSample layer_sum(std::span<const LayerSample> samples);

/// The channels of a picture in layers: R, G and B of each layer and of the rounding, then what is
/// seen. Z is the distance from the view point (of parallel rays from the image plane), infinite
/// where nothing is seen; normal.X, Y and Z the unit normal, turned to the viewer; position.X, Y
/// and Z the place in the scene; object.id and material.id number from 1, 0 being nothing. Objects
/// are primitives in text order, subscenes expanded; beyond 2^32 - 1 the numbers begin anew. A
/// missing material comes behind the scene's.
std::vector<LayerChannel> layer_channels(std::span<const PictureLayer> layers);

/// Takes the rows of a picture from y on: words[(c * rows + row) * width + x] holds channel c as
/// its four bytes are.
using LayerRowsSink =
    std::function<void(std::size_t y, std::size_t rows, std::span<const std::uint32_t> words)>;

/// The layers of the ray traced picture, one ray through the centre of each pixel, from the top
/// down. The same bits for any number of threads and any index. Holds some rows at a time. Throws
/// Cancelled soon after the flag is raised, and what the sink throws.
RenderStatistics render_layers(
    const TracedScene& traced,
    const Raster& raster,
    std::span<const PictureLayer> layers,
    const LayerRowsSink& sink,
    const Progress& progress = {});

} // namespace vera
