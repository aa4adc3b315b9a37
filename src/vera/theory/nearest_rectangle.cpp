// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/nearest_rectangle.h"

#include <limits>

namespace vera {

NearnessOfNode
nearness_of(std::span<const IsoRectangle> rectangles, std::span<const std::uint32_t> numbers) {
    NearnessOfNode found = {
        std::numeric_limits<std::int32_t>::max(),
        std::numeric_limits<std::int32_t>::min(),
        std::numeric_limits<std::uint32_t>::max()};
    for (const std::uint32_t number : numbers) {
        found.lowest_z = std::min(found.lowest_z, rectangles[number].z);
        found.highest_z = std::max(found.highest_z, rectangles[number].z);
        found.least_number = std::min(found.least_number, number);
    }
    return found;
}

} // namespace vera
