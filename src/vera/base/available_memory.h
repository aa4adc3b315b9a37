// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace vera {

/// Bytes of memory that this process could still take without swapping and without breaking the
/// limits that are set for it; nothing when the system does not tell.
std::optional<std::uint64_t> available_memory();

} // namespace vera
