// SPDX-License-Identifier: Apache-2.0
// Rays among rectangles: proposition 1.
#include "vera/math/elementary.h"
#include "vera/theory/experiment.h"
#include "vera/theory/nested_trees.h"
#include "vera/theory/ray_generations.h"
#include "vera/theory/scattered_rectangles.h"

#include <string>

namespace vera {

namespace {

constexpr int rays = 300;
/// Nodes of so many rectangles have no trees. Few, so that nesting begins at small sizes.
constexpr std::size_t few = 8;

using MadeRay = WholeRay (*)(std::mt19937_64& random);

CountedSize counted_steps(
    std::size_t size, double parts, MadeRay ray, std::uint64_t seed, const CancelFlag* cancel) {
    std::mt19937_64 random(seed);
    const NestedTrees trees(scattered_rectangles(size, parts, random), few, {}, cancel);
    StepCounts counts;
    for (int i = 0; i < rays; ++i)
        trees.first_rectangle(ray(random), &counts);
    const auto n = static_cast<double>(size);
    return {
        n, static_cast<double>(counts.nodes + counts.points + counts.searches), power(n, 0.695)};
}

/// In how many sorted lists a rectangle is, one of each node of the innermost trees: as many as
/// there are ways to go down four trees, through no more levels in all than one has.
double places_of_each(double rectangles) {
    const double levels = log2_of(rectangles / few);
    return (levels + 1) * (levels + 2) * (levels + 3) * (levels + 4) / 24;
}

/// Of rectangles with sides of up to so many parts of their mean distance.
Experiment
of_steps(const char* family, const char* input, double parts = 2, MadeRay ray = scattered_ray) {
    Experiment experiment;
    experiment.family = family;
    experiment.input = input;
    experiment.name = "prop1-steps";
    experiment.counted = "nodes, rectangles and searches of 300 rays";
    experiment.unit = "rectangles";
    experiment.bound = "n^0.695";
    experiment.source = "VERA 3.3.1, proposition 1, without its polylog";
    experiment.first = 32;
    experiment.last = 4096;
    // Rays of one generation come through few places, so that fewer rectangles leave much to
    // chance.
    experiment.last_in_tests = ray == scattered_ray ? 1024 : 2048;
    experiment.most = 65536;
    experiment.sizes_a_doubling = 1;
    experiment.count = [parts,
                        ray](std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        return counted_steps(size, parts, ray, seed, cancel);
    };
    return experiment;
}

} // namespace

std::vector<Experiment> nested_trees_experiments() {
    Experiment memory = of_steps("scattered", "rectangles all over a cube");
    memory.name = "prop1-memory";
    memory.counted = "bytes of the nested trees";
    memory.bound = "n log^4 n";
    memory.source = "VERA 3.3.1, proposition 1, which says n polylog n";
    memory.count = [](std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        std::mt19937_64 random(seed);
        const NestedTrees trees(scattered_rectangles(size, 2, random), few, {}, cancel);
        const auto n = static_cast<double>(size);
        return CountedSize{n, static_cast<double>(trees.bytes()), n * places_of_each(n)};
    };
    return {
        of_steps(
            "meeting", "rectangles that rays meet, of sides of up to twice their mean distance"),
        of_steps("missing", "rectangles without sides, which rays miss", 0),
        of_steps(
            "viewer", "the rectangles of meeting, and rays of one viewer", 2, first_generation_ray),
        of_steps(
            "mirrored",
            "the same, and rays of one viewer that a sphere mirrors",
            2,
            mirrored_generation_ray),
        memory};
}

} // namespace vera
