// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/packed_pieces.h"

#include <cstdint>

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

VisiblePiece piece_of(const PackedRows<6>::Row& row) {
    const auto [from, to, begin, length, left, right] = row;
    return {
        as_32_bits(from),
        as_32_bits(to),
        {as_32_bits(begin), as_32_bits(begin + length)},
        before(left),
        before(right)};
}

PackedRows<5>::Row row_of(const RationalPoint& point) {
    const auto bits = [](std::int64_t number) { return static_cast<std::uint64_t>(number); };
    return {
        bits(point.whole.x),
        bits(point.whole.y),
        bits(point.x_numerator),
        bits(point.y_numerator),
        bits(point.denominator)};
}

PackedPoint point_of(const PackedRows<5>::Row& row) {
    const auto [x, y, x_numerator, y_numerator, denominator] = row;
    return RationalPoint{
        {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
        static_cast<std::int64_t>(x_numerator),
        static_cast<std::int64_t>(y_numerator),
        static_cast<std::int64_t>(denominator)};
}

} // namespace

PackedPieces::PackedPieces(const VisiblePieces& list)
    : points_(
        list.points.size(), [&](std::size_t i) { return row_of(RationalPoint(list.points[i])); })
    , pieces_(list.pieces.size(), [&](std::size_t i) { return row_of(list.pieces[i]); })
    , unlit_(list.unlit.size(), [&](std::size_t i) {
        return PackedRows<2>::Row{list.unlit[i].left, list.unlit[i].right};
    }) {}

VisiblePieces PackedPieces::unpacked() const {
    VisiblePieces list;
    list.points.reserve(points_.size());
    points_.for_each([&](const auto& row) { list.points.push_back(point_of(row)); });
    list.pieces.reserve(pieces_.size());
    pieces_.for_each([&](const auto& row) { list.pieces.push_back(piece_of(row)); });
    list.unlit.reserve(unlit_.size());
    unlit_.for_each([&](const auto& row) {
        list.unlit.push_back({as_32_bits(row[0]), as_32_bits(row[1])});
    });
    return list;
}

PackedPoint PackedPieces::point(std::size_t i) const {
    return point_of(points_[i]);
}

} // namespace vera
