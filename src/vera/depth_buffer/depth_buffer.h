// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/front_order.h"
#include "vera/scene/pixel_part.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// A triangle on the grid of the picture. Its corners go round to the left, and it has an area.
struct DepthTriangle {
    std::array<ScreenVertex, 3> corners;
    std::uint32_t source = 0; ///< of what it is a part: of coincident ones the smaller is in front
};

/// The samples of a picture: across x down in each pixel, at the middles of equal rectangles.
struct DepthSamples {
    std::size_t width = 0; ///< of the picture, in pixels
    std::size_t height = 0;
    std::size_t across = 1;
    std::size_t down = 1;
};

/// The steps of a depth buffer, which are the same on every machine.
struct DepthCounts {
    std::uint64_t filled = 0;   ///< samples of each triangle, covered or not by others before
    std::uint64_t compared = 0; ///< of these, with what was there
};

/// The depth buffer (Catmull 1974): at each sample, of the triangles that cover it, the nearest is
/// kept. Which samples a triangle covers is decided in whole numbers, its sides included, and which
/// of two triangles is in front as in drawings: see front_order.h. What passes through another is
/// compared sample by sample, and so needs no cutting. The buffer is filled band by band, so that
/// memory does not grow with the picture.
class DepthBuffer {
public:
    /// At most 2^24 samples along a side. The triangles are copied.
    DepthBuffer(std::span<const DepthTriangle> triangles, const DepthSamples& samples);

    /// The sources that the samples of a band see, row by row; PixelPart::background where none is.
    /// May be called from many threads. Steps are added to the counts, if there are any.
    void
    see(std::size_t band, std::vector<std::uint32_t>& sources, DepthCounts* counts = nullptr) const;

    /// The same as parts of pixels, in the order of pixels and then of sources: an area is the part
    /// of the samples, and its middle theirs.
    void add_parts(std::size_t band, std::vector<PixelPart>& parts) const;

    PixelBands bands() const { return {samples_.width, samples_.height}; }

private:
    struct Face {
        FrontFace face;
        std::uint32_t source = 0;
    };

    std::size_t columns() const { return samples_.width * samples_.across; }

    std::size_t rows() const { return samples_.height * samples_.down; }

    void sort_into_bands();
    void cover(
        std::uint32_t triangle,
        std::size_t row,
        std::span<std::uint32_t> seen,
        DepthCounts& counts) const;
    bool is_in_front(std::uint32_t one, std::uint32_t other, NearnessPlace place) const;

    DepthSamples samples_;
    std::vector<Face> faces_;
    std::vector<std::size_t> starts_; ///< band i has the triangles [starts_[i]] to the next start
    std::vector<std::uint32_t> listed_;
};

} // namespace vera
