// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/picture_settings.h"
#include "vera/visible/border_ring.h"
#include "vera/visible/map_sources.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// Where the borders of a map's regions are drawn.
struct DrawnBorders {
    std::vector<DrawingPoint> places; ///< of the map's vertices
    /// Of the sides that begin with each ring_vertices[i]; or empty: all are straight.
    std::vector<std::uint32_t> side_curves;
    BorderCurves curves;

    /// Number i of the map's ring_vertices and what leads on from it; no node.
    BorderPoint point(const VisibleMap& map, std::size_t i) const {
        return {places[map.ring_vertices[i]], side_curves.empty() ? no_curve : side_curves[i]};
    }

    BorderRing ring(const VisibleMap& map, const VisibleMap::Ring& ring) const;
};

/// Straight from vertex to vertex, exactly.
DrawnBorders straight_borders(const VisibleMap& map, const PictureSettings& picture);

/// Along the ellipse of a curved primitive where a side lies on it within the deviation. A vertex
/// there moves to where the ellipse crosses what else ends in it, or else to the ellipse's nearest
/// point; no border moves farther than the deviation. Both regions beside a border have the same
/// curve and vertices, and what is on the frame stays on it. Throws Cancelled.
DrawnBorders curved_borders(
    const MapSources& sources, const Progress& progress = {}, const CancelFlag* cancel = nullptr);

} // namespace vera
