// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

namespace vera {

/// A whole number from 0 and below the end, which is 1 at least; the same for the same state on
/// every machine.
inline std::int32_t whole_below(std::int32_t end, std::mt19937_64& random) {
    return static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(end));
}

} // namespace vera
