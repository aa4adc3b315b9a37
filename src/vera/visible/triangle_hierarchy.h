// SPDX-License-Identifier: Apache-2.0
// Point location in a hierarchy of triangles (Kirkpatrick 1983; step 4 of VERA 3.2). Points of at
// most eight neighbours, of which no two are neighbours, are taken out of a triangulation, and the
// holes are filled with fewer triangles. Each of those knows the ones that it overlaps. As at least
// a fixed part of all points goes each time, there are O(log m) levels, and all of them together
// have O(m) triangles. A point is located in the last level, and then from level to level.
#pragma once

#include "vera/visible/map_triangulation.h"
#include "vera/visible/region_locator.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

class TriangleHierarchy : public RegionLocator {
public:
    /// Throws Cancelled.
    explicit TriangleHierarchy(MapTriangulation map, const CancelFlag* cancel = nullptr);

    std::uint32_t region_at(const MapPoint& point, LocatorSteps& steps) const override;

    std::size_t memory() const override;

    std::uint64_t build_steps() const override { return build_steps_; }

    /// Of triangles, one over the other.
    std::size_t levels() const { return levels_; }

private:
    friend class TriangleHierarchyBuilder;

    struct Triangle {
        std::array<std::uint32_t, 3> corners = {};
        std::uint32_t overlap_count = 0; ///< of the level below; 0: in the map itself
        std::uint32_t first = 0; ///< of the overlapped ones in overlapped_; in the map, the region
    };

    bool contains(const Triangle& triangle, const MapPoint& point, LocatorSteps& steps) const;

    std::vector<MapPoint> points_;
    std::vector<Triangle> triangles_; ///< level by level; the last ones are the last level
    std::vector<std::uint32_t> overlapped_;
    std::vector<std::uint32_t> last_level_;
    std::size_t levels_ = 0;
    std::uint64_t build_steps_ = 0;
};

} // namespace vera
