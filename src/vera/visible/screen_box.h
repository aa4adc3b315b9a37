// SPDX-License-Identifier: Apache-2.0
// Rectangles of the grid along its axes, and what meets them.
#pragma once

#include "vera/exact/screen_point.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace vera {

/// From the least to the most, both included; one that nothing was added to meets none.
struct ScreenRange {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    std::int64_t most = std::numeric_limits<std::int64_t>::min();

    void include(std::int64_t value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }

    bool meets(const ScreenRange& other) const {
        return least <= other.most && other.least <= most;
    }
};

/// All points with these coordinates.
struct ScreenBox {
    ScreenRange x;
    ScreenRange y;
};

/// Whether the box has a point of the segment or convex polygon: exactly where no line parts them,
/// of those along the axes and along the sides of the figure (the theorem of separating axes).
inline bool do_meet(const ScreenBox& box, std::span<const ScreenPoint> corners) {
    ScreenBox around;
    for (const ScreenPoint corner : corners) {
        around.x.include(corner.x);
        around.y.include(corner.y);
    }
    if (!around.x.meets(box.x) || !around.y.meets(box.y))
        return false;
    const std::size_t sides = corners.size() == 2 ? 1 : corners.size();
    for (std::size_t i = 0; i < sides; ++i) {
        const ScreenPoint a = corners[i];
        const ScreenStep side = step(a, corners[i + 1 == corners.size() ? 0 : i + 1]);
        ScreenRange of_figure;
        for (const ScreenPoint corner : corners)
            of_figure.include(cross(side, step(a, corner)));
        ScreenRange of_box;
        for (const std::int64_t x : {box.x.least, box.x.most})
            for (const std::int64_t y : {box.y.least, box.y.most})
                of_box.include(cross(side, {x - a.x, y - a.y}));
        if (!of_figure.meets(of_box))
            return false;
    }
    return true;
}

} // namespace vera
