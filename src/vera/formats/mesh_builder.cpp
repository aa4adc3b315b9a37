// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/mesh_builder.h"

#include "vera/formats/reserve_room.h"

#include <cmath>

#include <fmt/format.h>

namespace vera {

namespace {

/// The triangle's unit normal; zero where it has no area.
Vec3 face_normal(Vec3 a, Vec3 b, Vec3 c) {
    Vec3 u = b - a;
    Vec3 v = c - a;
    Vec3 normal = cross(u, v);
    const double size = max_component(abs(normal));
    // Tiny and huge triangles: their products would under- or overflow.
    if (!(size > 1e-280 && size < 1e280)) {
        const double largest = std::max(max_component(abs(u)), max_component(abs(v)));
        if (!(largest > 0) || !std::isfinite(largest))
            return {};
        int exponent = 0;
        std::frexp(largest, &exponent);
        for (Vec3* const side : {&u, &v})
            *side = {
                std::ldexp(side->x, -exponent),
                std::ldexp(side->y, -exponent),
                std::ldexp(side->z, -exponent)};
        normal = cross(u, v);
    }
    return normalized(normal);
}

} // namespace

bool is_without_area(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 normal = cross(b - a, c - a);
    if (normal.x != 0 || normal.y != 0 || normal.z != 0)
        return false;
    return face_normal(a, b, c) == Vec3{};
}

void MeshBuilder::reserve(std::size_t positions, std::size_t normals, std::size_t triangles) {
    reserve_room(mesh_.positions, positions);
    reserve_room(mesh_.normals, normals);
    reserve_room(mesh_.position_indices, 3 * triangles);
}

bool MeshBuilder::room_for_another(const std::vector<Vec3>& points, std::size_t offset) {
    if (points.size() < most_triangles)
        return true;
    report_.error(
        offset,
        1,
        fmt::format("more than {} vertices or normals in one mesh", most_triangles),
        "split the mesh into several files");
    return false;
}

bool MeshBuilder::add_face(std::span<const MeshCorner> corners, std::size_t offset) {
    if (mesh_.triangle_count() + corners.size() - 2 > triangle_limit_) {
        report_.error(
            offset,
            1,
            fmt::format("more than {} triangles in one mesh", triangle_limit_),
            "split the mesh into several files");
        return false;
    }
    if (corners.size() > 3)
        add_polygon(corners, offset);
    else if (!add_triangle(corners[0], corners[1], corners[2]))
        without_area_.add(offset);
    return true;
}

void MeshBuilder::add_polygon(std::span<const MeshCorner> corners, std::size_t offset) {
    outline_.resize(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
        outline_[i] = mesh_.positions[corners[i].position];
    const OutlineKind outline = split_polygon(outline_, triangles_);
    const std::size_t before = mesh_.position_indices.size();
    for (const auto& [a, b, c] : triangles_)
        add_triangle(corners[a], corners[b], corners[c]);
    if (mesh_.position_indices.size() == before)
        without_area_.add(offset);
    else if (outline == OutlineKind::tangled)
        tangled_.add(offset);
}

bool MeshBuilder::add_triangle(MeshCorner a, MeshCorner b, MeshCorner c) {
    if (is_without_area(
            mesh_.positions[a.position], mesh_.positions[b.position], mesh_.positions[c.position]))
        return false;
    mesh_.position_indices.insert(
        mesh_.position_indices.end(), {a.position, b.position, c.position});
    add_normals(a, b, c);
    return true;
}

/// Keeps normal_indices empty as long as they equal position_indices, or as there is no normal.
void MeshBuilder::add_normals(MeshCorner a, MeshCorner b, MeshCorner c) {
    const bool given = a.normal != MeshCorner::no_normal && b.normal != MeshCorner::no_normal
        && c.normal != MeshCorner::no_normal;
    any_missing_normal_ = any_missing_normal_ || !given;
    if (!given && !any_normal_)
        return;
    if (!given)
        a.normal = b.normal = c.normal = MeshCorner::no_normal;
    std::vector<std::uint32_t>& normals = mesh_.normal_indices;
    const std::size_t before = mesh_.position_indices.size() - 3;
    const bool as_positions =
        a.normal == a.position && b.normal == b.position && c.normal == c.position;
    const bool as_all_positions = normals.empty() && as_positions && (any_normal_ || before == 0);
    if (!as_all_positions) {
        if (normals.empty()) {
            reserve_room(normals, mesh_.position_indices.capacity());
            if (any_normal_)
                normals.assign(mesh_.position_indices.begin(), mesh_.position_indices.end() - 3);
            else
                normals.assign(before, MeshCorner::no_normal);
        }
        normals.insert(normals.end(), {a.normal, b.normal, c.normal});
    }
    any_normal_ = true;
}

/// Triangles without normals, among others with, get their own.
void MeshBuilder::complete_normals() {
    if (!any_normal_) {
        mesh_.normals.clear();
        mesh_.normals.shrink_to_fit();
        mesh_.normal_indices.clear();
        return;
    }
    if (!any_missing_normal_)
        return;
    for (std::size_t i = 0; i < mesh_.normal_indices.size(); i += 3) {
        if (mesh_.normal_indices[i] != MeshCorner::no_normal)
            continue;
        if (!room_for_another(mesh_.normals, 0))
            return;
        const auto corner = [&](std::size_t c) {
            return mesh_.positions[mesh_.position_indices[i + c]];
        };
        const auto number = static_cast<std::uint32_t>(mesh_.normals.size());
        mesh_.normals.push_back(face_normal(corner(0), corner(1), corner(2)));
        for (std::size_t c = 0; c < 3; ++c)
            mesh_.normal_indices[i + c] = number;
    }
}

Mesh MeshBuilder::finish(std::vector<Diagnostic>& warnings) {
    if (!report_.any_error() && mesh_.position_indices.empty())
        report_.error(
            without_area_.count > 0 ? without_area_.first : report_.source().text().size(),
            1,
            without_area_.count > 0 ? "no face of the mesh has an area" : "the mesh has no face",
            without_area_.count > 0 ? ""
                                    : "a mesh needs triangles: points and lines are not shown");
    if (!report_.any_error())
        complete_normals();
    if (without_area_.count > 0)
        report_.warning(
            without_area_.first,
            1,
            without_area_.count == 1
                ? "a face without area is left out"
                : fmt::format(
                    "{} faces without area are left out, the first of them here",
                    without_area_.count));
    if (tangled_.count > 0)
        report_.warning(
            tangled_.first,
            1,
            tangled_.count == 1
                ? "the sides of a face cross: it is split as well as may be"
                : fmt::format(
                    "the sides of {} faces cross, the first of them here: they are split as well "
                    "as may be",
                    tangled_.count),
            "write such a face as triangles");
    report_.finish(warnings);
    return std::move(mesh_);
}

} // namespace vera
