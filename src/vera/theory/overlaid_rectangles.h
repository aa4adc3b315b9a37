// SPDX-License-Identifier: Apache-2.0
// Rectangles one behind the other, of which little or much is seen. Curves are counted of them, and
// answers compared. The same on every machine.
#pragma once

#include "vera/theory/iso_rectangle.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// A way to make about so many, within the grid of the picture.
struct OverlaidFamily {
    const char* name;
    const char* input; ///< for people
    std::vector<IsoRectangle> (*rectangles)(std::size_t count, std::uint64_t seed);
};

/// Squares anywhere, each at a depth of its own, as many one behind the other whatever their number
/// is: k and v grow with n.
std::vector<IsoRectangle> scattered_squares(std::size_t count, std::uint64_t seed);

/// Cards of one size held in one hand, each a bit to the right of and above the one before it: all
/// of them cross each other, n^2 crossings, and a strip of each is seen.
std::vector<IsoRectangle> hand_of_cards(std::size_t count, std::uint64_t seed);

/// Half of them upright bars, and behind these the other half, which lie across: n^2 crossings, all
/// seen.
std::vector<IsoRectangle> grate_of_bars(std::size_t count, std::uint64_t seed);

/// The same behind one square that is all that is seen.
std::vector<IsoRectangle> hidden_grate_of_bars(std::size_t count, std::uint64_t seed);

/// All of these.
const std::vector<OverlaidFamily>& overlaid_families();

} // namespace vera
