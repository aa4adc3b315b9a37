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

/// Balls one behind the other, none touching the next, each a closed mesh of 2 segments^2 or so
/// triangles.
ScreenScene balls(std::uint64_t seed, std::size_t count, std::int32_t segments);

/// Triangles anywhere at any depth, which pass through each other; with `crossings_per_side` only
/// at crossings of a grid of so many, else anywhere.
ScreenScene tangle(std::uint64_t seed, std::size_t count, std::int32_t crossings_per_side = 0);

/// Slivers with their tip in the middle of the picture, each a bit nearer: 2 count edges through
/// one point.
ScreenScene star(std::int32_t count);

/// Triangles of two steps at most beside each other and across long ones of a step.
ScreenScene slivers(std::uint64_t seed, std::size_t count);

/// Frames one within the other, each of the holes of which shows what lies behind.
ScreenScene nested_holes(std::int32_t count);

} // namespace vera::testing
