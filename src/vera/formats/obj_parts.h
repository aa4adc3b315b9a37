// SPDX-License-Identifier: Apache-2.0
// OBJ files with the materials that they name: usemtl says which holds for the faces after it, and
// mtllib which files define them.
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/source_text.h"
#include "vera/scene/primitives.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace vera {

/// What an OBJ file says of materials. The names point into its text.
struct ObjMaterials {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// Triangles from that one up to the next run's.
    struct Run {
        std::uint32_t first_triangle = 0;
        std::uint32_t name = none; ///< number in names
        std::size_t offset = 0;    ///< of the statement
    };

    std::vector<std::string_view> libraries; ///< what stands behind each mtllib
    std::vector<std::string_view> names;     ///< in the order of their first use
    std::vector<Run> runs;                   ///< none is empty
    bool any_left_out = false;               ///< there were more runs than most_runs
};

/// Material runs of one mesh that are meshes of their own at most: each takes some hundred bytes.
constexpr std::size_t most_material_runs = std::size_t{1} << 16U;

/// As read_obj without materials, and what the file says of them.
Mesh read_obj(const SourceText& source, std::vector<Diagnostic>& warnings, ObjMaterials& materials);

/// The triangles between the ends, each run's with those positions and normals alone that it needs.
/// The ends ascend, and the last is the mesh's number of triangles.
std::vector<Mesh> split_mesh(const Mesh& mesh, std::span<const std::uint32_t> ends);

/// The mesh of an OBJ file as a scene without lights: a mesh for each run of triangles of one
/// material, in the order of the file, and of the materials those that have triangles. A file named
/// by mtllib is looked for in the folder of the OBJ file; where it is missing or a material in
/// none, there is a warning, and the material is of default colours. The scene's files are those of
/// materials that were read. Throws InputError as read_obj and read_mtl do, and std::system_error
/// when a file of materials cannot be read.
Scene read_obj_parts(const SourceText& source, std::vector<Diagnostic>& warnings);

} // namespace vera
