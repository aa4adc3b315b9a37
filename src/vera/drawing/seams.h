// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/snapped_path.h"

#include <cstdint>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace vera::detail {

// Where two outlines abut, a viewer that smooths edges mixes each with what is below it, and the
// background shines through: where each covers half of a pixel, a quarter of it is left. So along a
// seam, which is a part of a border beyond which a later outline lies, a line in the outline's own
// colour is painted right behind the outline. It fills the pixels that the border divides, and the
// later outline then covers the half of the line that lies beyond the border: the border stays
// where it is. A border with the background is no seam, gets no line, and stays where it is too.

/// The seams after rounding. Those that follow upon one another are one, round the beginning of the
/// list too: the line there has a round join, which leaves no gap.
std::vector<SnappedPath> joined_seams(const FilledOutline& fill, const Lattice& lattice);

/// The points that joined seams pass through and do not end in: what is below them is covered all
/// round.
class PassedPoints {
public:
    void add(std::span<const SnappedPath> seams);
    bool contains(SnappedPoint point) const;

private:
    std::unordered_map<std::int64_t, std::unordered_set<std::int64_t>> y_of_x_;
};

/// Draws the ends of seams back so that lines of that width in units, with butt caps, do not stick
/// out at their corners where the rings' border goes on at a slant: far enough for a border that
/// goes on straight beyond the seam, but no farther than half the width, and half of that at points
/// that another seam passes, as its line covers no more for sure. Leaves out seams that are too
/// short.
void draw_ends_back(
    std::vector<SnappedPath>& seams,
    std::span<const SnappedPath> rings,
    const PassedPoints& passed,
    double width);

} // namespace vera::detail
