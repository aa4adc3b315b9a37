// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"

#include <cstdint>
#include <vector>

namespace vera::testing {

/// A piece between points at which something that is seen ends or turns, from left to right.
struct MaximalPiece {
    RationalPoint from;
    RationalPoint to;
    std::uint32_t left = 0; ///< sources
    std::uint32_t right = 0;
    ScreenStep way;

    friend bool operator==(const MaximalPiece& a, const MaximalPiece& b) {
        return a.from == b.from && a.to == b.to && a.left == b.left && a.right == b.right;
    }

    friend bool operator<(const MaximalPiece& a, const MaximalPiece& b);
};

/// The pieces, joined where nothing else ends, in an order that is no matter of how they were
/// found: what two engines, or one engine in another scene, have in common when they see the same.
std::vector<MaximalPiece> maximal_pieces(const ScreenScene& scene, const VisiblePieces& found);

} // namespace vera::testing
