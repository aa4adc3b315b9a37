// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/map_segments.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace vera {

/// Counted while points were located. Each thread counts its own.
struct LocatorSteps {
    std::uint64_t queries = 0;
    std::uint64_t comparisons = 0; ///< of a point with a line, or with another by x

    LocatorSteps& operator+=(const LocatorSteps& more) {
        queries += more.queries;
        comparisons += more.comparisons;
        return *this;
    }
};

/// Finds the region of a map that a point lies in (VERA 3.2, step 5). Exact. May be asked from many
/// threads.
class RegionLocator {
public:
    RegionLocator() = default;
    RegionLocator(const RegionLocator&) = delete;
    RegionLocator& operator=(const RegionLocator&) = delete;
    virtual ~RegionLocator() = default;

    /// The region, or no_region. On a border, any of those that meet there.
    virtual std::uint32_t region_at(const MapPoint& point, LocatorSteps& steps) const = 0;

    /// Bytes of memory that it holds.
    virtual std::size_t memory() const = 0;

    /// Counted while it was built: points compared with lines, and what it was made of.
    virtual std::uint64_t build_steps() const { return 0; }
};

/// For maps of m borders.
enum class LocatorKind : std::uint8_t {
    hierarchy, ///< Kirkpatrick's triangles: O(log m) steps, O(m) memory
    slabs,     ///< a persistent tree over slabs: O(log m) steps expected, O(m) memory
    grid       ///< some steps on the average where borders are spread evenly, at worst O(m)
};

/// All of them take O(m log m) to build, but for a grid's lists, and answer the same. They need the
/// map no longer. Throws Cancelled, std::runtime_error where the memory that is available does not
/// suffice, and, but for a grid, CrossingBorders where they cannot be told from below to above:
/// that may happen where things penetrate each other (see VisibleMap::joined).
std::unique_ptr<RegionLocator>
make_locator(LocatorKind kind, const VisibleMap& map, const CancelFlag* cancel = nullptr);

/// What make_locator() takes for so many sides of rings, in bytes, while it builds: somewhat more
/// than was measured. A grid of borders that are as long as the picture takes more.
double locator_bytes(LocatorKind kind, double sides);

/// The reference of all: looks at each border.
std::unique_ptr<RegionLocator> make_brute_force_locator(const VisibleMap& map);

} // namespace vera
