// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/packet_query.h"
#include "vera/scene/outline_table.h"

#include <array>

namespace vera::detail {

/// How lanes' rays meet a polygon.
struct PolygonCrossings {
    LaneMask met = 0;
    LaneMask undecided = 0; ///< those that pass near its outline
    RayRows::Row t;         ///< of those that meet it
};

/// Each lane's ray with one polygon of an outline, as polygon_crossing() does it, to the bit, where
/// the ray passes it far enough from its sides. The frame's rays must be prepared.
void cross_polygon(
    const Frame& frame,
    LaneMask lanes,
    const Vec3& first_corner,
    const Vec3& normal,
    const OutlineTable& table,
    const OutlineStrips& outline,
    PolygonCrossings& crossings);

/// A polygon of four corners for each lane.
struct QuadrangleRows {
    std::array<std::array<RayRows::Row, 3>, 4> corners;
    std::array<RayRows::Row, 3> normal;
};

/// Each lane's ray with its quadrangle, as polygon_crossing() does it, to the bit: returns those of
/// the lanes that meet theirs, and the t at which they do. The frame's rays must be prepared.
LaneMask cross_quadrangles(
    const Frame& frame, LaneMask lanes, const QuadrangleRows& quadrangles, RayRows::Row& t);

} // namespace vera::detail
