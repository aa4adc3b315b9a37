// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/experiment.h"
#include "vera/theory/growth.h"
#include "vera/theory/growth_models.h"
#include "vera/theory/residual_bootstrap.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vera {

/// How counts grow beside their bound.
enum class Verdict {
    below, ///< slower, for certain
    along, ///< as fast, as far as can be told
    above  ///< faster, for certain
};

/// "below the bound", "along the bound", "above the bound for certain"
const char* verdict_text(Verdict verdict);

/// An experiment at several sizes, and the powers fitted to the upper half of them, where what is
/// constant matters least.
struct Curve {
    const Experiment* experiment = nullptr;
    std::uint64_t seed = 0;
    std::vector<CountedSize> points; ///< by size
    std::size_t first_fitted = 0;    ///< of the points; those from it on are fitted
    Growth growth;                   ///< of the counts
    Growth bound_growth; ///< of the bound at the same inputs: logarithms look like powers
    Growth excess;       ///< of the counts by the bound
    Verdict verdict = Verdict::along;
    ResampledGrowth resampled;        ///< the growth, checked by a bootstrap
    ResampledGrowth resampled_excess; ///< and the excess
    Verdict resampled_verdict = Verdict::along;
    std::vector<ModelFit> models; ///< what formula the counts follow

    /// Whether the check by a bootstrap comes to another verdict.
    bool is_contradicted() const { return resampled_verdict != verdict; }

    std::span<const CountedSize> fitted() const { return std::span(points).subspan(first_fitted); }

    /// From each size to the next: see growth.h.
    std::vector<double> local_exponents() const;
};

/// Those of each name, which stand in a row.
std::vector<std::span<const Curve>> curves_by_name(std::span<const Curve> curves);

/// The fewest and the most sizes of a curve.
constexpr std::size_t least_sizes_of_curve = 4;
constexpr std::size_t most_sizes_of_curve = 64;

/// Why a curve cannot be counted at the sizes, with what would be right; empty where it can. They
/// must ascend, be no fewer than 4 and no more than 64, and none larger than the experiment's most.
std::string problem_with_sizes(const Experiment& experiment, std::span<const std::size_t> sizes);

/// Counts the experiment at each size, one after the other; the seed of each follows from the one
/// given. Throws std::invalid_argument with problem_with_sizes(), and where inputs of two sizes
/// come out the same size; and as the experiment does.
Curve counted_curve(
    const Experiment& experiment,
    std::span<const std::size_t> sizes,
    std::uint64_t seed = 1,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// The fits and the verdict of what was counted: of 4 points or more, by size.
Curve fitted_curve(
    const Experiment& experiment, std::uint64_t seed, std::vector<CountedSize> points);

} // namespace vera
