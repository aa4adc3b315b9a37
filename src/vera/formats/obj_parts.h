// SPDX-License-Identifier: Apache-2.0
// OBJ files with what they say of their faces: the materials that they name (usemtl says which
// holds for the faces after it, and mtllib which files define them), objects (o) and groups (g).
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/source_text.h"
#include "vera/scene/primitives.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace vera {

/// What an OBJ file says of its triangles. The names point into its text. A run is of triangles
/// from its first one up to the next run's; none is empty.
struct ObjAttributes {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    struct MaterialRun {
        std::uint32_t first_triangle = 0;
        std::uint32_t material = none; ///< number in materials
        std::size_t offset = 0;        ///< of the statement
    };

    struct NameRun {
        std::uint32_t first_triangle = 0;
        std::string_view object; ///< that they are of; empty: none
        std::string_view group;  ///< likewise; within the object
    };

    std::vector<std::string_view> libraries; ///< what stands behind each mtllib
    std::vector<std::string_view> materials; ///< names in the order of their first use
    std::vector<MaterialRun> material_runs;
    bool materials_left_out = false; ///< there were more than most_material_runs
    std::vector<NameRun> name_runs;
    std::optional<std::size_t> names_left_out_at; ///< offset of that beyond most_name_runs
};

/// Material runs of one mesh that are meshes of their own at most: each takes some hundred bytes.
constexpr std::size_t most_material_runs = std::size_t{1} << 16U;

/// Runs of names at most. Each takes up to two parts of less than 100 bytes, and its names.
constexpr std::size_t most_name_runs = std::size_t{1} << 18U;

/// As read_obj without attributes, and what the file says of its triangles.
Mesh read_obj(
    const SourceText& source, std::vector<Diagnostic>& warnings, ObjAttributes& attributes);

/// The triangles between the ends, each run's with those positions and normals alone that it needs.
/// The ends ascend, and the last is the mesh's number of triangles.
std::vector<Mesh> split_mesh(const Mesh& mesh, std::span<const std::uint32_t> ends);

/// Whether the materials that an OBJ file names are taken or passed over.
enum class ObjMaterials : std::uint8_t { of_file, none };

/// The mesh of an OBJ file as a scene without lights: a mesh for each run of triangles of one
/// material, in the order of the file, and of the materials those that have triangles; its objects
/// and groups are named parts. A group lies within the object before it. A file named by mtllib is
/// looked for in the folder of the OBJ file; where it is missing or a material in none, there is a
/// warning, and the material is of default colours. The scene's files are those of materials that
/// were read. Throws InputError as read_obj and read_mtl do, and std::system_error when a file of
/// materials cannot be read.
Scene read_obj_parts(
    const SourceText& source,
    std::vector<Diagnostic>& warnings,
    ObjMaterials materials = ObjMaterials::of_file);

} // namespace vera
