// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cell_raster.h"
#include "vera/visible/packed_rows.h"

#include <cstddef>
#include <vector>

namespace vera {

/// A list of a few thousand pieces of edges that follow each other, in half of its room: their
/// numbers are near each other, so that they take few bits. Without what penetrates.
class PackedPieces {
public:
    PackedPieces() = default;
    explicit PackedPieces(const VisiblePieces& list);

    std::size_t size() const { return pieces_.size(); }

    std::size_t points() const { return points_.size(); }

    std::size_t unlit() const { return unlit_.size(); }

    /// Bytes that it takes.
    std::size_t room() const { return points_.room() + pieces_.room() + unlit_.room(); }

    VisiblePieces unpacked() const;

    PackedPoint point(std::size_t i) const;

    void forget_points() { points_ = {}; }

private:
    PackedRows<5> points_; ///< RationalPoint
    PackedRows<6> pieces_; ///< VisiblePiece, as row_of() has it
    PackedRows<2> unlit_;  ///< UnlitBeside, or empty
};

} // namespace vera
