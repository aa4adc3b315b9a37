// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vera {

/// Bytes of memory that this process holds; 0 where the system does not tell.
std::uint64_t held_memory();

} // namespace vera
