// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/map_strips.h"
#include "vera/visible/screen_scene.h"
#include "vera/visible/visible_map.h"

#include <cstdint>

namespace vera {

/// What a map shows at a place.
struct MapPlace {
    std::uint32_t source = no_source;
    /// Whether the rings that go round the place are those of this source alone, and go round it
    /// once. Only a map that is wrong says no.
    bool is_sound = true;
};

/// Finds what a map shows at a point, by the sides in a strip of the picture: as many steps as some
/// square roots of the number of sides. May be asked from many threads.
class MapLocator {
public:
    /// Throws Cancelled.
    explicit MapLocator(const VisibleMap& map, const CancelFlag* cancel = nullptr);

    /// The point is in steps of the grid. On a side, either of what lies beside it.
    MapPlace at(double x, double y) const;

    /// Whether a side of the map comes as near to the point as the border of an ellipse round it
    /// with these half axes, in steps.
    bool has_side_near(double x, double y, double reach_x, double reach_y) const;

private:
    MapStrips strips_;
};

} // namespace vera
