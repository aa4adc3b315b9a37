// SPDX-License-Identifier: Apache-2.0
// The three strategies that the VERA paper compares (3.4), on one scene that lies on the grid of
// the picture: a depth buffer, visible surfaces, and rays. What each finds are the sources that are
// seen at the middles of pixels, and how many steps that took; so their pictures can be compared
// point by point, and their bounds with what was counted. Light is counted as the table has it: a
// shadow ray for each pixel and light, or what is visible from the light.
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/accel/wide_bvh.h"
#include "vera/depth_buffer/depth_buffer.h"
#include "vera/math/vec3.h"
#include "vera/scene/scene.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace vera {

/// The sources at the middles of side x side pixels, row by row; no_source where none is.
using PixelSources = std::vector<std::uint32_t>;

/// By a depth buffer; counts grow.
PixelSources sources_by_depth(const ScreenScene& scene, std::size_t side, DepthCounts& counts);

/// By the visible map of these pieces.
PixelSources
sources_by_map(const ScreenScene& scene, const VisiblePieces& pieces, std::size_t side);

/// Rays among the triangles where they lie on the grid: nearness is a coordinate, divided by a
/// power of two so that all three have the same length, and nothing is rounded.
class GridRays {
public:
    /// From where light comes: x and y by nearness.
    struct Light {
        double x = 0;
        double y = 0;
    };

    /// Builds a hierarchy of boxes. Throws as make_wide_bvh().
    explicit GridRays(const ScreenScene& scene);

    /// Of a ray through each pixel's middle, row by row; counts grow.
    std::vector<Hit> hits(std::size_t side, QueryCounts& counts) const;

    PixelSources sources(std::span<const Hit> hits) const;

    /// From how many of these hits the light is seen: a ray from each that found something.
    std::size_t lit(std::span<const Hit> hits, Light light, QueryCounts& counts) const;

    std::size_t bytes() const { return index_->memory(); }

private:
    Scene scene_;
    std::vector<std::uint32_t> sources_; ///< of the scene's primitives
    std::unique_ptr<WideBvh> index_;
};

/// The scene as a light sees it, on a grid of its own, to which corners are rounded. The light
/// comes at a slant of 0.3 at most each way.
ScreenScene seen_from(const ScreenScene& scene, GridRays::Light light);

} // namespace vera
