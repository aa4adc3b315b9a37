// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/curve.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/base/random.h"

#include <algorithm>
#include <functional>
#include <stdexcept>

namespace vera {

namespace {

/// Rounding may make this much of growth where there is none.
constexpr double rounding = 1e-9;

template <typename Value>
std::vector<double> values_of(std::span<const CountedSize> points, const Value& value) {
    std::vector<double> values;
    for (const CountedSize& point : points)
        values.push_back(value(point));
    return values;
}

Verdict verdict_of(Interval excess) {
    if (excess.lower > rounding)
        return Verdict::above;
    return excess.upper < -rounding ? Verdict::below : Verdict::along;
}

} // namespace

const char* verdict_text(Verdict verdict) {
    switch (verdict) {
    case Verdict::below:
        return "below the bound";
    case Verdict::along:
        return "along the bound";
    case Verdict::above:
        break;
    }
    return "above the bound for certain";
}

std::vector<double> Curve::local_exponents() const {
    return vera::local_exponents(
        values_of(points, std::mem_fn(&CountedSize::size)),
        values_of(points, std::mem_fn(&CountedSize::count)));
}

std::vector<std::span<const Curve>> curves_by_name(std::span<const Curve> curves) {
    std::vector<std::span<const Curve>> groups;
    std::size_t first = 0;
    for (std::size_t i = 1; i <= curves.size(); ++i)
        if (i == curves.size() || curves[i].experiment->name != curves[first].experiment->name) {
            groups.push_back(curves.subspan(first, i - first));
            first = i;
        }
    return groups;
}

namespace {

/// Of those that sizes_up_to() has.
std::size_t fourth_size(const Experiment& experiment) {
    return sizes_up_to(experiment, 8 * experiment.first).at(least_sizes_of_curve - 1);
}

} // namespace

std::string problem_with_sizes(const Experiment& experiment, std::span<const std::size_t> sizes) {
    const std::string name = full_name(experiment);
    if (sizes.size() < least_sizes_of_curve)
        return name + " is counted at " + std::to_string(sizes.size())
            + (sizes.size() == 1 ? " size" : " sizes")
            + ", and an exponent takes 4 or more: name more sizes, or let them go on to "
            + std::to_string(fourth_size(experiment)) + " at least";
    if (sizes.size() > most_sizes_of_curve)
        return name + " is counted at " + std::to_string(sizes.size())
            + " sizes, and 64 are the most: leave some out";
    const auto unordered = std::adjacent_find(sizes.begin(), sizes.end(), std::greater_equal<>());
    if (unordered != sizes.end())
        return "the size " + std::to_string(*(unordered + 1)) + " stands behind "
            + std::to_string(*unordered) + ": name sizes in ascending order, each once";
    if (sizes.front() < 2)
        return "the size " + std::to_string(sizes.front()) + " is too small: 2 is the least";
    if (sizes.back() > experiment.most)
        return name + " takes at most " + std::to_string(experiment.most) + " " + experiment.unit
            + ", and " + std::to_string(sizes.back())
            + " are more than it could count in a reasonable time: name smaller sizes";
    return {};
}

Curve fitted_curve(
    const Experiment& experiment, std::uint64_t seed, std::vector<CountedSize> points) {
    Curve curve;
    curve.experiment = &experiment;
    curve.seed = seed;
    curve.points = std::move(points);
    curve.first_fitted = first_to_fit(curve.points.size());
    const auto sizes = values_of(curve.fitted(), std::mem_fn(&CountedSize::size));
    const auto counts = values_of(curve.fitted(), std::mem_fn(&CountedSize::count));
    const auto bounds = values_of(curve.fitted(), std::mem_fn(&CountedSize::bound));
    const auto parts = values_of(
        curve.fitted(), [](const CountedSize& point) { return point.count / point.bound; });
    curve.growth = growth(sizes, counts);
    curve.bound_growth = growth(sizes, bounds);
    curve.excess = growth(sizes, parts);
    const Growth& excess = curve.excess;
    curve.verdict =
        verdict_of({excess.exponent - excess.uncertainty, excess.exponent + excess.uncertainty});
    curve.resampled = resampled_growth(sizes, counts);
    curve.resampled_excess = resampled_growth(sizes, parts);
    curve.resampled_verdict = verdict_of(curve.resampled_excess.one_way);
    curve.models = model_fits(curve.points);
    return curve;
}

Curve counted_curve(
    const Experiment& experiment,
    std::span<const std::size_t> sizes,
    std::uint64_t seed,
    const Progress& progress,
    const CancelFlag* cancel) {
    if (const std::string problem = problem_with_sizes(experiment, sizes); !problem.empty())
        throw std::invalid_argument(problem);
    double total = 0;
    for (const std::size_t size : sizes)
        total += static_cast<double>(size);
    StageProgress stages(progress, total);
    std::vector<CountedSize> points;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        stop_if_raised(cancel);
        stages.next(static_cast<double>(sizes[i]));
        points.push_back(experiment.count(sizes[i], random(seed, sizes[i], 0), cancel));
        // Some inputs come in few sizes: lattices, for example.
        if (i > 0 && points[i].size == points[i - 1].size)
            throw std::invalid_argument(
                full_name(experiment) + " makes inputs of one size of both "
                + std::to_string(sizes[i - 1]) + " and " + std::to_string(sizes[i]) + " "
                + experiment.unit + ": name sizes that lie farther apart");
    }
    if (progress)
        progress(1);
    return fitted_curve(experiment, seed, std::move(points));
}

} // namespace vera
