// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/render/generations.h"
#include "vera/scene/camera.h"

#include <cstddef>
#include <optional>
#include <span>

namespace vera {

/// What a ray sees when the light is multiplied by s, in each colour: s * scaled + fixed.
struct ExposureSample {
    Color scaled;
    Color fixed; ///< what comes from self-luminosity and sky
};

/// How bright a picture becomes, told by one ray through each pixel of a 64 x 64 raster. The
/// brightness of rays is the nearest-rank 95 % quantile of their largest colours; 1 is full scale.
struct Exposure {
    std::size_t rays = 0;              ///< that hit something; no others count
    double target = 0;                 ///< EXPMES; 0 measures only
    double brightness = 0;             ///< as the scene is; 0 when nothing is hit
    double part_too_bright = 0;        ///< of these rays: exceeds 1 in some colour
    std::optional<double> full_factor; ///< by which the light would have to be multiplied for a
                                       ///< brightness of 1; nothing when none does it
    double factor = 1;                 ///< by which the light was multiplied
    bool reachable = true;             ///< false: no factor gives the target, and it is 1
};

/// 0 without samples.
double brightness(std::span<const ExposureSample> samples, double factor);

/// The factor > 0 that makes the brightness equal the target: 1 if it does, else the largest that
/// does. Light is never negative.
std::optional<double> exposure_factor(std::span<const ExposureSample> samples, double target);

/// Measures and, when target > 0, multiplies the light sources and AMBIENT.
Exposure
expose(TracedScene& traced, const Camera& camera, double target, RenderStatistics& statistics);

} // namespace vera
