// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/source_report.h"
#include "vera/scene/polygon_triangles.h"
#include "vera/scene/primitives.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// A corner of a face: numbers in Mesh::positions and, where the file gives one, Mesh::normals.
struct MeshCorner {
    static constexpr std::uint32_t no_normal = 0xffffffff;

    std::uint32_t position = 0;
    std::uint32_t normal = no_normal;
};

/// Makes a mesh of faces with any number of corners. The positions of a face's corners must be in
/// the mesh before the face.
class MeshBuilder {
public:
    /// As many as Scene can number.
    static constexpr std::uint64_t most_triangles = (std::uint64_t{1} << 32U) - 2;

    explicit MeshBuilder(SourceReport& report, std::uint64_t triangle_limit = most_triangles)
        : report_(report)
        , triangle_limit_(triangle_limit) {}

    Mesh& mesh() { return mesh_; }

    /// Makes room, so that the vectors need not be copied while they grow. All are only
    /// estimates.
    void reserve(std::size_t positions, std::size_t normals, std::size_t triangles);

    /// Whether the mesh can have another position, or another normal. Complains where not.
    bool room_for_another(const std::vector<Vec3>& points, std::size_t offset);

    /// Whether the mesh has room for the face, of three or more corners, that stands at the offset.
    /// Complains where not.
    bool add_face(std::span<const MeshCorner> corners, std::size_t offset);

    /// The mesh, its normals complete. Throws InputError when the report holds an error, or when
    /// there is no triangle.
    Mesh finish(std::vector<Diagnostic>& warnings);

private:
    /// Whether it has an area.
    bool add_triangle(MeshCorner a, MeshCorner b, MeshCorner c);
    void add_polygon(std::span<const MeshCorner> corners, std::size_t offset);
    void add_normals(MeshCorner a, MeshCorner b, MeshCorner c);
    void complete_normals();

    SourceReport& report_;
    std::uint64_t triangle_limit_;
    Mesh mesh_;
    bool any_normal_ = false;
    bool any_missing_normal_ = false;
    Tally without_area_;
    Tally tangled_;
    std::vector<Vec3> outline_;
    std::vector<CornerTriple> triangles_;
};

/// Whether the triangle has no area: two corners are equal, or all three exactly on a line.
bool is_without_area(Vec3 a, Vec3 b, Vec3 c);

} // namespace vera
