// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace vera {

/// What of the bytes is in memory already.
enum class Written { all, nothing };

/// Asks the system to keep these bytes in large pages, so that the processor finds them faster
/// where they are read all over the place, and fewer pages are handed out where they are first
/// written. Nothing but speed follows from it, and it may not be granted. Bytes that are written
/// already are moved; those that are not take memory only when they are.
void prefer_large_pages(const void* first, std::size_t bytes, Written written) noexcept;

} // namespace vera
