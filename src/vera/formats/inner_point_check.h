// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"
#include "vera/scene/geometry.h"

#include <cstddef>
#include <vector>

namespace vera {

/// Of the faces (P3, P4, PN, PA) among the items [first, last), which share an inner point, those
/// for which it is on the wrong side: the corners of all others lie on the face's plane or beyond
/// it, away from the inner point, at least one of them beyond. Takes about the time of reading the
/// faces; where that does not do, of very many faces, the last are taken to be right.
std::vector<std::size_t>
faces_with_inner_point_on_wrong_side(const Geometry& geometry, std::size_t first, std::size_t last);

} // namespace vera
