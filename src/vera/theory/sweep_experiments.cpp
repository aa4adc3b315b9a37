// SPDX-License-Identifier: Apache-2.0
// Many rays among as many rectangles: the space sweep, and proposition 5.
#include "vera/math/elementary.h"
#include "vera/theory/experiment.h"
#include "vera/theory/grouped_sweeps.h"
#include "vera/theory/nested_sweeps.h"
#include "vera/theory/ray_generations.h"
#include "vera/theory/scattered_rectangles.h"
#include "vera/theory/whole_within.h"

#include <random>
#include <string>

namespace vera {

namespace {

/// That of scattered rectangles.
constexpr std::int32_t reach = 20'000;

/// Slopes of at most so much, from anywhere among the rectangles.
std::vector<SlopedRay>
rays_of_slopes(std::int32_t most, std::size_t count, std::mt19937_64& random) {
    std::vector<SlopedRay> made(count);
    for (SlopedRay& ray : made) {
        ray.slope_x = whole_within(most, random);
        ray.offset_x = whole_within(reach, random);
        ray.slope_y = whole_within(most, random);
        ray.offset_y = whole_within(reach, random);
        ray.first_z = whole_within(reach, random);
    }
    return made;
}

std::vector<SlopedRay> any_rays(std::size_t count, std::mt19937_64& random) {
    return rays_of_slopes(40, count, random);
}

std::vector<SlopedRay> nearly_parallel_rays(std::size_t count, std::mt19937_64& random) {
    return rays_of_slopes(2, count, random);
}

using MadeRays = std::vector<SlopedRay> (*)(std::size_t count, std::mt19937_64& random);
using MadeRectangles =
    std::vector<IsoRectangle> (*)(std::size_t count, double parts, std::mt19937_64& random);

/// Rays, and rectangles of their cube.
struct RayFamily {
    const char* name;
    const char* input;
    MadeRays rays;
    MadeRectangles rectangles;
};

const RayFamily any_family = {"any", "rays of any slope", any_rays, scattered_rectangles};
const RayFamily parallel_family = {
    "parallel", "rays that are nearly parallel", nearly_parallel_rays, scattered_rectangles};
const RayFamily viewer_family = {
    "viewer",
    "rays of one viewer, which cross nowhere",
    first_generation,
    finely_scattered_rectangles};
const RayFamily mirrored_family = {
    "mirrored",
    "rays of one viewer, mirrored by a sphere",
    mirrored_generation,
    finely_scattered_rectangles};

Experiment of_rays(const char* name, const std::string& family, const std::string& input) {
    Experiment experiment;
    experiment.name = name;
    experiment.family = family;
    experiment.input = input;
    experiment.unit = "rays";
    experiment.most = 65'536;
    experiment.sizes_a_doubling = 1;
    return experiment;
}

/// (m + k) log^2 m + I, of m rays and as many rectangles, k crossings and I rays told.
const std::vector<BoundTerm>& space_sweep_terms() {
    static const auto square = [](double value) { return value * value; };
    static const std::vector<BoundTerm> terms = {
        {"m log^2 m", [](std::span<const double> mki) { return mki[0] * square(log2_of(mki[0])); }},
        {"k log^2 m", [](std::span<const double> mki) { return mki[1] * square(log2_of(mki[0])); }},
        {"I", [](std::span<const double> mki) { return mki[2]; }}};
    return terms;
}

Experiment of_sweep(const RayFamily& family) {
    Experiment experiment = of_rays("space-sweep", family.name, family.input);
    experiment.counted = "steps of a sweep through as many rectangles";
    experiment.bound = "(m + k) log^2 m + I";
    experiment.variables = {"m", "k", "I"};
    experiment.terms = space_sweep_terms();
    experiment.source = "VERA 3.3.2, the space sweep: k crossings, I rays told; m = n";
    experiment.first = 64;
    experiment.last = 2048;
    experiment.last_in_tests = 1024;
    experiment.count = [family](std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        std::mt19937_64 random(seed);
        const std::vector<IsoRectangle> rectangles = family.rectangles(size, 2, random);
        SweepCounts counts;
        sweep_first_rectangles(rectangles, family.rays(size, random), &counts, {}, cancel);
        return counted_by_terms(
            static_cast<double>(size),
            static_cast<double>(counts.steps()),
            {static_cast<double>(size),
             static_cast<double>(counts.x_swaps + counts.y_swaps),
             static_cast<double>(counts.reports)},
            space_sweep_terms());
    };
    return experiment;
}

/// What happens in sweeps of all rays through the rectangles.
using EventsOfSweeps = double (*)(
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    const CancelFlag* cancel);

double events_of_groups(
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    const CancelFlag* cancel) {
    SweepCounts counts;
    sweep_groups_first_rectangles(
        stated_level(rectangles.size(), rays.size()), rectangles, rays, &counts, {}, cancel);
    return static_cast<double>(counts.events());
}

double events_of_nested(
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    const CancelFlag* cancel) {
    NestedSweepCounts counts;
    const std::size_t level = stated_level(rectangles.size(), rays.size());
    nested_sweeps_first_rectangles(level, rectangles, rays, &counts, {}, cancel);
    return static_cast<double>(counts.sweeps.events() + counts.trees.nodes);
}

/// Proposition 5 in one of its forms.
struct SweepForm {
    const char* name;
    const char* where;
    EventsOfSweeps events;
};

const SweepForm groups_form = {"groups", ", in groups of one sweep each", events_of_groups};
const SweepForm nested_form = {
    "nested", ", in sweeps at the ends of two nested trees", events_of_nested};

Experiment of_groups(const SweepForm& form, const RayFamily& family) {
    Experiment experiment = of_rays(
        "prop5-events",
        std::string(form.name) + (family.rays == any_rays ? "" : std::string("-") + family.name),
        std::string(family.input) + form.where);
    experiment.counted = "crossings, rectangles asked, nodes and rays told, at the stated level";
    experiment.bound = "m^1.41";
    experiment.source = "VERA 3.3.2, proposition 5: m^0.820 n^0.590, but for logarithms";
    // Trees of fewer nodes are undecided in all of them.
    experiment.first = 512;
    experiment.last = 8192;
    experiment.last_in_tests = 8192;
    experiment.count = [events = form.events,
                        family](std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
        std::mt19937_64 random(seed);
        const std::vector<IsoRectangle> rectangles = family.rectangles(size, 2, random);
        const auto m = static_cast<double>(size);
        return CountedSize{
            m, events(rectangles, family.rays(size, random), cancel), power(m, 1.41)};
    };
    return experiment;
}

} // namespace

std::vector<Experiment> sweep_experiments() {
    return {
        of_sweep(any_family),
        of_sweep(parallel_family),
        of_sweep(viewer_family),
        of_sweep(mirrored_family),
        of_groups(groups_form, any_family),
        of_groups(groups_form, mirrored_family),
        of_groups(nested_form, any_family),
        of_groups(nested_form, mirrored_family)};
}

} // namespace vera
