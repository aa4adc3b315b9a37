// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_locator.h"

#include "vera/base/available_memory.h"
#include "vera/visible/map_triangulation.h"
#include "vera/visible/region_grid.h"
#include "vera/visible/slab_tree.h"
#include "vera/visible/triangle_hierarchy.h"

#include <optional>
#include <string>
#include <utility>

namespace vera {

namespace {

class BruteForceLocator : public RegionLocator {
public:
    explicit BruteForceLocator(const VisibleMap& map)
        : segments_(map_segments(map)) {}

    /// By the highest of the borders that lie below the point or go through it.
    std::uint32_t region_at(const MapPoint& point, LocatorSteps& steps) const override {
        ++steps.queries;
        std::optional<std::uint32_t> highest;
        for (std::uint32_t i = 0; i < segments_.segments.size(); ++i) {
            steps.comparisons += 2;
            if (order_by_x(segments_.begin(i), point) <= 0
                && order_by_x(point, segments_.end(i)) < 0 && segments_.side(i, point) >= 0
                && (!highest || segments_.is_above(i, *highest)))
                highest = i;
        }
        return highest ? segments_.segments[*highest].above : no_region;
    }

    std::size_t memory() const override { return segments_.bytes(); }

private:
    MapSegments segments_;
};

} // namespace

std::unique_ptr<RegionLocator>
make_locator(LocatorKind kind, const VisibleMap& map, const CancelFlag* cancel) {
    require_memory(
        locator_bytes(kind, static_cast<double>(map.ring_vertices.size())),
        "finding points among " + std::to_string(map.ring_vertices.size()) + " borders",
        "simpler meshes, and a scene with fewer of them, have fewer borders");
    MapSegments segments = map_segments(map, cancel);
    switch (kind) {
    case LocatorKind::hierarchy:
        return std::make_unique<TriangleHierarchy>(triangulation(segments, cancel), cancel);
    case LocatorKind::slabs:
        return std::make_unique<SlabTree>(std::move(segments), cancel);
    case LocatorKind::grid:
        break;
    }
    return std::make_unique<RegionGrid>(std::move(segments), cancel);
}

double locator_bytes(LocatorKind kind, double sides) {
    // Of scattered triangles 261, 157 and 107; of meshes half as much.
    return sides * (kind == LocatorKind::hierarchy ? 320 : 200);
}

std::unique_ptr<RegionLocator> make_brute_force_locator(const VisibleMap& map) {
    return std::make_unique<BruteForceLocator>(map);
}

} // namespace vera
