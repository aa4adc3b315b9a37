// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// A tree of boxes round points of space (a k-d tree), which tells the points that lie in a box.
class PointBoxes {
public:
    /// Of the points, which must outlive it. Takes O(m log m).
    explicit PointBoxes(std::span<const Vec3> points);

    /// Appends the numbers of the points in the box, its border included.
    void append_in(const Box3& box, std::vector<std::uint32_t>& numbers) const;

private:
    struct Node {
        Box3 box;
        std::uint32_t first = 0; ///< of numbers_
        std::uint32_t last = 0;
        std::uint32_t second = 0; ///< child; the first one is the next node. None has 0
    };

    void add_node(std::uint32_t first, std::uint32_t last);

    std::span<const Vec3> points_;
    std::vector<std::uint32_t> numbers_;
    std::vector<Node> nodes_;
};

} // namespace vera
