// SPDX-License-Identifier: Apache-2.0
// The bounds of finding what is visible, term by term, and the plane sweep counted beside its own:
// what the curves of triangles, terrains and rectangles have in common.
#pragma once

#include "vera/theory/experiment.h"
#include "vera/visible/plane_sweep.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// (n + k) log n, of n edges with k crossings: VERA, appendix.
const std::vector<BoundTerm>& sweep_terms();

/// (n + v) log^2 n, of n triangles or rectangles of which v corners are seen.
const std::vector<BoundTerm>& seen_terms();

/// The steps of a plane sweep of the scene, of which that is the size, by sweep_terms().
CountedSize steps_of_sweep(const ScreenScene& scene, std::size_t size, const CancelFlag* cancel);

/// Tells on a curve what steps_of_sweep() counts, and its bound.
void set_sweep_bound(Experiment& experiment);

/// Counts the steps of what is made of a size and a seed.
template <typename Input>
CountOfSize count_of_made(
    Input (*make)(std::size_t size, std::uint64_t seed),
    CountedSize (*count_steps)(const Input& input, const CancelFlag* cancel)) {
    return [=](std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        return count_steps(make(size, seed), cancel);
    };
}

} // namespace vera
