// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/classics.h"
#include "vera/generate/formula_shapes.h"
#include "vera/generate/generator.h"

#include <array>

namespace vera {

namespace {

using Ground = Stage::Ground;

const std::array all = {
    Generator{
        "balls",
        "a ball with nine smaller ones on it, and so on: the sphereflake",
        balls_parameters,
        make_balls,
        {.azimuth_degrees = 20,
         .elevation_degrees = 28,
         .color = {0.42, 0.30, 0.14},
         .mirror = 0.35}},
    Generator{
        "branches",
        "branches of cones that fork, and fork again",
        branches_parameters,
        make_branches,
        {.azimuth_degrees = 30, .elevation_degrees = 12, .color = {0.55, 0.38, 0.20}}},
    Generator{
        "jacks",
        "jacks with smaller jacks between their arms",
        jacks_parameters,
        make_jacks,
        {.elevation_degrees = 15, .color = {0.60, 0.42, 0.42}, .mirror = 0.2}},
    Generator{
        "knot",
        "a knot on a torus",
        knot_parameters,
        make_knot,
        {.azimuth_degrees = 20,
         .elevation_degrees = 42,
         .color = {0.16, 0.36, 0.52},
         .mirror = 0.12}},
    Generator{
        "lattice",
        "a cube of balls on rods",
        lattice_parameters,
        make_lattice,
        {.azimuth_degrees = 33, .elevation_degrees = 24}},
    Generator{
        "rings",
        "a pyramid of clusters of linked rings",
        rings_parameters,
        make_rings,
        {.azimuth_degrees = 28, .elevation_degrees = 22}},
    Generator{
        "shell",
        "a snail shell, from the formula of the paper's figure 2i",
        shell_parameters,
        make_shell,
        {.azimuth_degrees = 20,
         .elevation_degrees = 12,
         .color = {0.80, 0.66, 0.48},
         .mirror = 0.06}},
    Generator{
        "shells",
        "a spiral of balls that grow",
        shells_parameters,
        make_shells,
        {.elevation_degrees = 30, .color = {0.62, 0.36, 0.26}, .mirror = 0.12}},
    Generator{
        "tetra",
        "a tetrahedron of tetrahedra: Sierpinski's",
        tetra_parameters,
        make_tetra,
        {.azimuth_degrees = 40, .elevation_degrees = 18, .color = {0.66, 0.22, 0.18}}},
};

} // namespace

std::span<const Generator> generators() {
    return all;
}

} // namespace vera
