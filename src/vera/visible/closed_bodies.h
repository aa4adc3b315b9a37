// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/scene/facets.h"

#include <cstdint>
#include <vector>

namespace vera {

constexpr std::uint32_t no_body = ~std::uint32_t{0};

/// Facets that hang together and have no border: each side belongs to two of them, by the numbers
/// of its corners, which go along it in opposite directions. They enclose a body, or several; which
/// side of them is inside is the same for all that part two places.
struct ClosedBodies {
    std::vector<std::uint32_t> of_facet; ///< the number of its body, or no_body
    std::vector<Box3> boxes;             ///< of the bodies
};

ClosedBodies closed_bodies(const Facets& facets);

} // namespace vera
