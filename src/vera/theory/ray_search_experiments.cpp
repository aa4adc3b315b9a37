// SPDX-License-Identifier: Apache-2.0
// Rectangles among rays: propositions 3 and 4.
#include "vera/math/elementary.h"
#include "vera/theory/experiment.h"
#include "vera/theory/ray_generations.h"
#include "vera/theory/ray_segments.h"
#include "vera/theory/ray_trees.h"
#include "vera/theory/whole_within.h"

#include <algorithm>
#include <cstdlib>

namespace vera {

namespace {

constexpr int rectangles = 300;
/// Nodes of so many rays have no trees. Few, so that nesting begins at small sizes.
constexpr std::size_t few = 8;
constexpr std::int32_t reach = 1'000'000'000;
constexpr std::int32_t slope = 1000;

/// Of any slope, from before everything: all cross each other, within a million of z = 0.
std::vector<SlopedRay> crossing_rays(std::size_t count, std::mt19937_64& random) {
    std::vector<SlopedRay> made(count);
    for (SlopedRay& ray : made) {
        ray.slope_x = whole_within(slope, random);
        ray.offset_x = whole_within(reach, random);
        ray.slope_y = whole_within(slope, random);
        ray.offset_y = whole_within(reach, random);
    }
    return made;
}

/// From before everything.
std::vector<SlopedRay> rays_from_afar(std::size_t count, std::mt19937_64& random) {
    return rays_of_viewer(count, slope, slope, random);
}

/// Anywhere within so far of the middle across the z axis, and along it.
IsoRectangle any_rectangle(std::int32_t across, std::int32_t along, std::mt19937_64& random) {
    const auto side = [&] {
        const std::int32_t a = whole_within(across, random);
        return std::minmax({a, whole_within(across, random)});
    };
    const auto x = side();
    const auto y = side();
    return {whole_within(along, random), x.first, x.second, y.first, y.second};
}

/// Where crossing rays cross; each meets a tenth of them or so.
IsoRectangle rectangle_at_crossings(std::mt19937_64& random) {
    return any_rectangle(reach, 1'000'000, random);
}

/// In the cube of mirrored_generation().
IsoRectangle rectangle_before_mirror(std::mt19937_64& random) {
    constexpr std::int32_t along = 20'000;
    return any_rectangle(fine_steps * along, along, random);
}

/// Looks at all that a query has to look at, and tells nothing.
struct StepsAlone {
    StepCounts& counts;

    bool enters(RayTreeNode /*node*/) const { return true; }

    void met(RayTreeNode /*node*/) const {}

    void open_in_y(RayTreeNode node) const { counts.points += node.rays().size(); }

    void open(RayTreeNode node) const { counts.points += node.rays().size(); }
};

using MadeRays = std::vector<SlopedRay> (*)(std::size_t count, std::mt19937_64& random);
using MadeRectangle = IsoRectangle (*)(std::mt19937_64& random);

/// The bound is m^exponent by so many logarithms of the levels.
Experiment of_trees(
    MadeRays made_rays,
    MadeRectangle made_rectangle,
    TreeKind kind,
    double exponent,
    double logarithms) {
    Experiment experiment;
    experiment.name = kind == TreeKind::optimal ? "prop3-steps-optimal" : "prop3-steps";
    experiment.counted = "nodes and rays that 300 rectangles look at";
    experiment.unit = "rays";
    experiment.first = 64;
    experiment.last = 4096;
    experiment.last_in_tests = 4096;
    experiment.most = 1'048'576;
    experiment.sizes_a_doubling = 1;
    experiment.count = [=](std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        std::mt19937_64 random(seed);
        const RayTrees trees(made_rays(size, random), few, {}, cancel, kind);
        StepCounts counts;
        for (int i = 0; i < rectangles; ++i)
            trees.visit(made_rectangle(random), counts, StepsAlone{counts});
        const auto m = static_cast<double>(size);
        return CountedSize{
            m,
            static_cast<double>(counts.nodes + counts.points),
            power(m, exponent) * power(log2_of(m / few), logarithms)};
    };
    return experiment;
}

Experiment of_conjugation_trees(
    const char* family,
    const char* input,
    MadeRays made_rays,
    MadeRectangle made_rectangle = rectangle_at_crossings) {
    Experiment experiment = of_trees(made_rays, made_rectangle, TreeKind::conjugation, 0.695, 1);
    experiment.family = family;
    experiment.input = input;
    experiment.bound = "m^0.695 log m";
    experiment.source =
        "VERA 3.3.2, proposition 3: m^0.695 polylog m; a logarithm for the second tree";
    return experiment;
}

Experiment of_segments() {
    Experiment experiment;
    experiment.family = "crossing";
    experiment.input = "rays that all cross each other";
    experiment.unit = "rays";
    experiment.first = 16;
    experiment.last = 128;
    experiment.last_in_tests = 128;
    experiment.most = 2048;
    return experiment;
}

} // namespace

std::vector<Experiment> ray_search_experiments() {
    Experiment optimal = of_trees(crossing_rays, rectangle_at_crossings, TreeKind::optimal, 0.5, 2);
    optimal.family = "crossing";
    optimal.input = "rays that all cross each other, in trees of today";
    optimal.bound = "m^0.5 log^2 m";
    optimal.source =
        "Chan 2012, Matousek 1992: a logarithm for test lines, and one for the second tree";
    Experiment steps = of_segments();
    steps.name = "prop4-steps";
    steps.counted = "nodes that 300 rectangles look at, and rays that are compared with them";
    steps.bound = "log^4 m";
    steps.source = "VERA 3.3.2, proposition 4";
    steps.count = [](std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        std::mt19937_64 random(seed);
        const RaySegments segments(crossing_rays(size, random), {}, cancel);
        StepCounts counts;
        for (int i = 0; i < rectangles; ++i)
            segments.rays_met(rectangle_at_crossings(random), &counts);
        const auto m = static_cast<double>(size);
        return CountedSize{
            m, static_cast<double>(counts.nodes + counts.points), power(log2_of(m), 4)};
    };
    Experiment memory = of_segments();
    memory.name = "prop4-memory";
    memory.counted = "bytes of the trees";
    memory.bound = "m^2 log^2 m";
    memory.source = "VERA 3.3.2, proposition 4: m^2 polylog m; a logarithm for each kind of tree";
    memory.count = [](std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        std::mt19937_64 random(seed);
        const RaySegments segments(crossing_rays(size, random), {}, cancel);
        const auto m = static_cast<double>(size);
        const double logarithm = log2_of(m);
        return CountedSize{m, static_cast<double>(segments.bytes()), m * m * logarithm * logarithm};
    };
    return {
        of_conjugation_trees("crossing", "rays that all cross each other", crossing_rays),
        of_conjugation_trees("viewer", "rays of one viewer", rays_from_afar),
        of_conjugation_trees(
            "mirrored",
            "rays of one viewer, mirrored by a sphere",
            mirrored_generation,
            rectangle_before_mirror),
        optimal,
        steps,
        memory};
}

} // namespace vera
