// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/classics.h"
#include "vera/generate/ficus.h"
#include "vera/generate/formula_shapes.h"
#include "vera/generate/gears.h"
#include "vera/generate/generator.h"
#include "vera/generate/terrain.h"
#include "vera/generate/trees.h"

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
        "ficus",
        "a rubber tree in a pot, grown leaf by leaf: the paper's figure 2c",
        ficus_parameters,
        make_ficus,
        {.azimuth_degrees = 25, .elevation_degrees = 10, .margin = 0.06}},
    Generator{
        "forest",
        "trees in rows; 340 rows are a billion leaves",
        forest_parameters,
        make_forest,
        {.ground = Ground::meadow, .azimuth_degrees = 25, .elevation_degrees = 9, .margin = 0.02}},
    Generator{
        "gear",
        "a spur gear with involute teeth",
        gear_parameters,
        make_gear,
        {.azimuth_degrees = 35,
         .elevation_degrees = 20,
         .color = {0.42, 0.34, 0.18},
         .mirror = 0.25}},
    Generator{
        "gears",
        "three spur gears that mesh",
        gears_parameters,
        make_gears,
        {.azimuth_degrees = 15, .elevation_degrees = 42, .margin = 0.07}},
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
        "mountain",
        "a mountain of triangles with four shining balls over it",
        mountain_parameters,
        make_mountain,
        {.azimuth_degrees = 35, .elevation_degrees = 24}},
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
        "terrain",
        "a block of land with water, grass, rock and snow",
        terrain_parameters,
        make_terrain,
        {.azimuth_degrees = 30, .elevation_degrees = 32, .margin = 0.06}},
    Generator{
        "tetra",
        "a tetrahedron of tetrahedra: Sierpinski's",
        tetra_parameters,
        make_tetra,
        {.azimuth_degrees = 40, .elevation_degrees = 18, .color = {0.66, 0.22, 0.18}}},
    Generator{
        "tree",
        "a tree by recursion: the paper's figure 2f",
        tree_parameters,
        make_tree,
        {.ground = Ground::meadow, .azimuth_degrees = 25, .elevation_degrees = 5, .margin = 0.08}},
};

} // namespace

std::span<const Generator> generators() {
    return all;
}

} // namespace vera
