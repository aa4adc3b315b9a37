// SPDX-License-Identifier: Apache-2.0
// What is seen of rectangles one behind the other: by the union of what is covered, and beside it
// by the plane sweep of the appendix, which meets what is hidden as well.
#include "vera/theory/experiment.h"
#include "vera/theory/overlaid_rectangles.h"
#include "vera/theory/rectangle_view.h"
#include "vera/theory/visible_surface_terms.h"

#include <string>

namespace vera {

namespace {

using Rectangles = std::vector<IsoRectangle>;

CountedSize steps_of_view(const Rectangles& rectangles, const CancelFlag* cancel) {
    WindowCounts counts;
    const RectangleView view = rectangle_view(rectangles, &counts, {}, cancel);
    const auto n = static_cast<double>(rectangles.size());
    return counted_by_terms(
        n,
        static_cast<double>(counts.steps()),
        {n, static_cast<double>(view.corners.size())},
        seen_terms());
}

CountedSize steps_of_swept(const Rectangles& rectangles, const CancelFlag* cancel) {
    return steps_of_sweep(screen_scene(rectangles), rectangles.size(), cancel);
}

using CountSteps = CountedSize (*)(const Rectangles& rectangles, const CancelFlag* cancel);

/// Where what is counted grows about with n, and where with n^2.
struct Sizes {
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t last_in_tests = 0;
    std::size_t most = 0;
};

constexpr Sizes linear_sizes = {64, 8192, 1024, 262'144};
constexpr Sizes quadratic_sizes = {32, 256, 128, 2048};

Experiment of_family(const OverlaidFamily& family, const Sizes& sizes, CountSteps count_steps) {
    Experiment experiment;
    experiment.family = family.name;
    experiment.input = family.input;
    experiment.unit = "rectangles";
    experiment.first = sizes.first;
    experiment.last = sizes.last;
    experiment.last_in_tests = sizes.last_in_tests;
    experiment.most = sizes.most;
    experiment.count = count_of_made(family.rectangles, count_steps);
    return experiment;
}

Experiment view_experiment(const OverlaidFamily& family) {
    const std::string name = family.name;
    Experiment experiment =
        of_family(family, name == "grate" ? quadratic_sizes : linear_sizes, steps_of_view);
    // All that is asked for is what whole trees tell, whose leaves are powers of 2.
    if (name == "hidden-grate")
        experiment.sizes_a_doubling = 1;
    experiment.name = "visible-rectangles";
    experiment.counted = "steps to find what is seen, by the union of what is covered";
    experiment.bound = "(n + v) log^2 n";
    experiment.variables = {"n", "v"};
    experiment.terms = seen_terms();
    experiment.source = "Güting and Ottmann 1987";
    return experiment;
}

Experiment sweep_experiment(const OverlaidFamily& family) {
    const bool is_linear = std::string(family.name) == "scattered";
    Experiment experiment =
        of_family(family, is_linear ? linear_sizes : quadratic_sizes, steps_of_swept);
    experiment.name = "rectangles-by-sweep";
    set_sweep_bound(experiment);
    return experiment;
}

} // namespace

std::vector<Experiment> rectangle_view_experiments() {
    std::vector<Experiment> all;
    for (const OverlaidFamily& family : overlaid_families())
        all.push_back(view_experiment(family));
    for (const OverlaidFamily& family : overlaid_families())
        all.push_back(sweep_experiment(family));
    return all;
}

} // namespace vera
