// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/render/raster.h"
#include "vera/render/tiles.h"

#include <array>
#include <vector>

namespace vera {

/// Finds the rays through the centres of the pixels of a tile and of a frame around it, which may
/// lie outside the picture, several at a time with the instruction set that the machine has: to the
/// bit those of Raster::ray(), square by square as in for_each_pixel(). Keeps its buffers from one
/// tile to the next.
class CenterRays {
public:
    /// Of the rays nothing but origin and direction, and where all rays are parallel t_min, is
    /// overwritten: they have to be at their defaults otherwise.
    void find(
        const Raster& raster,
        const Tile& tile,
        std::vector<QueryRay>& rays,
        std::size_t frame_width = 0);

private:
    using Rows = std::array<std::vector<double>, 3>; ///< vectors, coordinate by coordinate

    Rows columns_;
    Rows directions_; ///< row by row of pixels
};

} // namespace vera
