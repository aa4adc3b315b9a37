// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vera {

/// The steps of a cell raster, which are the same on every machine and for any number of threads.
struct CellCounts {
    std::uint64_t cells = 0;
    /// Squares of cells in which large triangles were looked for, and the cells of those that are
    /// not hidden in squares, and of all others; those in which they are hidden as well.
    std::uint64_t touched = 0;
    std::uint64_t entries = 0; ///< of the cells' lists
    std::uint64_t edges = 0;
    std::uint64_t edge_cells = 0; ///< and squares of them, asked whether an edge is hidden there
    std::uint64_t followed = 0;   ///< edges that are not hidden as a whole
    std::uint64_t followed_cells = 0; ///< of these edges
    std::uint64_t looked_at = 0;      ///< entries of the lists there
    std::uint64_t candidates = 0;     ///< different triangles there, which edges were compared with
    std::uint64_t events = 0;         ///< at which they begin, end or touch an edge
    std::uint64_t active = 0;         ///< of them between two events, summed up
    std::uint64_t depth_orders = 0;   ///< of two triangles

    /// Of counts of different edges of one scene.
    void add_followed(const CellCounts& other) {
        followed += other.followed;
        followed_cells += other.followed_cells;
        looked_at += other.looked_at;
        candidates += other.candidates;
        events += other.events;
        active += other.active;
        depth_orders += other.depth_orders;
    }
};

} // namespace vera
