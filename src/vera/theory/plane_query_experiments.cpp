// SPDX-License-Identifier: Apache-2.0
// Half-planes that are asked of points: the conjugation tree, and boxes beside it.
#include "vera/base/long_loop.h"
#include "vera/math/elementary.h"
#include "vera/theory/conjugation_tree.h"
#include "vera/theory/experiment.h"
#include "vera/theory/kd_tree.h"
#include "vera/theory/optimal_partition_tree.h"
#include "vera/theory/plane_points.h"

#include <algorithm>
#include <string>

namespace vera {

namespace {

constexpr int half_planes = 300;

/// What the paper has for log2 of the golden ratio.
constexpr double conjugation_exponent = 0.695;

/// The most nodes that a half-plane of some looks at; each through a point or beside one.
template <typename Tree>
CountedSize nodes_of_half_planes(
    const Tree& tree,
    const PlanePoints& points,
    std::mt19937_64& random,
    double exponent = conjugation_exponent) {
    std::uint64_t most = 0;
    for (int i = 0; i < half_planes; ++i) {
        const PlaneDirection normal = some_normal(points, random);
        StepCounts counts;
        tree.count(half_plane_near(points, normal, random), &counts);
        most = std::max(most, counts.nodes);
    }
    const auto size = static_cast<double>(points.size());
    return {size, static_cast<double>(most), power(size, exponent)};
}

Experiment of_family(const PointFamily& family) {
    Experiment experiment;
    experiment.family = family.name;
    experiment.input = std::string("points ") + family.place;
    experiment.counted = "nodes that a half-plane looks at, the most of 300";
    experiment.unit = "points";
    experiment.bound = "n^0.695";
    experiment.source = "VERA 3.3.1";
    experiment.first = 64;
    experiment.last = 65536;
    experiment.last_in_tests = 4096;
    experiment.most = 4'194'304;
    return experiment;
}

Experiment conjugation_tree_experiment(const PointFamily& family) {
    Experiment experiment = of_family(family);
    experiment.name = "conjugation-tree";
    experiment.count = [points_of = family.points](
                           std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        std::mt19937_64 random(seed);
        const PlanePoints points = points_of(size, random);
        const ConjugationTree tree(points, 1, {}, cancel);
        return nodes_of_half_planes(tree, points, random);
    };
    return experiment;
}

Experiment optimal_tree_experiment(const PointFamily& family) {
    Experiment experiment = of_family(family);
    experiment.name = "optimal-tree";
    experiment.bound = "n^0.5";
    experiment.source = "Chan 2012";
    experiment.most = 1'048'576;
    experiment.count = [points_of = family.points](
                           std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        std::mt19937_64 random(seed);
        const PlanePoints points = points_of(size, random);
        const OptimalPartitionTree tree(points, 1, {}, cancel);
        return nodes_of_half_planes(tree, points, random, 0.5);
    };
    return experiment;
}

Experiment kd_tree_experiment(const PointFamily& family) {
    Experiment experiment = of_family(family);
    experiment.name = "kd-tree";
    experiment.keeps_bound = family.points != thin_diagonal_points;
    experiment.count = [points_of = family.points](
                           std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        stop_if_raised(cancel);
        std::mt19937_64 random(seed);
        const PlanePoints points = points_of(size, random);
        return nodes_of_half_planes(KdTree(points), points, random);
    };
    return experiment;
}

} // namespace

std::vector<Experiment> plane_query_experiments() {
    std::vector<Experiment> found;
    for (const PointFamily& family : point_families())
        found.push_back(conjugation_tree_experiment(family));
    for (const auto& experiment_of : {optimal_tree_experiment, kd_tree_experiment})
        for (const PointFamily& family : point_families())
            if (family.points == scattered_points || family.points == thin_diagonal_points)
                found.push_back(experiment_of(family));
    return found;
}

} // namespace vera
