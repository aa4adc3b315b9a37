// SPDX-License-Identifier: Apache-2.0
// Tests are given the points that curves are counted of.
#pragma once

#include "vera/theory/plane_points.h"

namespace vera::testing {

using vera::circle_points;
using vera::collinear_points;
using vera::column_points;
using vera::crowded_points;
using vera::extreme_points;
using vera::lattice_points;
using vera::PlanePoints;
using vera::point_families;
using vera::PointFamily;
using vera::repeated_points;
using vera::scattered_points;
using vera::some_normal;
using vera::strip_near;
using vera::thin_diagonal_points;

} // namespace vera::testing
