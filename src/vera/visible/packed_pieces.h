// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cell_raster.h"
#include "vera/visible/packed_rows.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vera {

/// A part of what is seen, in half the room of the same list: a few thousand pieces of edges that
/// follow each other, with points of their own. Their numbers are near each other, so that they
/// take few bits. As long as nobody asks for all pieces they stand in such parts.
struct PackedPieces {
    PackedPieces() = default;
    explicit PackedPieces(const VisiblePieces& list);

    std::size_t size() const { return pieces.size(); }

    VisiblePiece piece(std::size_t i) const;
    ScreenEdges::Edge edge(std::size_t i) const;
    UnlitBeside unlit_beside(std::size_t i) const;
    PackedPoint point(std::size_t i) const;
    VisiblePieces unpacked() const;

    PackedRows<5> points; ///< RationalPoint
    PackedRows<6> pieces; ///< VisiblePiece, as row_of() has it
    PackedRows<2> unlit;  ///< UnlitBeside, or empty
    std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating;
};

/// Parts that are the list when they are joined again, without its lights and what penetrates: each
/// can be forgotten before the others.
std::vector<PackedPieces> parts_of(const VisiblePieces& list);

/// Copies pieces of a part to the end of a list, with those of their points that it did not copy
/// there before.
class PieceCopy {
public:
    PieceCopy(const PackedPieces& part, VisiblePieces& list)
        : part_(part)
        , list_(list) {
        start();
    }

    /// The list is another one now.
    void start() { numbers_.assign(part_.points.size(), none); }

    void add(std::size_t i);

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    const PackedPieces& part_;
    VisiblePieces& list_;
    std::vector<std::uint32_t> numbers_; ///< of the part's points in the list, or none
};

} // namespace vera
