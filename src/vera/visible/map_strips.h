// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// A side of a ring, in steps of the grid, with its upper end (of the smaller y) first: both rings
/// along it have the same numbers.
struct MapSide {
    double x = 0;
    double y = 0;
    double to_x = 0;
    double to_y = 0;
    std::uint32_t source = 0; ///< seen on one side of it
    bool is_right_end = true; ///< of what is seen along a row: the source lies on its left

    /// Whether a row passes it, ends counted so that of two sides that go on in each other one is
    /// passed.
    bool crosses(double row) const { return y <= row && row < to_y; }

    /// Where that row does.
    double x_at(double row) const { return x + (row - y) * (to_x - x) / (to_y - y); }
};

/// The sides of all rings, sorted into equal strips across the picture.
class MapStrips {
public:
    /// Throws Cancelled.
    MapStrips(const VisibleMap& map, double strip_height, const CancelFlag* cancel = nullptr);

    std::size_t count() const { return starts_.size() - 1; }

    /// The strip that the row lies in.
    std::size_t strip_of(double y) const;

    /// The numbers of the sides that touch the strip, by source.
    std::span<const std::uint32_t> of_strip(std::size_t strip) const {
        return std::span(listed_).subspan(starts_[strip], starts_[strip + 1] - starts_[strip]);
    }

    const MapSide& operator[](std::uint32_t side) const { return sides_[side]; }

private:
    double strip_height_;
    std::vector<MapSide> sides_;
    std::vector<std::size_t> starts_;
    std::vector<std::uint32_t> listed_;
};

/// Calls visit(sides) for those of each source.
template <typename Visit>
void for_each_source(
    const MapStrips& strips, std::span<const std::uint32_t> sides, const Visit& visit) {
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        const std::uint32_t source = strips[sides[first]].source;
        while (last < sides.size() && strips[sides[last]].source == source)
            ++last;
        visit(source, sides.subspan(first, last - first));
    }
}

} // namespace vera
