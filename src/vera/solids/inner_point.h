// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/geometry.h"

#include <cstdint>
#include <optional>
#include <span>

namespace vera {

/// A point that is right as the inner point of these items: inside of each of their faces that
/// belongs to a closed solid, and of the others on the side where their inner point lies now. By
/// exact tests; few digits where these do. Nothing where none was found, since there is none, or
/// hardly any room for one.
std::optional<Vec3> inner_point(const Geometry& geometry, std::span<const std::uint32_t> items);

} // namespace vera
