// SPDX-License-Identifier: Apache-2.0
#include "meshes.h"

#include "vera/base/check.h"
#include "vera/math/box3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "directions.h"
#include "lattice.h"
#include "round_shapes.h"

namespace vera {

namespace {

/// Adds the points of the unit sphere round the face, divided into four so many times.
void add_divided(Mesh& mesh, std::array<Vec3, 3> face, std::uint32_t times) {
    if (times == 0) {
        const std::uint32_t a = add_corner(mesh, face[0]);
        const std::uint32_t b = add_corner(mesh, face[1]);
        add_triangle(mesh, a, b, add_corner(mesh, face[2]));
        return;
    }
    const Vec3 ab = normalized(face[0] + face[1]);
    const Vec3 bc = normalized(face[1] + face[2]);
    const Vec3 ca = normalized(face[2] + face[0]);
    for (const auto& part :
         {std::array{face[0], ab, ca},
          std::array{ab, face[1], bc},
          std::array{ca, bc, face[2]},
          std::array{ab, bc, ca}})
        add_divided(mesh, part, times - 1);
}

/// The mesh with one corner in place of all that are equal.
Mesh with_shared_corners(const Mesh& mesh) {
    std::map<std::array<double, 3>, std::uint32_t> numbers;
    Mesh result;
    for (const std::uint32_t corner : mesh.position_indices) {
        const Vec3 point = mesh.positions[corner];
        const auto next = static_cast<std::uint32_t>(result.positions.size());
        const auto [at, is_new] = numbers.try_emplace({point.x, point.y, point.z}, next);
        if (is_new)
            add_corner(result, point);
        result.position_indices.push_back(at->second);
    }
    return result;
}

Mesh unit_sphere(std::uint32_t divisions) {
    Mesh mesh;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) {
                std::array<Vec3, 3> face = {Vec3{x, 0, 0}, Vec3{0, y, 0}, Vec3{0, 0, z}};
                if (x * y * z < 0)
                    std::swap(face[1], face[2]);
                add_divided(mesh, face, divisions);
            }
    return with_shared_corners(mesh);
}

void add_copy(Mesh& mesh, const Mesh& part, double scale, Vec3 shift) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& point : part.positions)
        add_corner(mesh, scale * point + shift);
    for (const std::uint32_t corner : part.position_indices)
        mesh.position_indices.push_back(first + corner);
}

/// A flat piece of so many by so many quadrangles.
void add_parallelogram(Mesh& mesh, Vec3 corner, Vec3 right, Vec3 up, std::size_t pieces) {
    const auto n = static_cast<double>(pieces);
    add_lattice(mesh, pieces, pieces, [&](std::size_t i, std::size_t j) {
        return corner + (static_cast<double>(i) / n) * right + (static_cast<double>(j) / n) * up;
    });
}

/// The radius of a column at a height from 0 to 1: base, shaft and capital.
double column_radius(double height) {
    constexpr double shaft = 0.8;
    const double from_end = std::min(height, 1 - height);
    if (from_end > 0.08)
        return shaft * (1 - 0.15 * height);
    const double part = from_end / 0.08;
    return shaft * (1.6 - 0.6 * part * part) * (1 - 0.15 * height);
}

void add_column(Mesh& mesh, Vec3 foot, double height, std::size_t segments) {
    const std::size_t rings = segments - segments / 8;
    add_lattice(mesh, segments, rings, [&](std::size_t i, std::size_t j) {
        const double h = static_cast<double>(j) / static_cast<double>(rings);
        const double flutes = 1 + 0.03 * cos_degrees(16 * degrees(i, segments));
        const double radius = column_radius(h) * flutes;
        const double angle = degrees(i, segments);
        return foot + Vec3{radius * cos_degrees(angle), h * height, radius * sin_degrees(angle)};
    });
}

} // namespace

Mesh tessellated(const Sphereflake& flake) {
    const Mesh unit = unit_sphere(flake.divisions);
    Mesh mesh;
    for (const Sphere& sphere : flake_spheres(flake.generations))
        add_copy(mesh, unit, sphere.radius, sphere.center);
    return mesh;
}

Mesh hall_mesh(std::size_t segments) {
    const Vec3 corner = {-30, 0, -18};
    const Vec3 x = {60, 0, 0};
    const Vec3 y = {0, 16, 0};
    const Vec3 z = {0, 0, 36};
    Mesh mesh;
    for (const auto& [from, right, up] :
         {std::array{corner, z, x},
          std::array{corner + y, x, z},
          std::array{corner, x, y},
          std::array{corner + z, y, x},
          std::array{corner, y, z},
          std::array{corner + x, z, y}})
        add_parallelogram(mesh, from, right, up, std::max<std::size_t>(segments / 4, 1));
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 5; ++j)
            add_column(mesh, {6.0 * (i - 4), 0, 6.5 * (j - 2)}, 16, segments);
    return mesh;
}

