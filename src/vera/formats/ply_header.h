// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/source_report.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);

/// property float x | property list uchar int vertex_indices
struct PlyProperty {
    std::string_view name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type; ///< of a list
};

struct PlyElement {
    std::string_view name;
    std::uint64_t count = 0;
    std::size_t offset = 0; ///< of its line
    std::vector<PlyProperty> properties;

    /// The number of the property, if there is one of that name.
    std::optional<std::size_t> property(std::string_view property_name) const;
};

struct PlyHeader {
    enum class Encoding : std::uint8_t { ascii, little_endian, big_endian };

    Encoding encoding = Encoding::ascii;
    std::vector<PlyElement> elements;
    std::size_t data = 0; ///< where the first element begins

    const PlyElement* element(std::string_view name) const;
};

/// Throws InputError when there is anything wrong with the header, or when the file is too short
/// for the elements that it promises: so that no count needs to be doubted later.
PlyHeader read_ply_header(const SourceText& source);

/// The fewest bytes that one element takes.
std::size_t smallest_size(const PlyElement& element, PlyHeader::Encoding encoding);

} // namespace vera
