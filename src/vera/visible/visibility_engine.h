// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vera {

/// How what is visible is found. Both ways find the same.
enum class VisibilityEngine : std::uint8_t {
    cells, ///< cell_raster()
    sweep, ///< plane_sweep()
};

} // namespace vera
