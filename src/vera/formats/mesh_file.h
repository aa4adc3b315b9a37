// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/source_text.h"
#include "vera/scene/primitives.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vera {

/// The triangles of a mesh file: OBJ, PLY or STL by the name's extension, and where that says
/// nothing, by the file's beginning. Faces of more corners are split. Throws InputError with the
/// first twenty things that are wrong, and std::system_error when the file cannot be read; what the
/// author should know besides is added to warnings.
Mesh read_mesh(const std::filesystem::path& path, std::vector<Diagnostic>& warnings);

/// Wavefront OBJ: v, vn and f with their continuation lines; everything else is passed over.
Mesh read_obj(const SourceText& source, std::vector<Diagnostic>& warnings);

/// Of each triangle that read_obj makes of a text without errors, the line of its face, from 1.
std::vector<std::uint32_t> obj_triangle_lines(const SourceText& source);

/// PLY, ascii or binary of either byte order: the elements vertex (x y z, nx ny nz) and face
/// (vertex_indices), in any order, among any others.
Mesh read_ply(const SourceText& source, std::vector<Diagnostic>& warnings);

/// STL, ascii or binary. Corners that are equal become one, so that the triangles hang together.
Mesh read_stl(const SourceText& source, std::vector<Diagnostic>& warnings);

} // namespace vera
