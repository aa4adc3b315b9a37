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

Verdict verdict_of(const Growth& excess) {
    if (excess.exponent - excess.uncertainty > rounding)
        return Verdict::above;
    return excess.exponent + excess.uncertainty < -rounding ? Verdict::below : Verdict::along;
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

std::string problem_with_sizes(const Experiment& experiment, std::span<const std::size_t> sizes) {
    const std::string name = full_name(experiment);
    if (sizes.size() < least_sizes_of_curve)
        return name + " is counted at " + std::to_string(sizes.size())
            + " sizes, and an exponent takes 4 or more: name more sizes, or let them go on to "
            + std::to_string(3 * experiment.first) + " at least";
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
    const std::size_t count = curve.points.size();
    curve.first_fitted = count - std::max(least_sizes_of_curve, (count + 1) / 2);
    const auto sizes = values_of(curve.fitted(), std::mem_fn(&CountedSize::size));
    const auto counts = values_of(curve.fitted(), std::mem_fn(&CountedSize::count));
    const auto bounds = values_of(curve.fitted(), std::mem_fn(&CountedSize::bound));
    const auto parts = values_of(
        curve.fitted(), [](const CountedSize& point) { return point.count / point.bound; });
    curve.growth = growth(sizes, counts);
    curve.bound_growth = growth(sizes, bounds);
    curve.excess = growth(sizes, parts);
    curve.verdict = verdict_of(curve.excess);
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
    for (const std::size_t size : sizes) {
        stop_if_raised(cancel);
        stages.next(static_cast<double>(size));
        points.push_back(experiment.count(size, random(seed, size, 0), cancel));
    }
    if (progress)
        progress(1);
    return fitted_curve(experiment, seed, std::move(points));
}

} // namespace vera
