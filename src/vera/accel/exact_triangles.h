// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/packet_query.h"

#include <array>
#include <cstdint>

namespace vera::detail {

/// A triangle for each lane: the coordinates of its corners.
using TriangleRows = std::array<std::array<RayRows::Row, 3>, 3>;

/// The lanes' rays as triangle_crossing() wants them: PreparedRay, row by row.
void prepare_rays(Frame& frame);

/// Each lane's ray with its triangle, as triangle_crossing() does it, to the bit: returns those of
/// the lanes that meet theirs, and the t at which they do. The frame's rays must be prepared.
LaneMask
cross_triangles(const Frame& frame, LaneMask lanes, const TriangleRows& triangles, RayRows::Row& t);

/// An element for each of some lanes.
struct TakenCandidates {
    std::array<std::uint32_t, packet_size> elements;  ///< their numbers
    std::array<LaneMask, element_kinds> of_kind = {}; ///< the lanes whose elements are of each kind
};

/// Takes the next candidate of each of the lanes that has one before its limit out of the frame's
/// candidates. Returns those lanes.
LaneMask take_candidates(Frame& frame, LaneMask lanes, TakenCandidates& taken);

} // namespace vera::detail
