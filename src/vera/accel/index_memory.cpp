// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/index_memory.h"

#include "vera/base/available_memory.h"

#include <limits>
#include <stdexcept>

namespace vera::detail {

std::size_t memory_to_give() {
    return available_memory().value_or(std::numeric_limits<std::size_t>::max());
}

void refuse_index_that_does_not_fit(const std::string& index, const IndexForecast& forecast) {
    if (forecast.bytes <= forecast.available_bytes)
        return;
    const auto mebibytes = [](std::size_t size) { return std::to_string((size >> 20U) + 1); };
    throw std::runtime_error(
        index + " needs about " + mebibytes(forecast.bytes) + " MiB of memory, and "
        + mebibytes(forecast.available_bytes)
        + " MiB are available: call repeated parts of the scene as subscenes, or render it on a "
          "larger machine");
}

} // namespace vera::detail
