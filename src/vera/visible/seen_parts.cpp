// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/seen_parts.h"

#include "vera/base/free_room.h"
#include "vera/base/parallel.h"
#include "vera/visible/point_numbers.h"

#include <algorithm>

namespace vera {

SeenPart::SeenPart(const VisiblePieces& list, PieceStorage storage)
    : penetrating(list.penetrating) {
    if (storage == PieceStorage::packed) {
        pieces_ = PackedPieces(list);
        return;
    }
    VisiblePieces& plain = pieces_.emplace<VisiblePieces>();
    plain.points = list.points;
    plain.pieces = list.pieces;
    plain.unlit = list.unlit;
}

SeenPart::SeenPart(VisiblePieces&& list, PieceStorage storage)
    : penetrating(std::move(list.penetrating)) {
    if (storage == PieceStorage::packed)
        pieces_ = PackedPieces(list);
    else
        pieces_ = std::move(list);
}

std::size_t SeenPart::size() const {
    if (const auto* packed = std::get_if<PackedPieces>(&pieces_))
        return packed->size();
    return std::get<VisiblePieces>(pieces_).pieces.size();
}

std::size_t SeenPart::points() const {
    if (const auto* packed = std::get_if<PackedPieces>(&pieces_))
        return packed->points();
    return std::get<VisiblePieces>(pieces_).points.size();
}

std::size_t SeenPart::unlit() const {
    if (const auto* packed = std::get_if<PackedPieces>(&pieces_))
        return packed->unlit();
    return std::get<VisiblePieces>(pieces_).unlit.size();
}

std::size_t SeenPart::room() const {
    if (const auto* packed = std::get_if<PackedPieces>(&pieces_))
        return packed->room();
    const auto& list = std::get<VisiblePieces>(pieces_);
    return list.points.capacity() * sizeof(PackedPoint)
        + list.pieces.capacity() * sizeof(VisiblePiece)
        + list.unlit.capacity() * sizeof(UnlitBeside);
}

VisiblePieces SeenPart::list() const {
    if (const auto* packed = std::get_if<PackedPieces>(&pieces_))
        return packed->unpacked();
    return std::get<VisiblePieces>(pieces_);
}

VisiblePieces SeenPart::take() {
    VisiblePieces list;
    if (const auto* packed = std::get_if<PackedPieces>(&pieces_))
        list = packed->unpacked();
    else
        list = std::move(std::get<VisiblePieces>(pieces_));
    pieces_ = VisiblePieces();
    return list;
}

void SeenPart::forget_points() {
    if (auto* packed = std::get_if<PackedPieces>(&pieces_))
        packed->forget_points();
    else
        free_room(std::get<VisiblePieces>(pieces_).points);
}

std::vector<SeenPart> parts_of(const VisiblePieces& list) {
    constexpr std::size_t most = 4096; // pieces
    const std::size_t count = list.pieces.size();
    const PieceStorage storage = storage_of(count);
    std::vector<SeenPart> parts((count + most - 1) / most);
    parallel_ranges(parts.size(), 1, [&](std::size_t number, std::size_t) {
        VisiblePieces part;
        PointNumbers numbers(part.points, 2 * most);
        for (std::size_t i = number * most; i < std::min(count, (number + 1) * most); ++i) {
            VisiblePiece piece = list.pieces[i];
            piece.from = numbers.number(list.points[piece.from]);
            piece.to = numbers.number(list.points[piece.to]);
            part.pieces.push_back(piece);
        }
        parts[number] = SeenPart(std::move(part), storage);
    });
    return parts;
}

} // namespace vera
