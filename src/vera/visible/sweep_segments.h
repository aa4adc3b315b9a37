// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/exact/screen_point.h"
#include "vera/visible/edges.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The edges of a scene as segments of which no two have more than one point in common: where edges
/// lie upon each other, they are cut at each other's ends, and each part is there once.
struct SweepSegments {
    struct Segment {
        ScreenPoint begin; ///< before end by x, then by y
        ScreenPoint end;
    };

    /// A triangle that ends at a segment, which is a part of this edge of it.
    struct Border {
        std::uint32_t triangle = 0;
        std::uint32_t edge = 0;
        bool is_above = false; ///< the triangle lies to the left of the way from begin to end
    };

    std::vector<Segment> segments;
    std::vector<std::size_t> starts; ///< segment i has the borders [starts[i]] to [starts[i + 1]]
    std::vector<Border> borders;

    std::span<const Border> borders_of(std::uint32_t segment) const {
        return std::span(borders).subspan(starts[segment], starts[segment + 1] - starts[segment]);
    }
};

/// Throws Cancelled.
SweepSegments sweep_segments(
    const ScreenScene& scene, const ScreenEdges& edges, const CancelFlag* cancel = nullptr);

} // namespace vera
