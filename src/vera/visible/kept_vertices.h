// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/screen_scene.h"
#include "vera/visible/seen_parts.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace vera {

/// Of the vertices of shadows, which are forgotten with these, those between which pieces lie:
/// light by light of one part of the faces after the other.
class KeptVertices {
public:
    /// The vertices of the screen from that one on are those of shadows.
    explicit KeptVertices(std::size_t first)
        : first_(first) {}

    /// Of the screen's vertices of shadows, of which each light has those from there on, keeps
    /// those between which the parts' pieces lie. Edges of these have the numbers from `first` on,
    /// in the order in which vertices are kept.
    void keep(
        std::span<const std::uint32_t> lights,
        const ScreenScene& screen,
        std::span<SeenPart> parts,
        PieceStorage storage);

    /// Adds them to the screen, which has no shadows any more, light by light, and gives the
    /// pieces' edges the numbers that they have there. Leaves none.
    void move_to(ScreenScene& screen, VisiblePieces& pieces);

private:
    std::vector<std::uint32_t> add_to(ScreenScene& screen) const;

    std::size_t first_;
    std::deque<ScreenVertex> vertices_;          // which has no room twice while it grows
    std::vector<std::vector<std::size_t>> ends_; ///< of the parts, of each light, among these
};

} // namespace vera
