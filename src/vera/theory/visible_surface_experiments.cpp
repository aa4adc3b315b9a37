// SPDX-License-Identifier: Apache-2.0
// What is visible of triangles: the appendix's sweep, and Franklin's cells beside it.
#include "vera/theory/experiment.h"
#include "vera/theory/visible_surface_terms.h"
#include "vera/theory/whole_below.h"
#include "vera/visible/cell_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

namespace vera {

namespace {

std::uint32_t add_vertex(ScreenScene& scene, ScreenPoint point, std::int64_t nearness) {
    scene.vertices.push_back({point, nearness});
    return static_cast<std::uint32_t>(scene.vertices.size() - 1);
}

/// Each at a depth of its own; so large that, of so many, about 5 lie one behind the other.
ScreenScene triangles_of_size(std::size_t count, std::size_t five_deep, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto size =
        static_cast<std::int32_t>(screen_size * std::sqrt(5.0 / static_cast<double>(five_deep)));
    const auto layers = static_cast<std::int64_t>(count + 1);
    const auto coordinate = [&](std::int32_t middle) {
        return std::clamp(middle + whole_below(size, random) - size / 2, 0, screen_size);
    };
    ScreenScene scene;
    for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t x = whole_below(screen_size, random);
        const std::int32_t y = whole_below(screen_size, random);
        std::array<std::uint32_t, 3> vertices = {};
        for (std::uint32_t& vertex : vertices) {
            const std::int32_t corner_x = coordinate(x);
            const std::int32_t corner_y = coordinate(y);
            vertex = add_vertex(
                scene, {corner_x, corner_y}, static_cast<std::int64_t>(i) * (depth_size / layers));
        }
        add_triangle(scene, vertices, static_cast<std::uint32_t>(i));
    }
    return scene;
}

/// As many one behind the other whatever their number is: so that edges have as many crossings
/// each.
ScreenScene scattered_triangles(std::size_t count, std::uint64_t seed) {
    return triangles_of_size(count, count, seed);
}

/// The more there are, the more lie one behind the other, and the more crossings an edge has.
ScreenScene deep_triangles(std::size_t count, std::uint64_t seed) {
    constexpr std::size_t five_deep = 16;
    return triangles_of_size(count, five_deep, seed);
}

void add_sliver(
    ScreenScene& scene,
    ScreenPoint from,
    ScreenPoint beside,
    ScreenPoint to,
    std::int64_t nearness) {
    const std::uint32_t first = add_vertex(scene, from, nearness);
    const std::uint32_t second = add_vertex(scene, beside, nearness);
    add_triangle(scene, {first, second, add_vertex(scene, to, nearness)}, first / 3);
}

/// Two bundles of slivers, each of which crosses each of the other: n^2 crossings, of which the
/// eye sees all.
ScreenScene grate(std::size_t count) {
    ScreenScene scene;
    const auto each = static_cast<std::int32_t>(count / 2);
    const std::int32_t spacing = screen_size / each;
    for (std::int32_t i = 0; i < each; ++i) {
        const std::int32_t begin = i * spacing;
        const std::int32_t end = begin + spacing / 2;
        const std::int32_t tip = begin + spacing / 4;
        add_sliver(scene, {0, begin}, {0, end}, {screen_size, tip}, 10);
        add_sliver(scene, {begin, 0}, {end, 0}, {tip, screen_size}, 5000);
    }
    return scene;
}

/// The same behind two triangles, which are all that is seen.
ScreenScene hidden_grate(std::size_t count) {
    ScreenScene scene = grate(count);
    constexpr std::int64_t in_front = depth_size / 2;
    const std::uint32_t first = add_vertex(scene, {0, 0}, in_front);
    add_vertex(scene, {screen_size, 0}, in_front);
    add_vertex(scene, {screen_size, screen_size}, in_front);
    add_vertex(scene, {0, screen_size}, in_front);
    add_triangle(scene, {first, first + 1, first + 2}, first);
    add_triangle(scene, {first, first + 2, first + 3}, first);
    return scene;
}

CountedSize steps_of_scene_sweep(const ScreenScene& scene, const CancelFlag* cancel) {
    return steps_of_sweep(scene, scene.triangles.size(), cancel);
}

CountedSize steps_of_cells(const ScreenScene& scene, const CancelFlag* cancel) {
    CellCounts counts;
    cell_raster(scene, {}, cancel, {}, &counts);
    const std::uint64_t steps = counts.touched + counts.edge_cells + counts.looked_at
        + counts.candidates + counts.events + counts.active;
    const auto triangles = static_cast<double>(scene.triangles.size());
    return {triangles, static_cast<double>(steps), triangles};
}

using MakeScene = ScreenScene (*)(std::size_t count, std::uint64_t seed);
using CountSteps = CountedSize (*)(const ScreenScene& scene, const CancelFlag* cancel);

struct SceneFamily {
    const char* name;
    const char* input;
    std::size_t last; ///< of which n^2 crossings can be met
    std::size_t most;
    MakeScene make;
};

const SceneFamily scattered_family = {
    "scattered",
    "triangles anywhere, as many one behind the other at all sizes",
    16384,
    1'048'576,
    scattered_triangles};
const SceneFamily deep_family = {
    "deep", "triangles anywhere, of one size", 2896, 8192, deep_triangles};
const SceneFamily grate_family = {
    "grate",
    "two bundles of slivers that cross, all seen",
    512,
    8192,
    [](std::size_t count, std::uint64_t) { return grate(count); }};
const SceneFamily hidden_grate_family = {
    "hidden-grate",
    "two bundles of slivers that cross, behind one quadrangle",
    512,
    8192,
    [](std::size_t count, std::uint64_t) { return hidden_grate(count); }};

Experiment of_scenes(const SceneFamily& family, CountSteps count_steps) {
    Experiment experiment;
    experiment.family = family.name;
    experiment.input = family.input;
    experiment.unit = "triangles";
    experiment.first = 32;
    experiment.last = family.last;
    experiment.last_in_tests = std::min<std::size_t>(family.last / 4, 1024);
    experiment.most = family.most;
    experiment.count = count_of_made(family.make, count_steps);
    return experiment;
}

Experiment sweep_experiment(const SceneFamily& family) {
    Experiment experiment = of_scenes(family, steps_of_scene_sweep);
    experiment.name = "visible-sweep";
    set_sweep_bound(experiment);
    return experiment;
}

Experiment cells_experiment(const SceneFamily& family) {
    Experiment experiment = of_scenes(family, steps_of_cells);
    // The sides of cells are powers of 2, which small scenes feel.
    experiment.first = family.last / 32;
    experiment.last = 4 * family.last;
    experiment.last_in_tests = family.last;
    experiment.name = "visible-cells";
    experiment.counted = "steps of the cell raster";
    experiment.bound = std::string("n"); // GCC 12 warns of an overlap of so short a literal
    experiment.source = "Franklin 1980, expected and not proven";
    return experiment;
}

} // namespace

std::vector<Experiment> visible_surface_experiments() {
    Experiment cells_of_grate = cells_experiment(grate_family);
    cells_of_grate.keeps_bound = false; // n^2 pieces are seen
    Experiment deep = sweep_experiment(deep_family);
    // Of fewer, the logarithm of how many lie one behind the other grows faster than that of n.
    deep.first = 512;
    deep.last_in_tests = 1448;
    return {
        sweep_experiment(scattered_family),
        deep,
        sweep_experiment(grate_family),
        sweep_experiment(hidden_grate_family),
        cells_experiment(scattered_family),
        cells_of_grate};
}

} // namespace vera
