// SPDX-License-Identifier: Apache-2.0
// What is seen of terrains whose edges cross far more often than anything of them is seen.
#include "vera/theory/experiment.h"
#include "vera/theory/terrain_view.h"
#include "vera/theory/visible_surface_terms.h"

#include <cmath>
#include <random>
#include <span>
#include <vector>

namespace vera {

namespace {

/// Hills at a grazing view: every row of corners but the first reaches anywhere in the picture, so
/// that in each column all rows cross each other.
ScreenScene steep_hills(std::size_t triangles, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto side =
        static_cast<std::int32_t>(std::lround(std::sqrt(static_cast<double>(triangles) / 2)));
    const std::int32_t width = screen_size / side;
    const std::int64_t depth = depth_size / (side + 2);
    ScreenScene scene;
    for (std::int32_t row = 0; row <= side; ++row)
        for (std::int32_t column = 0; column <= side; ++column) {
            const auto any = static_cast<std::int32_t>(random() % screen_size);
            scene.vertices.push_back(
                {{column * width, row == 0 ? 0 : any}, depth_size - (row + 1) * depth});
        }
    const auto corner = [&](std::int32_t row, std::int32_t column) {
        return static_cast<std::uint32_t>(row * (side + 1) + column);
    };
    std::uint32_t source = 1;
    for (std::int32_t row = 0; row < side; ++row)
        for (std::int32_t column = 0; column < side; ++column) {
            const std::uint32_t left = corner(row, column);
            const std::uint32_t right = corner(row, column + 1);
            const std::uint32_t behind = corner(row + 1, column);
            add_triangle(scene, {left, right, behind}, source++);
            add_triangle(scene, {right, corner(row + 1, column + 1), behind}, source++);
        }
    return scene;
}

/// The same behind one slope that hides all of it.
ScreenScene hidden_hills(std::size_t triangles, std::uint64_t seed) {
    ScreenScene scene = steep_hills(triangles, seed);
    const std::int64_t behind = (scene.vertices.front().nearness + depth_size) / 2;
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.push_back({{0, 0}, depth_size});
    scene.vertices.push_back({{screen_size, 0}, depth_size});
    scene.vertices.push_back({{screen_size, screen_size}, behind});
    scene.vertices.push_back({{0, screen_size}, behind});
    add_triangle(scene, {first, first + 1, first + 2}, 0);
    add_triangle(scene, {first, first + 2, first + 3}, 0);
    return scene;
}

CountedSize steps_of_profiles(const ScreenScene& scene, const CancelFlag* cancel) {
    TerrainCounts counts;
    const VisiblePieces pieces = terrain_pieces(scene, Upward::with_y, &counts, {}, cancel);
    const auto triangles = static_cast<double>(scene.triangles.size());
    return counted_by_terms(
        triangles,
        static_cast<double>(counts.steps()),
        {triangles, static_cast<double>(pieces.points.size())},
        seen_terms());
}

using MakeScene = ScreenScene (*)(std::size_t triangles, std::uint64_t seed);

Experiment of_hills(const char* family, const char* input, MakeScene make) {
    Experiment experiment;
    experiment.name = "visible-terrain";
    experiment.family = family;
    experiment.input = input;
    experiment.counted = "steps to find what is seen, by profiles";
    experiment.unit = "triangles";
    experiment.bound = "(n + v) log^2 n";
    experiment.variables = {"n", "v"};
    experiment.terms = seen_terms();
    experiment.source = "Katz, Overmars and Sharir 1992";
    experiment.first = 128;
    experiment.last = 65536;
    experiment.last_in_tests = 4096;
    experiment.most = 1'048'576;
    experiment.count = count_of_made(make, steps_of_profiles);
    return experiment;
}

} // namespace

std::vector<Experiment> terrain_experiments() {
    return {
        of_hills("steep", "hills at a grazing view, whose rows all cross each other", steep_hills),
        of_hills("hidden", "the same hills behind one slope", hidden_hills)};
}

} // namespace vera
