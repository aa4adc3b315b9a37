// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/inner_point.h"

#include "vera/exact/orientation.h"
#include "vera/solids/shells.h"
#include "vera/solids/solid_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vera {

namespace {

/// A plane that the point must lie behind: of a triangle that runs counterclockwise as seen from
/// outside.
struct Wall {
    std::array<Vec3, 3> corners;
    Vec3 normal; ///< unit, outwards
};

/// Of each face whether its corners run clockwise as seen from outside: as its solid says, or else
/// its item.
std::vector<bool> turned_faces(const Geometry& geometry, const SolidFaces& faces) {
    std::vector<bool> turned(faces.faces.size());
    for (std::size_t i = 0; i < turned.size(); ++i)
        turned[i] = geometry.items[faces.faces[i].item].outside == Outside::against_normal;
    for (const Shell& shell : shells(faces))
        if (shell.has_inside)
            for (std::size_t i = 0; i < shell.faces.size(); ++i)
                turned[shell.faces[i]] = shell.is_turned[i];
    return turned;
}

std::vector<Wall>
walls_of(const Geometry& geometry, const SolidFaces& faces, std::span<const std::uint32_t> items) {
    const std::vector<bool> turned = turned_faces(geometry, faces);
    std::vector<Wall> walls;
    for (const SolidFaces::Triangle& triangle : faces.triangles) {
        if (std::ranges::find(items, faces.faces[triangle.face].item) == items.end())
            continue;
        auto [a, b, c] = faces.corners_of(triangle);
        if (turned[triangle.face])
            std::swap(b, c);
        walls.push_back({{a, b, c}, normalized(cross(b - a, c - a))});
    }
    return walls;
}

bool is_inside(const std::vector<Wall>& walls, Vec3 point) {
    return std::ranges::all_of(walls, [&](const Wall& wall) {
        const auto [a, b, c] = wall.corners;
        return orientation(a, b, c, point) < 0;
    });
}

/// Moves a point behind the wall that it is farthest before, again and again, until it is behind
/// all by the margin, or time is up.
Vec3 moved_behind(const std::vector<Wall>& walls, Vec3 point, double margin) {
    constexpr int most_moves = 1000;
    for (int i = 0; i < most_moves; ++i) {
        double farthest = -margin;
        const Wall* before = nullptr;
        for (const Wall& wall : walls) {
            const double distance = dot(wall.normal, point - wall.corners[0]);
            if (distance > farthest) {
                farthest = distance;
                before = &wall;
            }
        }
        if (before == nullptr)
            break;
        point = point - 1.01 * (farthest + margin) * before->normal;
    }
    return point;
}

/// The point with so few digits that people like to read it.
Vec3 rounded(Vec3 point, double unit) {
    const auto round = [&](double value) { return std::round(value / unit) * unit; };
    return {round(point.x), round(point.y), round(point.z)};
}

} // namespace

std::optional<Vec3> inner_point(const Geometry& geometry, std::span<const std::uint32_t> items) {
    const SolidFaces faces = solid_faces(geometry);
    const std::vector<Wall> walls = walls_of(geometry, faces, items);
    if (walls.empty())
        return std::nullopt;
    Vec3 sum;
    Vec3 lower = walls[0].corners[0];
    Vec3 upper = lower;
    for (const Wall& wall : walls)
        for (const Vec3 corner : wall.corners) {
            sum = sum + corner;
            lower = min(lower, corner);
            upper = max(upper, corner);
        }
    const double size = max_component(upper - lower);
    const Vec3 middle = sum / (3.0 * static_cast<double>(walls.size()));
    // The more room, the better: other faces may be added.
    for (const double margin : {0.2, 0.1, 0.05, 0.02, 0.005, 1e-3, 1e-5}) {
        const Vec3 point = moved_behind(walls, middle, margin * size);
        if (!is_inside(walls, point))
            continue;
        const double unit = std::pow(10, std::floor(std::log10(size)));
        for (const double part : {0.1, 0.01, 0.001})
            if (const Vec3 round = rounded(point, part * unit); is_inside(walls, round))
                return round;
        return point;
    }
    return std::nullopt;
}

} // namespace vera
