// SPDX-License-Identifier: Apache-2.0
// What the indexes of pictures visit to answer a ray among rectangles.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vera::testing {

/// Cells or nodes, and tests of a ray with half a rectangle.
struct IndexVisits {
    std::uint64_t uniform_grid = 0;
    std::uint64_t tree_of_grids = 0;
    std::uint64_t hierarchy_of_boxes = 0;
};

/// z, lower and upper x, lower and upper y.
using PlacedRectangle = std::array<double, 5>;

class RectangleIndexes {
public:
    explicit RectangleIndexes(const std::vector<PlacedRectangle>& rectangles);
    ~RectangleIndexes();
    RectangleIndexes(const RectangleIndexes&) = delete;
    RectangleIndexes& operator=(const RectangleIndexes&) = delete;

    IndexVisits
    visits(const std::array<double, 3>& origin, const std::array<double, 3>& direction) const;

private:
    struct Made;
    std::unique_ptr<Made> made_;
};

} // namespace vera::testing