Mesh mountain_mesh(std::size_t side) {
    VERA_CHECK(side > 0 && (side & (side - 1)) == 0);
    std::vector<double> heights((side + 1) * (side + 1));
    const auto height = [&](std::size_t i, std::size_t j) -> double& {
        return heights[j * (side + 1) + i];
    };
    double reach = 0.5;
    for (std::size_t step = side; step > 1; step /= 2, reach /= 2) {
        const std::size_t half = step / 2;
        const auto displaced = [&](std::size_t i, std::size_t j, double mean) {
            height(i, j) = mean + reach * (random_part(step, i, j) - 0.5);
        };
        for (std::size_t j = 0; j <= side; j += step)
            for (std::size_t i = half; i < side; i += step)
                displaced(i, j, (height(i - half, j) + height(i + half, j)) / 2);
        for (std::size_t j = half; j < side; j += step)
            for (std::size_t i = 0; i <= side; i += half)
                displaced(i, j, (height(i, j - half) + height(i, j + half)) / 2);
    }
    Mesh mesh;
    const auto n = static_cast<double>(side);
    add_lattice(mesh, side, side, [&](std::size_t i, std::size_t j) {
        return Vec3{
            2 * static_cast<double>(i) / n - 1, height(i, j), 1 - 2 * static_cast<double>(j) / n};
    });
    return mesh;
}

namespace {

/// A piece of a tree: where it begins, how it goes on, and its place among all pieces.
struct Branch {
    Vec3 from;
    Vec3 direction;
    double length = 3;
    double radius = 0.3;
    std::uint64_t number = 1;
};

void add_leaf(Mesh& mesh, Vec3 from, Vec3 direction, double length) {
    const auto [right, forward] = across(direction);
    const Vec3 middle = from + (0.5 * length) * direction + (0.1 * length) * forward;
    const std::uint32_t stem = add_corner(mesh, from);
    const std::uint32_t left_side = add_corner(mesh, middle - (0.25 * length) * right);
    const std::uint32_t right_side = add_corner(mesh, middle + (0.25 * length) * right);
    const std::uint32_t tip = add_corner(mesh, from + length * direction);
    add_triangle(mesh, stem, right_side, left_side);
    add_triangle(mesh, left_side, right_side, tip);
}

void add_branch(Mesh& mesh, const Branch& branch, std::uint32_t forks) {
    constexpr std::size_t sides = 8;
    const Across round = across(branch.direction);
    const Vec3 to = branch.from + branch.length * branch.direction;
    add_lattice(mesh, sides, 1, [&](std::size_t i, std::size_t j) {
        const double radius = j == 0 ? branch.radius : 0.7 * branch.radius;
        return (j == 0 ? branch.from : to) + radius * turned(round, degrees(i, sides));
    });
    const auto part = [&](std::uint64_t sample) { return random_part(7, branch.number, sample); };
    if (forks == 0) {
        for (std::uint64_t i = 0; i < 4; ++i)
            add_leaf(
                mesh,
                branch.from + part(3 * i) * (to - branch.from),
                bent(branch.direction, 30 + 50 * part(3 * i + 1), 360 * part(3 * i + 2)),
                0.12);
        return;
    }
    const double turn = 360 * part(0);
    for (std::uint64_t i = 0; i < 3; ++i) {
        const double angle = 20 + 25 * part(i + 1);
        const Vec3 direction = bent(branch.direction, angle, turn + 120 * static_cast<double>(i));
        add_branch(
            mesh,
            {to,
             direction,
             branch.length * (0.68 + 0.12 * part(i + 4)),
             0.7 * branch.radius,
             3 * branch.number + i},
            forks - 1);
    }
}

} // namespace

Mesh tree_mesh(std::uint32_t forks) {
    Mesh mesh;
    add_parallelogram(mesh, {-12, 0, 12}, {24, 0, 0}, {0, 0, -24}, 16);
    add_branch(mesh, {{0, 0, 0}, {0, 1, 0}}, forks);
    return mesh;
}

Mesh stadium_mesh(std::size_t segments) {
    Mesh mesh;
    add_parallelogram(mesh, {-60, 0, 40}, {120, 0, 0}, {0, 0, -80}, 16);
    const std::size_t rows = segments / 25;
    // Of each row: the tread's front edge, the seat's foot, the seat's top, the foot of the riser.
    constexpr std::array<std::array<double, 2>, 4> profile = {
        {{0, 0}, {0.55, 0}, {0.6, 0.8}, {0.95, 0}}};
    add_lattice(mesh, segments, 4 * rows, [&](std::size_t i, std::size_t j) {
        const auto& [out, up] = profile[j % 4];
        const std::size_t row_number = j / 4;
        const auto row = static_cast<double>(row_number);
        const double from_ground = (row + out) / static_cast<double>(rows);
        const double height = 2 + 34 * (row + up) / static_cast<double>(rows);
        const double angle = degrees(i, segments);
        return Vec3{
            (55 + 55 * from_ground) * cos_degrees(angle),
            j == 0 ? 0 : height,
            (35 + 55 * from_ground) * sin_degrees(angle)};
    });
    return mesh;
}

void add_model(Mesh& mesh, const Mesh& part, double size, Vec3 place) {
    Box3 box;
    for (const Vec3& point : part.positions)
        box = grown(box, point);
    const double scale = size / (box.upper.x - box.lower.x);
    const Vec3 foot = {
        (box.lower.x + box.upper.x) / 2, box.lower.y, (box.lower.z + box.upper.z) / 2};
    add_copy(mesh, part, scale, place - scale * foot);
}

void round_to_floats(Mesh& mesh) {
    const auto rounded = [](double value) {
        return static_cast<double>(static_cast<float>(value));
    };
    for (Vec3& point : mesh.positions)
        point = {rounded(point.x), rounded(point.y), rounded(point.z)};
}

} // namespace vera
