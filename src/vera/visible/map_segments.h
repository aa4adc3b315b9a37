// SPDX-License-Identifier: Apache-2.0
// The borders of a map as segments, each once, and what is asked about them exactly: what the
// structures that locate points in a map are made of.
#pragma once

#include "vera/base/parallel.h"
#include "vera/exact/screen_point.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace vera {

/// A point of a map or one that is asked about, in steps of the grid; x and y are off by less than
/// 2^-30.
struct MapPoint {
    RationalPoint exact;
    double x = 0;
    double y = 0;
};

MapPoint map_point(const RationalPoint& point);

/// The nearest point of the picture with coordinates that are whole numbers of 2^-20 steps.
MapPoint map_point(double x, double y);

/// Negative, 0 or positive as a has the smaller x, the same, or the larger. Exact, as the others.
int order_by_x(const MapPoint& a, const MapPoint& b);

/// The same by x, then by y.
int order(const MapPoint& a, const MapPoint& b);

/// Positive where the point lies above the way from one point to another in the direction of
/// ascending x, to its left; 0 on its line.
int side(const MapPoint& from, const MapPoint& to, const MapPoint& point);

/// Thrown by structures that need borders to meet at points alone.
class CrossingBorders : public std::runtime_error {
public:
    CrossingBorders()
        : std::runtime_error("borders of what is seen cross each other") {}
};

/// A part of a border, from the end that comes first in the order of points. Segments meet at their
/// ends, or the end of one touches another.
struct MapSegment {
    std::uint32_t begin = 0; ///< in MapSegments::points
    std::uint32_t end = 0;
    std::uint32_t above = no_region; ///< seen to the left of the way from begin to end
    std::uint32_t below = no_region;
};

struct MapSegments {
    std::vector<MapPoint> points; ///< in their order, each once
    std::vector<MapSegment> segments;

    const MapPoint& begin(std::uint32_t segment) const { return points[segments[segment].begin]; }

    const MapPoint& end(std::uint32_t segment) const { return points[segments[segment].end]; }

    /// Of the segment's line.
    int side(std::uint32_t segment, const MapPoint& point) const {
        return vera::side(begin(segment), end(segment), point);
    }

    /// Of two segments that one vertical line crosses, or that begin in the same point.
    bool is_above(std::uint32_t a, std::uint32_t b) const;

    bool is_vertical(std::uint32_t segment) const {
        return order_by_x(begin(segment), end(segment)) == 0;
    }

    std::size_t bytes() const {
        return points.capacity() * sizeof(MapPoint) + segments.capacity() * sizeof(MapSegment);
    }
};

/// The borders of the map. Where ways round what is seen had to be joined by straight ones (see
/// VisibleMap::joined), those are among them, and may cross others. Throws Cancelled.
MapSegments map_segments(const VisibleMap& map, const CancelFlag* cancel = nullptr);

} // namespace vera
