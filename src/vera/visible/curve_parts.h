// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/line_chains.h"

#include <vector>

namespace vera {

/// Where a part of a curve begins and ends on it.
struct CurveDegrees {
    double begin = 0;
    double end = 0;
};

/// Makes one part of those that lie on a curve beside or upon each other, which facets make where
/// the curve is one: of each place of a curve only the line of the foremost class there is left,
/// and gaps of less than the tolerance, in pixels, are closed. The ends of parts on curves are on
/// these; points that are new are added to the places. The parts on curves are the last ones then:
/// returns where each of these is. Throws Cancelled.
std::vector<CurveDegrees> unite_on_curves(
    const OutlineCurves& curves,
    double tolerance,
    const CancelFlag* cancel,
    std::vector<LinePart>& parts,
    std::vector<DrawingPoint>& places);

} // namespace vera
