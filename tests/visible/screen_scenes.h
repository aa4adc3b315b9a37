// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/screen_scene.h"

#include <cstdint>
#include <random>

namespace vera::testing {

/// Triangles in layers, none of which passes through another: with corners on so few crossings of a
/// grid that most events fall together. Some layers slant, some hold several triangles, and some
/// triangles come twice.
ScreenScene layers(std::uint64_t seed, std::size_t count, std::int32_t crossings_per_side);

/// Small triangles anywhere, each in a layer of its own, of that many steps.
ScreenScene scattered(std::uint64_t seed, std::size_t count, std::int32_t size);

/// A surface of columns x columns quadrangles over the picture that rises and falls.
ScreenScene terrain(std::uint64_t seed, std::int32_t columns);

/// Triangles anywhere at any depth, which pass through each other.
ScreenScene tangle(std::uint64_t seed, std::size_t count);

/// Balls one behind the other, none touching the next, each a closed mesh of 2 segments^2 or so
/// triangles.
ScreenScene balls(std::uint64_t seed, std::size_t count, std::int32_t segments);

} // namespace vera::testing
