// SPDX-License-Identifier: Apache-2.0
// Claims of the paper as experiments: something is built of inputs of growing size, its steps or
// bytes are counted, and what the bound says is told beside them. Counts are the same on every
// machine; no clock has a say.
#pragma once

#include "vera/base/parallel.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace vera {

/// What was counted of an input, and its bound, but for a constant factor. Both are positive. The
/// bound may depend on what was met, as on the crossings of edges.
struct CountedSize {
    double size = 0;
    double count = 0;
    double bound = 0;
    std::vector<double> variables = {}; ///< of the experiment's terms: n, k; none: the size alone
};

/// What a bound of several variables adds up.
struct BoundTerm {
    std::string formula; ///< "k log n"
    std::function<double(std::span<const double> variables)> value;
};

/// Counts one input of about the size, made with the seed; the same for the same two numbers.
/// Throws Cancelled, and std::runtime_error where memory would not suffice.
using CountOfSize =
    std::function<CountedSize(std::size_t size, std::uint64_t seed, const CancelFlag* cancel)>;

/// One curve.
struct Experiment {
    std::string name;    ///< of the structure; curves of one name are drawn together
    std::string family;  ///< of the inputs; the two name the curve, as "NAME/FAMILY"
    std::string input;   ///< the same for people: "points on a circle"
    std::string counted; ///< what: "nodes that a half-plane looks at, the most of 300"
    std::string unit;    ///< what sizes count: "points"
    std::string bound;   ///< as a formula: "n^0.695"
    std::string source;  ///< who says so: "VERA 3.3.1"
    std::vector<std::string> variables; ///< of the terms: "n", "k"; none: the bound has but one
    std::vector<BoundTerm> terms;       ///< whose sum the bound is, where it has variables
    std::size_t first = 0;              ///< size
    std::size_t last = 0;               ///< when nothing else is asked for
    std::size_t last_in_tests = 0;      ///< which take a second or so for all curves of a name
    std::size_t most = 0;               ///< larger sizes are refused
    int sizes_a_doubling = 2;           ///< 1 where halving down to a few makes steps of their own
    bool keeps_bound = true;            ///< not so of those that show what breaks it
    CountOfSize count;
};

/// With the sum of the terms for a bound.
CountedSize counted_by_terms(
    double size, double count, std::vector<double> variables, std::span<const BoundTerm> terms);

/// "NAME/FAMILY"
std::string full_name(const Experiment& experiment);

/// The experiment's sizes from its first to the last one that is no larger than this: each is twice
/// the one before or, where there are two a doubling, larger by the root of 2, rounded.
std::vector<std::size_t> sizes_up_to(const Experiment& experiment, std::size_t last);

/// All there are, those of one name in a row. A further structure adds a function to the list in
/// experiment.cpp.
std::span<const Experiment> experiments();

// Those of each structure.
std::vector<Experiment> plane_query_experiments();
std::vector<Experiment> nested_trees_experiments();
std::vector<Experiment> ray_search_experiments();
std::vector<Experiment> sweep_experiments();
std::vector<Experiment> dual_experiments();
std::vector<Experiment> visible_surface_experiments();
std::vector<Experiment> terrain_experiments();
std::vector<Experiment> rectangle_view_experiments();

} // namespace vera
