// SPDX-License-Identifier: Apache-2.0
// The bounds of finding what is visible, term by term, and the plane sweep counted beside its own.
#pragma once

#include "vera/theory/experiment.h"
#include "vera/visible/plane_sweep.h"

#include <vector>

namespace vera {

/// (n + k) log n, of n edges with k crossings: VERA, appendix.
const std::vector<BoundTerm>& sweep_terms();

/// (n + v) log^2 n, of n triangles or rectangles of which v corners are seen.
const std::vector<BoundTerm>& seen_terms();

/// The steps of a plane sweep of the scene, of which that is the size, by sweep_terms().
CountedSize steps_of_sweep(const ScreenScene& scene, std::size_t size, const CancelFlag* cancel);

} // namespace vera
