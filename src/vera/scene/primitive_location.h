// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/geometry.h"

#include <algorithm>
#include <cstdint>

namespace vera {

/// The item that holds the primitive with this number within the geometry, and how many primitives
/// of the item come before it.
struct PrimitiveLocation {
    std::uint32_t item = 0;
    std::uint64_t within = 0;
};

namespace detail {

inline PrimitiveLocation location_among_compounds(const Geometry& geometry, std::uint64_t number) {
    const auto& compounds = geometry.compounds;
    const auto after = std::upper_bound(
        compounds.begin(),
        compounds.end(),
        number,
        [](std::uint64_t primitive, const Compound& compound) {
            return primitive < compound.first_primitive;
        });
    if (after == compounds.begin())
        return {static_cast<std::uint32_t>(number), 0};
    const Compound& compound = *(after - 1);
    const std::uint64_t within = number - compound.first_primitive;
    // The items up to the next compound hold one primitive each.
    const std::uint64_t end =
        after == compounds.end() ? geometry.primitive_count : after->first_primitive;
    const std::uint64_t next_item = after == compounds.end() ? geometry.items.size() : after->item;
    const std::uint64_t single = next_item - compound.item - 1;
    const std::uint64_t size = end - compound.first_primitive - single;
    if (within < size)
        return {compound.item, within};
    return {static_cast<std::uint32_t>(compound.item + 1 + (within - size)), 0};
}

} // namespace detail

inline PrimitiveLocation location_of(const Geometry& geometry, std::uint64_t number) {
    if (geometry.compounds.empty())
        return {static_cast<std::uint32_t>(number), 0};
    return detail::location_among_compounds(geometry, number);
}

} // namespace vera
