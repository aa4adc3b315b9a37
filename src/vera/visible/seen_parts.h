// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cell_raster.h"
#include "vera/visible/packed_pieces.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

namespace vera {

/// How a part of what is seen is kept until it is asked for.
enum class PieceStorage {
    plain,  ///< as a list, in which a point may be there more than once
    packed, ///< as PackedPieces, with each point once
};

/// Of so many edges, or pieces. To pack few takes longer than to ask the system for their room.
constexpr PieceStorage storage_of(std::size_t edges) {
    constexpr std::size_t few = std::size_t{1} << 16U;
    return edges < few ? PieceStorage::plain : PieceStorage::packed;
}

/// A part of what is seen: pieces of edges that follow each other, with points of their own. They
/// are worked on as a list, and then kept again.
class SeenPart {
public:
    SeenPart() = default;
    SeenPart(const VisiblePieces& list, PieceStorage storage);
    SeenPart(VisiblePieces&& list, PieceStorage storage);

    /// How many pieces it has.
    std::size_t size() const;

    std::size_t points() const;
    std::size_t unlit() const;

    /// Bytes that the pieces take.
    std::size_t room() const;

    /// Without what penetrates, as is that which take() returns.
    VisiblePieces list() const;

    /// Leaves nothing.
    VisiblePieces take();

    PackedPoint point(std::size_t i) const {
        if (const auto* list = std::get_if<VisiblePieces>(&pieces_))
            return list->points[i];
        return std::get<PackedPieces>(pieces_).point(i);
    }

    void forget_points();

    std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating;

private:
    std::variant<VisiblePieces, PackedPieces> pieces_;
};

/// Parts that are the list when they are joined again, without its lights and what penetrates: each
/// can be forgotten before the others.
std::vector<SeenPart> parts_of(const VisiblePieces& list);

/// Copies pieces of a list to the end of another, with those of their points that it did not copy
/// there before.
class PieceCopy {
public:
    PieceCopy(const VisiblePieces& from, VisiblePieces& list)
        : from_(from)
        , list_(list)
        , numbers_(from.points.size(), none) {}

    void add(std::size_t i) {
        VisiblePiece piece = from_.pieces[i];
        for (std::uint32_t* point : {&piece.from, &piece.to}) {
            std::uint32_t& number = numbers_[*point];
            if (number == none) {
                number = static_cast<std::uint32_t>(list_.points.size());
                list_.points.push_back(from_.points[*point]);
            }
            *point = number;
        }
        list_.pieces.push_back(piece);
        if (!from_.unlit.empty())
            list_.unlit.push_back(from_.unlit[i]);
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    const VisiblePieces& from_;
    VisiblePieces& list_;
    std::vector<std::uint32_t> numbers_; ///< of the points, in the list they are copied to, or none
};

/// Edges from first to before last, which are followed one after the other, and the pieces of those
/// of them that are not followed again.
struct EdgePart {
    std::size_t first = 0;
    std::size_t last = 0;
    SeenPart kept;
};

/// What is seen of a scene, in parts: what a round of cutting begins and ends with.
struct SeenPieces {
    std::vector<SeenPart> parts; ///< by the edges of their pieces
    std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating; ///< as of VisiblePieces
};

} // namespace vera
