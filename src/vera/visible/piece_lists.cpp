// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/piece_lists.h"

#include "vera/base/free_room.h"
#include "vera/base/parallel.h"
#include "vera/visible/first_equal.h"
#include "vera/visible/point_numbers.h"

#include <cstddef>
#include <utility>

namespace vera {

namespace {

/// The points of the parts, each once, in the order in which they come; numbers tells which of them
/// each is, one part's behind the other's. Takes them out of the parts.
std::vector<PackedPoint>
joined_points(std::vector<VisiblePieces>& parts, std::vector<std::uint32_t>& numbers) {
    std::size_t count = 0;
    for (const VisiblePieces& part : parts)
        count += part.points.size();
    std::vector<PackedPoint> points;
    points.reserve(count);
    for (VisiblePieces& part : parts) {
        points.insert(points.end(), part.points.begin(), part.points.end());
        free_room(part.points);
    }
    give_back_freed_memory();
    numbers = first_equal(
        points.size(),
        [&](std::size_t i) { return hash_of(points[i]); },
        [&](std::size_t i, std::size_t j) { return points[i] == points[j]; });
    const std::vector<std::uint32_t> firsts = number_consecutively(numbers);
    for (std::size_t i = 0; i < firsts.size(); ++i)
        points[i] = points[firsts[i]]; // which is not before i
    points.resize(firsts.size());
    return points;
}

/// Of each of the points its number among the others or, where it is none of these, how many these
/// are and its own number.
std::vector<std::uint32_t>
numbers_behind(std::vector<PackedPoint>& others, const std::vector<PackedPoint>& points) {
    const PointNumbers numbers(others, others.size());
    std::vector<std::uint32_t> result(points.size());
    parallel_ranges(points.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            result[i] = numbers.find(points[i]);
            if (result[i] == PointNumbers::none)
                result[i] = static_cast<std::uint32_t>(others.size() + i);
        }
    });
    return result;
}

/// Calls visit(list, i) for the pieces of both lists, by their edges.
template <typename Visit>
void for_each_merged(const VisiblePieces& before, const VisiblePieces& found, const Visit& visit) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < before.pieces.size(); ++i) {
        for (; next < found.pieces.size() && found.pieces[next].edge < before.pieces[i].edge;
             ++next)
            visit(found, next);
        visit(before, i);
    }
    for (; next < found.pieces.size(); ++next)
        visit(found, next);
}

} // namespace

VisiblePieces joined(std::vector<VisiblePieces> parts) {
    std::vector<std::size_t> starts(parts.size() + 1); // of the parts' points
    std::size_t pieces = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        starts[i + 1] = starts[i] + parts[i].points.size();
        pieces += parts[i].pieces.size();
    }
    VisiblePieces result;
    std::vector<std::uint32_t> numbers;
    result.points = joined_points(parts, numbers);
    result.pieces.reserve(pieces);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const VisiblePieces part = std::move(parts[i]);
        const auto number = [&](std::uint32_t point) { return numbers[starts[i] + point]; };
        for (VisiblePiece piece : part.pieces) {
            piece.from = number(piece.from);
            piece.to = number(piece.to);
            result.pieces.push_back(piece);
        }
        result.unlit.insert(result.unlit.end(), part.unlit.begin(), part.unlit.end());
        result.penetrating.insert(
            result.penetrating.end(), part.penetrating.begin(), part.penetrating.end());
    }
    return result;
}

void keep_pieces(const std::vector<std::uint8_t>& is_kept, VisiblePieces& list) {
    const std::size_t count = list.pieces.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (is_kept[i] == 0)
            continue;
        list.pieces[kept] = list.pieces[i];
        if (!list.unlit.empty())
            list.unlit[kept] = list.unlit[i];
        ++kept;
    }
    list.pieces.resize(kept);
    list.unlit.resize(list.unlit.empty() ? 0 : kept);
    if (kept > count / 2)
        return;
    list.pieces.shrink_to_fit();
    list.unlit.shrink_to_fit();
    constexpr std::uint32_t unused = ~std::uint32_t{0};
    std::vector<std::uint32_t> numbers(list.points.size(), unused);
    for (const VisiblePiece& piece : list.pieces)
        numbers[piece.from] = numbers[piece.to] = 0;
    std::uint32_t points = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] != unused) {
            list.points[points] = list.points[i];
            numbers[i] = points++;
        }
    list.points.resize(points);
    list.points.shrink_to_fit();
    for (VisiblePiece& piece : list.pieces) {
        piece.from = numbers[piece.from];
        piece.to = numbers[piece.to];
    }
}

VisiblePieces merged(VisiblePieces before, VisiblePieces found) {
    constexpr std::uint32_t none = PointNumbers::none;
    if (before.pieces.empty())
        return found;
    // Points of both lists have common numbers first: those of the found ones, then the others.
    const std::vector<std::uint32_t> common = numbers_behind(found.points, before.points);
    const auto common_of = [&](const VisiblePieces& list, std::uint32_t point) {
        return &list == &found ? point : common[point];
    };
    // Then the numbers in which the pieces have them, as if all had been followed.
    std::vector<std::uint32_t> numbers(found.points.size() + before.points.size(), none);
    std::uint32_t points = 0;
    std::size_t pieces = 0;
    for_each_merged(before, found, [&](const VisiblePieces& list, std::size_t i) {
        ++pieces;
        for (const std::uint32_t point : {list.pieces[i].from, list.pieces[i].to})
            if (std::uint32_t& number = numbers[common_of(list, point)]; number == none)
                number = points++;
    });
    VisiblePieces result;
    result.points.resize(points);
    for (VisiblePieces* list : {&before, &found}) {
        for (std::uint32_t i = 0; i < list->points.size(); ++i)
            if (const std::uint32_t number = numbers[common_of(*list, i)]; number != none)
                result.points[number] = list->points[i];
        free_room(list->points);
    }
    const bool may_be_unlit = !before.unlit.empty() || !found.unlit.empty();
    result.pieces.reserve(pieces);
    result.unlit.reserve(may_be_unlit ? pieces : 0);
    for_each_merged(before, found, [&](const VisiblePieces& list, std::size_t i) {
        VisiblePiece piece = list.pieces[i];
        piece.from = numbers[common_of(list, piece.from)];
        piece.to = numbers[common_of(list, piece.to)];
        result.pieces.push_back(piece);
        if (may_be_unlit)
            result.unlit.push_back(list.unlit_beside(i));
    });
    result.penetrating = std::move(found.penetrating);
    return result;
}

} // namespace vera
