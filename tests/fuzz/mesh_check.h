// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/check.h"
#include "vera/formats/mesh_file.h"

#include <algorithm>
#include <cstdint>
#include <string>

namespace vera {

/// Reads the bytes, and checks that the mesh is one: finite, its indices within their lists.
template <typename Reader>
void check_mesh_reader(const Reader& read, const std::uint8_t* data, std::size_t size) {
    std::vector<Diagnostic> warnings;
    const SourceText source("fuzz", std::string(reinterpret_cast<const char*>(data), size));
    try {
        const Mesh mesh = read(source, warnings);
        VERA_CHECK(mesh.triangle_count() > 0);
        VERA_CHECK(mesh.position_indices.size() % 3 == 0);
        for (const std::uint32_t i : mesh.position_indices)
            VERA_CHECK(i < mesh.positions.size());
        for (const std::vector<Vec3>* points : {&mesh.positions, &mesh.normals})
            VERA_CHECK(std::all_of(points->begin(), points->end(), is_finite));
        const auto& normals = mesh.normal_indices.empty() && !mesh.normals.empty()
            ? mesh.position_indices
            : mesh.normal_indices;
        VERA_CHECK(normals.empty() || normals.size() == mesh.position_indices.size());
        for (const std::uint32_t i : normals)
            VERA_CHECK(i < mesh.normals.size());
    } catch (const InputError& error) {
        VERA_CHECK(!error.diagnostics().empty() && error.diagnostics().size() < 40);
        for (const Diagnostic& diagnostic : error.diagnostics())
            VERA_CHECK(!to_text(diagnostic).empty());
    }
}

} // namespace vera
