// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/math/box3.h"

#include <cstdint>
#include <functional>
#include <span>

namespace vera {

/// Calls visit(i, k) once for each pair of boxes that have a point in common, in an order that
/// depends on the boxes alone; i < k. Boxes that spread over space take about n log n. Throws
/// Cancelled.
void for_each_box_pair(
    std::span<const Box3> boxes,
    const std::function<void(std::uint32_t, std::uint32_t)>& visit,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
