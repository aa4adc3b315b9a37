// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/pixel_part.h"
#include "vera/visible/map_strips.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <vector>

namespace vera {

/// Scan conversion of a map: what is seen in each pixel of a picture, and how much of it. All of it
/// in double precision, from the map's corners as these are. May be asked from many threads.
class MapRaster {
public:
    /// Throws Cancelled.
    MapRaster(
        const VisibleMap& map,
        std::size_t width,
        std::size_t height,
        const CancelFlag* cancel = nullptr);

    /// Adds what the middle of each pixel shows, as one part of area 1.
    void add_centers(std::size_t band, std::vector<PixelPart>& parts) const;

    /// Adds all that each pixel shows, by source, each source as one part: its exact area, a sum of
    /// trapezoids, and its centroid. (What covers less than 2^-24 of a pixel is left out.) So a
    /// picture is filtered by the pixel's own square, without samples.
    void add_areas(std::size_t band, std::vector<PixelPart>& parts) const;

    PixelBands bands() const { return bands_; }

private:
    PixelBands bands_;
    MapStrips strips_; ///< one for each band
};

} // namespace vera
