// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/scene/geometry.h"
#include "vera/scene/prepared_ray.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Where the outline of a plane polygon passes, as the plane is seen along one of the axes: cut
/// into strips of equal height, each with the sides that touch it.
struct OutlineStrips {
    Box3 bounds;                     ///< of the corners, exactly
    double deviation = 0;            ///< the farthest that a corner lies from the polygon's plane
    double size = 0;                 ///< the largest coordinate of a corner, without its sign
    double Vec3::*u_axis = &Vec3::x; ///< along the strips
    double Vec3::*v_axis = &Vec3::y; ///< across them
    double strips_per_unit = 0;
    double cells_per_unit = 0;
    std::uint32_t strip_count = 0;
    std::size_t first_strip = 0; ///< in OutlineTable::starts and cells
};

/// A strip, cut across into cells of equal width, a bit for each.
struct StripCells {
    static constexpr std::uint32_t count = 64;

    std::uint64_t known = 0;  ///< no side of the polygon touches the cell
    std::uint64_t inside = 0; ///< of those that are known: the polygon covers it
};

/// The outlines of a geometry's polygons of many corners. Takes memory in proportion to the
/// corners.
struct OutlineTable {
    std::vector<std::uint32_t> numbers; ///< by polygon: of its strips from 1 on, or 0 for none
    std::vector<OutlineStrips> outlines;
    std::vector<std::uint32_t> starts; ///< strip i has the sides [starts[i]] to [starts[i + 1]]
    std::vector<std::uint32_t> sides;  ///< by the number, within its polygon, of their first corner
    std::vector<StripCells> cells;     ///< of strip i

    /// Nothing for a polygon that has none: few corners are gone through as quickly.
    const OutlineStrips* of_polygon(std::size_t polygon) const {
        const std::uint32_t number = polygon < numbers.size() ? numbers[polygon] : 0;
        return number == 0 ? nullptr : &outlines[number - 1];
    }
};

OutlineTable outline_table(const Geometry& geometry);

/// Bytes of memory that the table holds.
std::size_t memory(const OutlineTable& table);

/// At most so much will the geometry's table take.
std::size_t most_memory_of_outline_table(const Geometry& geometry);

enum class InclusionStatus : std::uint8_t { outside, inside, uncertain };

/// What meets_outline() answers for the polygon with these corners, or uncertain where the ray
/// passes its outline within what rounding, or the unevenness of the polygon, may move that. The
/// ray meets the polygon's plane at t, with speed, the part of its direction along the normal.
InclusionStatus inclusion_status(
    const OutlineTable& table,
    const OutlineStrips& outline,
    std::span<const Vec3> corners,
    const PreparedRay& prepared,
    double t,
    double speed);

} // namespace vera
