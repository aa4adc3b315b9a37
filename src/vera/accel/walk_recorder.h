// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/packet_query.h"
#include "vera/accel/ray_walk.h"

#include <cstddef>
#include <cstdint>

namespace vera::detail {

/// The one ray of a plain walk is that of the first lane.
constexpr LaneMask walking_lane = 1;

inline bool is_active(const PacketQuery& query) {
    return (query.active & walking_lane) != 0;
}

/// Keeps what a plain walk does.
class WalkRecorder {
public:
    explicit WalkRecorder(RayWalk& walk)
        : walk_(walk) {}

    /// The main scene's place, and that of the element, a call in a place; return their numbers.
    std::size_t enter_scene();
    std::size_t enter_call(std::size_t place, const Frame& frame, std::uint32_t element);

    /// Returns the step's number.
    std::size_t add(WalkStep step);

    /// Notes that the step's list holds the element, and what becomes of it.
    WalkedObject& add_object(
        std::size_t step,
        const Frame& frame,
        std::uint32_t element,
        WalkedObject::Outcome outcome = WalkedObject::Outcome::missed);

    /// The same for an element that is tested, which is no call: whether the ray meets it is asked
    /// in the arithmetic that decides.
    void
    add_test(std::size_t step, const PacketQuery& query, const Frame& frame, std::uint32_t element);

    /// Tests all that a call holds which is nested too deeply to be walked through.
    void
    add_plain_search(std::size_t step, PacketQuery& query, Frame& frame, std::uint32_t element);

private:
    RayWalk& walk_;
};

/// Walks through the query's geometries, which are GeometryGrids, with the first of its rays, and
/// tells its recorder. Does to the query what search_grids() does.
void walk_grids(PacketQuery& query);

/// The same for GeometryTrees, and search_trees().
void walk_trees(PacketQuery& query);

} // namespace vera::detail
