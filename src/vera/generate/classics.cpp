// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/classics.h"

#include "vera/generate/scene_parts.h"
#include "vera/math/elementary.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace vera {

namespace {

/// The main scene calls its only part.
void call_from_main(Scene& scene, SubsceneId part, const Affine3& placement = {}) {
    add_call(scene.geometry, part, placement);
}

/// Unit vectors to the neighbours of a ball in the densest packing, but for the three below it: six
/// round the equator and three above.
std::array<Vec3, 9> upper_neighbours() {
    std::array<Vec3, 9> directions;
    const double height = std::sqrt(2.0 / 3);
    const double across = std::sqrt(1.0 / 3);
    for (std::size_t i = 0; i < 6; ++i) {
        const double angle = 60 * static_cast<double>(i);
        directions[i] = {cos_degrees(angle), 0, sin_degrees(angle)};
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const double angle = 30 + 120 * static_cast<double>(i);
        directions[6 + i] = {across * cos_degrees(angle), height, across * sin_degrees(angle)};
    }
    return directions;
}

} // namespace

Scene make_balls(const ParameterValues& values) {
    Scene scene;
    SubsceneId smaller = {};
    for (std::size_t level = 0; level <= values.whole("size"); ++level) {
        const SubsceneId flake = add_subscene(scene, fmt::format("balls-{}", level));
        Geometry& geometry = geometry_of(scene, flake);
        add(geometry, Sphere{{0, 0, 0}, 1});
        if (level > 0)
            for (const Vec3 direction : upper_neighbours())
                add_call(
                    geometry,
                    smaller,
                    in_turn(
                        scaling(1.0 / 3),
                        turned_from_y(direction),
                        translation(4.0 / 3 * direction)));
        smaller = flake;
    }
    call_from_main(scene, smaller);
    return scene;
}

Scene make_tetra(const ParameterValues& values) {
    // One edge of the base along x, the tip above its middle; height 1.
    const double side = std::sqrt(1.5);
    const double inner = side / std::sqrt(3.0);
    const std::array<Vec3, 4> corners = {{
        {-side / 2, 0, inner / 2},
        {side / 2, 0, inner / 2},
        {0, 0, -inner},
        {0, 1, 0},
    }};
    Scene scene;
    SubsceneId part = add_subscene(scene, "tetra-1");
    for (const auto& [a, b, c] :
         {std::array<std::size_t, 3>{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}})
        add(geometry_of(scene, part), Triangle{{corners[a], corners[b], corners[c]}});
    for (std::size_t level = 2; level <= values.whole("size"); ++level) {
        const SubsceneId whole = add_subscene(scene, fmt::format("tetra-{}", level));
        for (const Vec3 corner : corners)
            add_call(
                geometry_of(scene, whole), part, in_turn(scaling(0.5), translation(0.5 * corner)));
        part = whole;
    }
    call_from_main(scene, part);
    return scene;
}

Scene make_jacks(const ParameterValues& values) {
    constexpr double reach = 0.75;
    constexpr double rod = 0.075;
    constexpr double knob = 0.15;
    Scene scene;
    const SubsceneId jack = add_subscene(scene, "jack");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 end;
        end[axis] = reach;
        add(geometry_of(scene, jack), cone_between(-end, rod, end, rod));
        add(geometry_of(scene, jack), Sphere{-end, knob});
        add(geometry_of(scene, jack), Sphere{end, knob});
    }
    SubsceneId smaller = jack;
    for (std::size_t level = 2; level <= values.whole("size"); ++level) {
        const SubsceneId jacks = add_subscene(scene, fmt::format("jacks-{}", level));
        add_call(geometry_of(scene, jacks), jack, {});
        for (const double x : {-0.5, 0.5})
            for (const double y : {-0.5, 0.5})
                for (const double z : {-0.5, 0.5})
                    add_call(
                        geometry_of(scene, jacks),
                        smaller,
                        in_turn(scaling(0.5), translation({x, y, z})));
        smaller = jacks;
    }
    // One of the diagonals stands upright.
    call_from_main(
        scene, smaller, in_turn(rotation({0, 0, 45}), rotation({35.26438968275466, 0, 0})));
    return scene;
}

namespace {

/// A subscene that calls another one so often, each time a step farther.
SubsceneId row_of(Scene& scene, SubsceneId part, std::size_t count, Vec3 step, std::string name) {
    const SubsceneId row = add_subscene(scene, std::move(name));
    for (std::size_t i = 0; i < count; ++i)
        add_call(geometry_of(scene, row), part, translation(static_cast<double>(i) * step));
    return row;
}

SubsceneId lattice_rod(Scene& scene, std::size_t axis, double cell, Color color) {
    constexpr std::array<const char*, 3> names = {"rod-x", "rod-y", "rod-z"};
    const MaterialId material = add_material(scene, fmt::format("lattice-{}", names[axis]), color);
    const SubsceneId rod = add_subscene(scene, names[axis]);
    Vec3 end;
    end[axis] = cell;
    add(geometry_of(scene, rod), cone_between({}, cell / 16, end, cell / 16), material);
    return rod;
}

} // namespace

