// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/visible_surface_terms.h"

#include "vera/math/elementary.h"

namespace vera {

namespace {

double log_squared(double n) {
    return log2_of(n) * log2_of(n);
}

} // namespace

const std::vector<BoundTerm>& sweep_terms() {
    static const std::vector<BoundTerm> terms = {
        {"n log n", [](std::span<const double> nk) { return nk[0] * log2_of(nk[0]); }},
        {"k log n", [](std::span<const double> nk) { return nk[1] * log2_of(nk[0]); }}};
    return terms;
}

const std::vector<BoundTerm>& seen_terms() {
    static const std::vector<BoundTerm> terms = {
        {"n log^2 n", [](std::span<const double> nv) { return nv[0] * log_squared(nv[0]); }},
        {"v log^2 n", [](std::span<const double> nv) { return nv[1] * log_squared(nv[0]); }}};
    return terms;
}

CountedSize steps_of_sweep(const ScreenScene& scene, std::size_t size, const CancelFlag* cancel) {
    PlaneSweepCounts counts;
    PlaneSweepSettings settings;
    settings.counts = &counts;
    plane_sweep(scene, settings, {}, cancel);
    return counted_by_terms(
        static_cast<double>(size),
        static_cast<double>(counts.steps()),
        {static_cast<double>(counts.segments), static_cast<double>(counts.crossings)},
        sweep_terms());
}

void set_sweep_bound(Experiment& experiment) {
    experiment.counted = "steps of the plane sweep";
    experiment.bound = "(n + k) log n";
    experiment.variables = {"n", "k"};
    experiment.terms = sweep_terms();
    experiment.source = "VERA appendix";
}

} // namespace vera
