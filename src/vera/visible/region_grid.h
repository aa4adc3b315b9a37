// SPDX-License-Identifier: Apache-2.0
// Point location by walking in a grid of squares. Each has the borders that pass through it, and a
// point of which the region is known. From there to the point that is asked about there are few
// borders to cross, and the last of them tells.
#pragma once

#include "vera/visible/region_locator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

class RegionGrid : public RegionLocator {
public:
    /// Throws Cancelled.
    explicit RegionGrid(MapSegments segments, const CancelFlag* cancel = nullptr);

    std::uint32_t region_at(const MapPoint& point, LocatorSteps& steps) const override;

    std::size_t memory() const override;

    std::uint64_t build_steps() const override { return build_steps_; }

private:
    /// Where a walk begins.
    struct Known {
        MapPoint point;
        std::uint32_t region = no_region;
    };

    std::size_t column_of(double x) const;
    void list_segments(const CancelFlag* cancel);
    void find_known_points(const CancelFlag* cancel);
    template <typename Visit>
    void for_each_cell(std::uint32_t segment, const Visit& visit) const;
    std::uint32_t region_after_walk(
        const Known& from,
        const MapPoint& to,
        std::span<const std::uint32_t> segments,
        LocatorSteps& steps) const;
    bool is_on(std::uint32_t segment, const MapPoint& point) const;
    bool is_nearer(std::uint32_t a, std::uint32_t b, const MapPoint& to) const;

    std::span<const std::uint32_t> of_cell(std::size_t cell) const {
        return std::span(listed_).subspan(starts_[cell], starts_[cell + 1] - starts_[cell]);
    }

    MapSegments segments_;
    std::size_t side_ = 1; ///< so many cells each way
    std::vector<Known> known_;
    std::vector<std::size_t> starts_;
    std::vector<std::uint32_t> listed_;
    std::uint64_t build_steps_ = 0;
};

} // namespace vera
