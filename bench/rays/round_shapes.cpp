// SPDX-License-Identifier: Apache-2.0
#include "round_shapes.h"

#include <cmath>

#include "directions.h"
#include "lattice.h"

namespace vera {

namespace {

/// Adds the sphere and all that sit on it; the axis points away from the one that it sits on.
void add_flake(
    std::vector<Sphere>& spheres, const Sphere& sphere, Vec3 axis, std::uint32_t generations) {
    spheres.push_back(sphere);
    if (generations == 0)
        return;
    // Six round the equator and three above it, where the parent is not.
    for (std::size_t i = 0; i < 9; ++i) {
        const double from_pole = i < 6 ? 90 : 35;
        const double turn = i < 6 ? degrees(i, 6) : degrees(2 * i + 1, 6);
        const Vec3 direction = bent(axis, from_pole, turn);
        const Vec3 center = sphere.center + (4.0 / 3 * sphere.radius) * direction;
        add_flake(spheres, {center, sphere.radius / 3}, direction, generations - 1);
    }
}

RotationalShape goblet(Vec3 foot, double width, double height) {
    using Kind = ContourPiece::Kind;
    const auto at = [&](double r, double h) { return ContourPiece::Point{width * r, height * h}; };
    RotationalShape shape;
    shape.base = foot;
    shape.axis = {0, 1, 0};
    shape.start = at(0, 0.01);
    shape.contour = {
        {Kind::line, {}, 1, at(0.6, 0.01)},
        {Kind::conic, {at(0.65, 0.05)}, 0.7, at(0.6, 0.08)},
        {Kind::cubic, {at(0.2, 0.1), at(0.1, 0.15)}, 1, at(0.1, 0.4)},
        {Kind::cubic, {at(0.1, 0.6), at(0.75, 0.5)}, 1, at(0.8, 0.95)},
        {Kind::conic, {at(0.78, 1)}, 0.6, at(0.74, 0.95)},
        {Kind::cubic, {at(0.7, 0.55), at(0.2, 0.6)}, 1, at(0, 0.55)}};
    return shape;
}

} // namespace

std::vector<Sphere> flake_spheres(std::uint32_t generations) {
    std::vector<Sphere> spheres;
    add_flake(spheres, {{0, 0, 0}, 0.5}, {0, 0, 1}, generations);
    return spheres;
}

std::vector<Sphere> shell_spheres(std::uint32_t size) {
    // Nine turns, six of them to where the radius is 1; it grows by exp(0.15) with each radian.
    constexpr double growth = 0.15 * 3.14159265358979323846 / 180;
    const std::size_t steps = std::size_t{180} << size;
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i <= steps; ++i) {
        const double angle = 9 * degrees(i, steps) - 6 * 360;
        const double radius = std::exp(growth * angle);
        spheres.push_back({radius * Vec3{sin_degrees(angle), cos_degrees(angle), -2}, radius});
    }
    return spheres;
}

std::vector<RotationalShape> goblet_shapes(std::size_t side) {
    const double middle = static_cast<double>(side - 1) / 2;
    std::vector<RotationalShape> shapes;
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j) {
            const Vec3 foot = {static_cast<double>(i) - middle, 0, static_cast<double>(j) - middle};
            const double width = 0.35 + 0.2 * random_part(3, i, j);
            shapes.push_back(goblet(foot, width, 0.8 + 0.8 * random_part(4, i, j)));
        }
    return shapes;
}

} // namespace vera
