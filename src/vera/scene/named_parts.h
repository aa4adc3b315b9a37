// SPDX-License-Identifier: Apache-2.0
// Which of the parts that mesh files name an element is in. Parts are ranges of elements, so that
// they take memory by their number, and no mesh is cut into pieces for them.
#pragma once

#include "vera/scene/geometry.h"

#include <cstdint>
#include <vector>

namespace vera {

/// Elements of one item that follow each other and are in the same parts.
struct PartStretch {
    Element first;
    Element end;
    std::uint32_t part = NamedPart::none; ///< number of the smallest one that they are in
};

/// The longest one with that element. In time that goes with the logarithm of the number of parts.
PartStretch stretch_of(const Geometry& geometry, Element element);

/// Of item number i, a mesh, the triangles at which a stretch ends, in ascending order, without the
/// mesh's own end; empty where the whole of it is in the same parts.
std::vector<std::uint32_t> stretch_ends(const Geometry& geometry, std::uint32_t item);

/// The parts that the part of that number is within, and itself, from the outermost on; of none,
/// none.
std::vector<std::uint32_t> parts_around(const Geometry& geometry, std::uint32_t part);

/// Whether another part lies within the part of that number.
bool has_parts_within(const Geometry& geometry, std::uint32_t part);

} // namespace vera
