// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/grid_structures.h"

namespace vera::detail {

/// The record of an element that lies within the box; both in local coordinates.
ElementRecord element_record(const GeometryGrids& grids, Element element, const Box3& local_box);

} // namespace vera::detail
