// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"

#include <cstddef>
#include <string>

namespace vera::detail {

/// Throws std::runtime_error when the index needs more bytes than the machine has to give.
void refuse_index_that_does_not_fit(const std::string& index, const IndexForecast& forecast);

/// What available_memory() says; where it says nothing, all that there could be.
std::size_t memory_to_give();

} // namespace vera::detail
