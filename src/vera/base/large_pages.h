// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace vera {

/// Asks the system to keep these bytes, which are read all over the place, in large pages, so that
/// the processor finds them faster. Nothing but speed follows from it, and it may not be granted.
/// Best before the bytes are first written; else they are moved.
void prefer_large_pages(const void* first, std::size_t bytes) noexcept;

} // namespace vera
