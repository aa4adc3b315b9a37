// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// Gives equal points the same number: a hash table of four bytes a slot beside the points
/// themselves. 0 and -0 are equal.
class SharedPoints {
public:
    /// The points are those of a mesh, none yet.
    explicit SharedPoints(std::vector<Vec3>& points);

    /// The number of the point, which is added when it is new. There must be fewer than 2^32 - 1.
    std::uint32_t number_of(Vec3 point);

private:
    std::size_t slot_of(Vec3 point) const;
    void grow();

    static constexpr std::uint32_t empty = 0xffffffff;

    std::vector<Vec3>& points_;
    std::vector<std::uint32_t> slots_; ///< a power of two of them, at most five eighths used
};

} // namespace vera
