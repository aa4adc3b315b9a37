// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/render/render_scene.h"
#include "vera/scene/facets.h"
#include "vera/scene/pixel_part.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace vera {

/// What is seen in a picture, found before any ray.
struct PictureParts {
    /// Adds what a band of the picture shows (see PixelBands), pixel by pixel, row by row. Called
    /// from many threads.
    using OfBand = std::function<void(std::size_t band, std::vector<PixelPart>& parts)>;

    /// Of the scene; a part's source is the number of one of them, or PixelPart::background.
    const Facets& facets;
    OfBand of_band;
};

/// The picture of which others have found the parts: the lighting formula, and what it sends on
/// from mirrors and glass and to the lights, is that of render_scene(), once for each part, in its
/// middle; but no view rays are asked. Where the middle of a part lies on the primitive itself, and
/// not on its facet alone, it is lit as a ray through it is, to the bit. Settings as in
/// render_scene(), but with anti-aliasing colours are averaged by the areas of the parts, and
/// background that shows sky and earth is the mean of both in its pixel. Throws Cancelled soon
/// after the flag is raised.
RenderResult render_parts(
    const Scene& scene,
    const Camera& camera,
    const RayIndex& index,
    const PictureParts& seen,
    const PictureSettings& settings,
    SampleType sample_type,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
