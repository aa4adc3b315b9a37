// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/border_ring.h"

namespace vera {

/// The ring without straight sides that lead to and fro within 0.02 pixels: a crack between two
/// areas that meet, but for rounding, through which nothing can be seen. What smooths edges may
/// look along few lines of each pixel, and shows more of a crack in the direction of one than
/// there is. May be empty.
BorderRing without_cracks(const BorderRing& ring);

} // namespace vera
