// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

namespace vera {

/// A whole number of -reach to reach, the same for the same state on every machine.
inline std::int32_t whole_within(std::int32_t reach, std::mt19937_64& random) {
    const auto values = static_cast<std::uint64_t>(2 * std::int64_t{reach} + 1);
    return static_cast<std::int32_t>(static_cast<std::int64_t>(random() % values) - reach);
}

} // namespace vera
