// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"
#include "vera/visible/sweep_counts.h"

#include <cstdint>
#include <optional>

namespace vera {

struct PlaneSweepSettings {
    /// Bytes of memory that the sweep may take; without, what available_memory() tells.
    std::optional<std::uint64_t> most_bytes;
    PlaneSweepCounts* counts = nullptr; ///< are filled in
};

/// What plane_sweep() will be about.
struct SweepForecast {
    double crossings = 0; ///< of edges: from pairs drawn at random, where there are many
    double bytes = 0;
};

/// By a sweep over the picture that meets every crossing of edges, of hidden ones as well
/// (appendix of the VERA paper): O((n + k) log n) steps for n edges and k crossings, apart from
/// moving entries of sets of the triangles that lie one behind the other. The same pieces as
/// cell_raster(), in the same order, but for corners at which nothing else that is seen ends: there
/// those of the cells are cut in two. Throws std::runtime_error where memory would not suffice.
VisiblePieces plane_sweep(
    const ScreenScene& scene,
    const PlaneSweepSettings& settings = {},
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// What plane_sweep() of the scene would take; off by a third or so where there are many crossings.
SweepForecast sweep_forecast(const ScreenScene& scene);

} // namespace vera
