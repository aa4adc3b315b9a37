// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/scene/facets.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/line_chains.h"

#include <span>
#include <vector>

namespace vera {

/// Leaves out lines that are there because curved surfaces are drawn as facets, of which some along
/// a silhouette cover parts of others: lines to a loose end where one covers its neighbour, or, if
/// no longer than the tolerance, in pixels, another one of the same primitive; and hidden parts
/// that are nowhere farther than that from a silhouette of the same primitive that is seen. places
/// are those of the points. Throws Cancelled.
void leave_out_second_lines(
    const Facets& facets,
    const DrawnFaces& faces,
    std::span<const DrawingPoint> places,
    double tolerance,
    const CancelFlag* cancel,
    std::vector<LinePart>& parts);

} // namespace vera
