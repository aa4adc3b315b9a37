// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/scene/horizon_profile.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace vera {

/// SKY, HORIZON, EARTH and PROFILE, with the defaults of missing colours filled in.
struct Firmament {
    Color sky;
    Color horizon;
    Color earth;
    std::optional<HorizonProfile> profile = {}; ///< where the earth ends; none: at the level
};

/// Anti-aliasing by controlled oversampling.
struct Antialiasing {
    bool on = true;
    std::uint32_t samples = 16;   ///< rays of a refined pixel: a power of two from 2 to 256
    double tolerance = 3.0 / 255; ///< difference of neighbours, in any colour, that refines a pixel
};

/// What the settings may be, whether a control file or a command line says them.
struct PictureLimits {
    static constexpr std::uint32_t longest_side = 1'000'000; ///< of the picture, in pixels
    static constexpr std::uint32_t deepest = 1000;           ///< levels of the ray tree
    static constexpr std::uint32_t most_samples = 256;
    static constexpr double widest_margin = 0.5;   ///< less than that: something must be left
    static constexpr double largest_aspect = 1000; ///< and the smallest is 1 / 1000
};

/// What a control file says. The members' values are those without any control file; what a control
/// file does not name is off or at its default.
struct PictureSettings {
    std::uint32_t width = 512;      ///< RASTER, pixels across
    std::uint32_t height = 512;     ///< RASTER, pixels down
    std::uint32_t depth = 2;        ///< RTDEPTH, levels of the ray tree; 1 is the view ray alone
    std::optional<double> exposure; ///< EXPMES: 0 measures only, (0, 1] scales the light
    Color ambient;                  ///< AMBIENT
    std::optional<Firmament> firmament;
    bool shadows = true;                ///< SHADOWS
    Antialiasing antialiasing;          ///< ANTI-ALIAS
    std::optional<double> frame_margin; ///< automatic framing; the margin, as part of the picture
    double pixel_aspect = 1; ///< width of a pixel by its height, used by automatic framing
    /// LIGHTS: what each of the scene's lights is multiplied by, in their order; empty where the
    /// lights stay as they are. Whoever reads a scene applies them: see scale_lights().
    std::vector<double> light_factors = {};
    std::uint32_t light_factors_line = 0; ///< of the control file, for messages; 0: none
};

} // namespace vera
