// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/mesh_file.h"
#include "vera/formats/nff.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

using MeshReader = Mesh (*)(const SourceText&, std::vector<Diagnostic>&);

/// The mesh of a text with which nothing is wrong; its warnings are of no interest.
inline Mesh mesh_of(MeshReader read, const std::string& text) {
    std::vector<Diagnostic> warnings;
    return read(SourceText("test", text), warnings);
}

inline std::string printed(const std::vector<Diagnostic>& diagnostics) {
    std::string text;
    for (const Diagnostic& diagnostic : diagnostics)
        text += to_text(diagnostic);
    return text;
}

/// What is said of a mesh, as it is printed: warnings, or when it is wrong, all diagnostics.
inline std::string said_of(MeshReader read, const std::string& text) {
    std::vector<Diagnostic> warnings;
    try {
        read(SourceText("test", text), warnings);
    } catch (const InputError& error) {
        return printed(error.diagnostics());
    }
    return printed(warnings);
}

inline std::string said_of_nff(const std::string& text) {
    try {
        return printed(read_nff(SourceText("test.nff", text)).warnings);
    } catch (const InputError& error) {
        return printed(error.diagnostics());
    }
}

/// The corners of triangle i.
inline std::vector<Vec3> triangle(const Mesh& mesh, std::size_t i) {
    std::vector<Vec3> corners;
    for (std::size_t c = 0; c < 3; ++c)
        corners.push_back(mesh.positions[mesh.position_indices[3 * i + c]]);
    return corners;
}

/// The normals of triangle i.
inline std::vector<Vec3> triangle_normals(const Mesh& mesh, std::size_t i) {
    const auto& indices = mesh.normal_indices.empty() ? mesh.position_indices : mesh.normal_indices;
    std::vector<Vec3> normals;
    for (std::size_t c = 0; c < 3; ++c)
        normals.push_back(mesh.normals[indices[3 * i + c]]);
    return normals;
}

/// The vector area of all triangles together, doubled.
inline Vec3 doubled_area(const Mesh& mesh) {
    Vec3 sum;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        const std::vector<Vec3> corners = triangle(mesh, i);
        sum = sum + cross(corners[1] - corners[0], corners[2] - corners[0]);
    }
    return sum;
}

enum class ByteOrder : std::uint8_t { little, big };

/// Adds the bytes of a value in that order, whatever the machine's.
template <typename Value>
void append(std::string& bytes, Value value, ByteOrder order) {
    std::uint64_t bits = 0;
    if constexpr (sizeof(Value) == 8) {
        std::memcpy(&bits, &value, 8);
    } else if constexpr (sizeof(Value) == 4) {
        std::uint32_t few = 0;
        std::memcpy(&few, &value, 4);
        bits = few;
    } else if constexpr (sizeof(Value) == 2) {
        std::uint16_t few = 0;
        std::memcpy(&few, &value, 2);
        bits = few;
    } else {
        bits = static_cast<std::uint8_t>(value);
    }
    for (std::size_t i = 0; i < sizeof(Value); ++i) {
        const std::size_t byte = order == ByteOrder::little ? i : sizeof(Value) - 1 - i;
        bytes += static_cast<char>((bits >> (8 * byte)) & 0xffU);
    }
}

} // namespace vera
