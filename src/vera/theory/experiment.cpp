// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/experiment.h"

#include <cmath>
#include <iterator>
#include <utility>

namespace vera {

CountedSize counted_by_terms(
    double size, double count, std::vector<double> variables, std::span<const BoundTerm> terms) {
    double bound = 0;
    for (const BoundTerm& term : terms)
        bound += term.value(variables);
    return {size, count, bound, std::move(variables)};
}

std::string full_name(const Experiment& experiment) {
    return experiment.name + "/" + experiment.family;
}

std::vector<std::size_t> sizes_up_to(const Experiment& experiment, std::size_t last) {
    constexpr double root_of_2 = 1.4142135623730951;
    std::vector<std::size_t> sizes;
    for (std::size_t size = experiment.first; size <= last; size *= 2) {
        sizes.push_back(size);
        const auto between =
            static_cast<std::size_t>(std::lround(root_of_2 * static_cast<double>(size)));
        if (experiment.sizes_a_doubling == 2 && between <= last)
            sizes.push_back(between);
    }
    return sizes;
}

std::span<const Experiment> experiments() {
    static const std::vector<Experiment> all = [] {
        std::vector<Experiment> found;
        for (const auto& of_structure :
             {plane_query_experiments,
              nested_trees_experiments,
              ray_search_experiments,
              sweep_experiments,
              dual_experiments,
              visible_surface_experiments,
              terrain_experiments,
              rectangle_view_experiments}) {
            std::vector<Experiment> some = of_structure();
            std::move(some.begin(), some.end(), std::back_inserter(found));
        }
        return found;
    }();
    return all;
}

} // namespace vera
