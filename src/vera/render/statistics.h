// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"

#include <cstdint>

namespace vera {

/// How many rays a picture took, and what they cost.
struct RenderStatistics {
    std::uint64_t view_rays = 0;       ///< one a pixel, and those of anti-aliasing
    std::uint64_t extra_view_rays = 0; ///< those of the view rays that anti-aliasing added
    std::uint64_t probe_rays = 0;      ///< ask only what is hit, and are no view rays
    std::uint64_t shadow_rays = 0;
    std::uint64_t mirrored_rays = 0; ///< total reflection included
    std::uint64_t refracted_rays = 0;
    std::uint64_t refined_pixels = 0; ///< by anti-aliasing
    std::uint64_t parts = 0;          ///< of pixels, lit in place of view rays: see render_parts()
    QueryCounts queries;              ///< of all these rays

    RenderStatistics& operator+=(const RenderStatistics& more) {
        view_rays += more.view_rays;
        extra_view_rays += more.extra_view_rays;
        probe_rays += more.probe_rays;
        shadow_rays += more.shadow_rays;
        mirrored_rays += more.mirrored_rays;
        refracted_rays += more.refracted_rays;
        refined_pixels += more.refined_pixels;
        parts += more.parts;
        queries += more.queries;
        return *this;
    }
};

} // namespace vera