Scene make_lattice(const ParameterValues& values) {
    Scene scene;
    const std::size_t size = values.whole("size");
    const double cell = 1 / static_cast<double>(size);
    const MaterialId grey = add_material(scene, "lattice-ball", {0.45, 0.45, 0.45});
    scene.materials.back().rab = {0.4, 0.4, 0.4};
    scene.materials.back().spc = 0.9;
    const SubsceneId ball = add_subscene(scene, "ball");
    add(geometry_of(scene, ball), Sphere{{0, 0, 0}, cell / 4}, grey);

    const auto grid_of =
        [&](SubsceneId part, std::string_view name, std::array<std::size_t, 3> counts) {
            const SubsceneId row =
                row_of(scene, part, counts[0], {cell, 0, 0}, fmt::format("row-of-{}", name));
            const SubsceneId plane =
                row_of(scene, row, counts[1], {0, cell, 0}, fmt::format("plane-of-{}", name));
            return row_of(scene, plane, counts[2], {0, 0, cell}, fmt::format("block-of-{}", name));
        };
    const std::size_t points = size + 1;
    const Affine3 centered = translation({-0.5, 0, -0.5});
    call_from_main(scene, grid_of(ball, "balls", {points, points, points}), centered);
    const std::array<Color, 3> colors = {{{0.8, 0.16, 0.12}, {0.2, 0.6, 0.2}, {0.15, 0.25, 0.75}}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<std::size_t, 3> counts = {points, points, points};
        counts[axis] = size;
        const SubsceneId rod = lattice_rod(scene, axis, cell, colors[axis]);
        call_from_main(scene, grid_of(rod, geometry_of(scene, rod).name, counts), centered);
    }
    return scene;
}

namespace {

/// A pentagon of rods with a ball at each corner, about the origin, its axis y, of radius 1.
SubsceneId pentagon(Scene& scene) {
    constexpr double thickness = 0.08;
    const SubsceneId ring = add_subscene(scene, "ring");
    const auto corner = [](int i) { return Vec3{cos_degrees(72.0 * i), 0, sin_degrees(72.0 * i)}; };
    for (int i = 0; i < 5; ++i) {
        add(geometry_of(scene, ring), cone_between(corner(i), thickness, corner(i + 1), thickness));
        add(geometry_of(scene, ring), Sphere{corner(i), thickness});
    }
    return ring;
}

} // namespace

Scene make_rings(const ParameterValues& values) {
    Scene scene;
    const SubsceneId ring = pentagon(scene);
    const SubsceneId cluster = add_subscene(scene, "cluster");
    // Six rings about one centre, their axes the six diagonals of an icosahedron.
    const std::array<Color, 6> colors = {{
        {0.70, 0.16, 0.12},
        {0.75, 0.45, 0.10},
        {0.70, 0.65, 0.20},
        {0.20, 0.50, 0.25},
        {0.15, 0.35, 0.65},
        {0.45, 0.25, 0.55},
    }};
    const double tilt = 63.43494882292201; // between two diagonals: atan 2
    for (std::size_t i = 0; i < 6; ++i) {
        const MaterialId material = add_material(scene, fmt::format("rings-{}", i + 1), colors[i]);
        scene.materials.back().rab = {0.15, 0.15, 0.15};
        scene.materials.back().spc = 0.92;
        const double turn = 72 * static_cast<double>(i);
        const Affine3 map = i == 0 ? Affine3{} : rotation({tilt, turn, 0});
        add_call(geometry_of(scene, cluster), ring, map, material);
    }
    constexpr double spacing = 2.2;
    const std::size_t size = values.whole("size");
    for (std::size_t layer = 1; layer <= size; ++layer) {
        const double height = spacing * 0.75 * static_cast<double>(size - layer) + 1;
        const double first = -0.5 * spacing * static_cast<double>(layer - 1);
        for (std::size_t row = 0; row < layer; ++row)
            for (std::size_t column = 0; column < layer; ++column)
                add_call(
                    scene.geometry,
                    cluster,
                    translation(
                        {first + spacing * static_cast<double>(column),
                         height,
                         first + spacing * static_cast<double>(row)}));
    }
    return scene;
}

Scene make_branches(const ParameterValues& values) {
    const double ratio = values["ratio"];
    const double angle = values["angle"];
    constexpr double thickness = 0.15;
    Scene scene;
    SubsceneId smaller = {};
    for (std::size_t level = 0; level <= values.whole("size"); ++level) {
        const SubsceneId branch = add_subscene(scene, fmt::format("branch-{}", level));
        Geometry& geometry = geometry_of(scene, branch);
        const Vec3 tip = {0, 1, 0};
        add(geometry, cone_between({}, thickness, tip, ratio * thickness));
        add(geometry, Sphere{tip, ratio * thickness});
        if (level > 0)
            for (const double side : {-1.0, 1.0})
                // Each fork lies across the one below it, nearly.
                add_call(
                    geometry,
                    smaller,
                    in_turn(
                        scaling(ratio),
                        rotation({0, 80, 0}),
                        rotation({0, 0, side * angle}),
                        translation(tip)));
        smaller = branch;
    }
    call_from_main(scene, smaller);
    return scene;
}

Scene make_shells(const ParameterValues& values) {
    const double balls = values["balls"];
    const double growth = values["growth"];
    const auto count = static_cast<std::size_t>(values["turns"] * balls) + 1;
    Scene scene;
    for (std::size_t i = 0; i < count; ++i) {
        const double turns = (static_cast<double>(i) - static_cast<double>(count - 1)) / balls;
        const double radius = power(growth, turns);
        const double angle = 360 * turns;
        add(scene.geometry,
            Sphere{
                {radius * sin_degrees(angle), -2 * radius, radius * cos_degrees(angle)}, radius});
    }
    return scene;
}

} // namespace vera
