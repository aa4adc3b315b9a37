// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/packet_query.h"

#include <array>

namespace vera::detail {

/// A sphere for each lane.
struct SphereRows {
    std::array<RayRows::Row, 3> center;
    RayRows::Row radius;
};

/// A rotational shape for each lane of which the contour is one line, no ring.
struct MantleRows {
    std::array<RayRows::Row, 3> base;
    std::array<RayRows::Row, 3> axis;
    RayRows::Row start_r;
    RayRows::Row start_h;
    RayRows::Row end_r;
    RayRows::Row end_h;
};

/// Where lanes' rays meet what each is asked about.
struct RoundCrossings {
    LaneMask undecided = 0; ///< lanes whose crossings take more than a closed formula
    std::array<LaneMask, 2> met = {};
    std::array<RayRows::Row, 2> t;
};

/// Each lane's ray, by the caller's word starting there or not, with its sphere, as
/// for_each_sphere_crossing() does it, to the bit.
void cross_spheres(
    const Frame& frame,
    LaneMask lanes,
    LaneMask starting,
    const SphereRows& spheres,
    RoundCrossings& crossings);

/// The same with its mantle, as for_each_rotational_crossing() does it.
void cross_mantles(
    const Frame& frame,
    LaneMask lanes,
    LaneMask starting,
    const MantleRows& mantles,
    RoundCrossings& crossings);

} // namespace vera::detail
