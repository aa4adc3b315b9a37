// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>

namespace vera {

/// The rays of a generation that are worked on at a time. A longer one is taken in parts, each
/// followed to its last descendant before the next, so that memory grows with the depth alone and
/// stays in a processor's cache. Sizes from 256 to 2048 were compared.
constexpr std::size_t usual_generation_size = 256;

/// All rays of a picture: those of view, then all that these send on, and so on (VERA 3.3.2,
/// "generation-wise ray tracing"). Memory grows with the picture.
constexpr std::size_t whole_generations = std::numeric_limits<std::size_t>::max();

} // namespace vera
