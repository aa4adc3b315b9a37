// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/packed_pieces.h"

#include "vera/base/parallel.h"
#include "vera/visible/point_numbers.h"

#include <algorithm>

namespace vera {

namespace {

constexpr std::uint32_t as_32_bits(std::uint64_t number) {
    return static_cast<std::uint32_t>(number);
}

/// So that no_triangle is 0, and not far above all others.
constexpr std::uint32_t after(std::uint32_t triangle) {
    return triangle + 1;
}

static_assert(after(no_triangle) == 0);

constexpr std::uint32_t before(std::uint64_t number) {
    return as_32_bits(number) - 1;
}

/// Where triangles have no vertices in common, those of an edge follow each other.
PackedRows<6>::Row row_of(const VisiblePiece& piece) {
    return {
        piece.from,
        piece.to,
        piece.edge.begin,
        piece.edge.end - piece.edge.begin,
        after(piece.left),
        after(piece.right)};
}

ScreenEdges::Edge edge_of(std::uint64_t begin, std::uint64_t length) {
    return {as_32_bits(begin), as_32_bits(begin + length)};
}

} // namespace

PackedPieces::PackedPieces(const VisiblePieces& list)
    : points(
        list.points.size(),
        [&](std::size_t i) {
            const RationalPoint point = list.points[i];
            const auto bits = [](std::int64_t number) {
                return static_cast<std::uint64_t>(number);
            };
            return PackedRows<5>::Row{
                bits(point.whole.x),
                bits(point.whole.y),
                bits(point.x_numerator),
                bits(point.y_numerator),
                bits(point.denominator)};
        })
    , pieces(list.pieces.size(), [&](std::size_t i) { return row_of(list.pieces[i]); })
    , unlit(
          list.unlit.size(),
          [&](std::size_t i) {
              return PackedRows<2>::Row{list.unlit[i].left, list.unlit[i].right};
          })
    , penetrating(list.penetrating) {}

VisiblePiece PackedPieces::piece(std::size_t i) const {
    const auto [from, to, begin, length, left, right] = pieces[i];
    return {as_32_bits(from), as_32_bits(to), edge_of(begin, length), before(left), before(right)};
}

ScreenEdges::Edge PackedPieces::edge(std::size_t i) const {
    return edge_of(pieces.at(i, 2), pieces.at(i, 3));
}

UnlitBeside PackedPieces::unlit_beside(std::size_t i) const {
    if (unlit.empty())
        return {};
    const auto [left, right] = unlit[i];
    return {as_32_bits(left), as_32_bits(right)};
}

PackedPoint PackedPieces::point(std::size_t i) const {
    const auto [x, y, x_numerator, y_numerator, denominator] = points[i];
    return RationalPoint{
        {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
        static_cast<std::int64_t>(x_numerator),
        static_cast<std::int64_t>(y_numerator),
        static_cast<std::int64_t>(denominator)};
}

VisiblePieces PackedPieces::unpacked() const {
    VisiblePieces list;
    for (std::size_t i = 0; i < points.size(); ++i)
        list.points.push_back(point(i));
    for (std::size_t i = 0; i < size(); ++i)
        list.pieces.push_back(piece(i));
    for (std::size_t i = 0; i < unlit.size(); ++i)
        list.unlit.push_back(unlit_beside(i));
    list.penetrating = penetrating;
    return list;
}

std::vector<PackedPieces> parts_of(const VisiblePieces& list) {
    constexpr std::size_t most = 4096; // pieces
    const std::size_t count = list.pieces.size();
    std::vector<PackedPieces> parts((count + most - 1) / most);
    parallel_ranges(parts.size(), 1, [&](std::size_t number, std::size_t) {
        VisiblePieces part;
        PointNumbers numbers(part.points, 2 * most);
        for (std::size_t i = number * most; i < std::min(count, (number + 1) * most); ++i) {
            VisiblePiece piece = list.pieces[i];
            piece.from = numbers.number(list.points[piece.from]);
            piece.to = numbers.number(list.points[piece.to]);
            part.pieces.push_back(piece);
        }
        parts[number] = PackedPieces(part);
    });
    return parts;
}

void PieceCopy::add(std::size_t i) {
    VisiblePiece piece = part_.piece(i);
    for (std::uint32_t* point : {&piece.from, &piece.to}) {
        std::uint32_t& number = numbers_[*point];
        if (number == none) {
            number = static_cast<std::uint32_t>(list_.points.size());
            list_.points.push_back(part_.point(*point));
        }
        *point = number;
    }
    list_.pieces.push_back(piece);
    if (!part_.unlit.empty())
        list_.unlit.push_back(part_.unlit_beside(i));
}

} // namespace vera
