// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/piece_lists.h"

#include "vera/base/free_room.h"
#include "vera/base/parallel.h"
#include "vera/base/spent_pages.h"
#include "vera/visible/first_equal.h"
#include "vera/visible/point_numbers.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace vera {

namespace {

/// The points of the parts by one number, as if they stood one part's behind the other's.
class PartedPoints {
public:
    explicit PartedPoints(const std::vector<SeenPart>& parts)
        : parts_(parts) {
        for (const SeenPart& part : parts)
            starts_.push_back(starts_.back() + part.points());
        for (std::size_t part = 0, i = 0; i < count(); i += block) {
            while (starts_[part + 1] <= i)
                ++part;
            part_of_block_.push_back(part);
        }
    }

    std::size_t count() const { return starts_.back(); }

    /// With which number the part begins.
    std::size_t start(std::size_t part) const { return starts_[part]; }

    PackedPoint operator[](std::size_t i) const {
        std::size_t part = part_of_block_[i / block];
        while (starts_[part + 1] <= i)
            ++part;
        return parts_[part].point(i - starts_[part]);
    }

private:
    static constexpr std::size_t block = 1024; ///< points: hardly as many as a part has

    const std::vector<SeenPart>& parts_;
    std::vector<std::size_t> starts_ = {0};
    std::vector<std::size_t> part_of_block_; ///< in which each block's first point is
};

/// The points of the parts, each once, in the order in which they come; numbers tells which of them
/// each is. Takes them out of the parts. room_beside(count) is that for others behind them.
template <typename RoomBeside>
std::vector<PackedPoint> joined_points(
    const PartedPoints& parted,
    std::vector<SeenPart>& parts,
    UnfilledVector<std::uint32_t>& numbers,
    FreedBlocks& freed,
    const RoomBeside& room_beside) {
    numbers = first_equal(
        parted.count(),
        [&](std::size_t i) { return hash_of(parted[i]); },
        [&](std::size_t i, std::size_t j) { return parted[i] == parted[j]; });
    const std::vector<std::uint32_t> firsts = number_consecutively(numbers);
    std::vector<PackedPoint> points;
    points.reserve(firsts.size() + room_beside(firsts.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::size_t start = parted.start(i);
        for (const std::size_t end = parted.start(i + 1);
             points.size() < firsts.size() && firsts[points.size()] < end;)
            points.push_back(parts[i].point(firsts[points.size()] - start));
        const std::size_t before = parts[i].room();
        parts[i].forget_points();
        freed.count(before - parts[i].room());
    }
    return points;
}

/// Lets the vector grow to that size, where it has no room for it in a room of that size alone.
template <typename T>
void grow_to(std::size_t size, std::vector<T>& vector) {
    vector.reserve(size);
    vector.resize(size);
}

/// Forgets those of the host's points that no piece has or that the guest has as well, and puts the
/// guest's behind the others. Returns of each point that the host had the place that it has now,
/// which means nothing where it is forgotten and no piece has it.
std::vector<std::uint32_t> take_points_in(
    std::vector<PackedPoint>& points,
    const std::vector<VisiblePiece>& pieces,
    std::vector<PackedPoint>& guests) {
    constexpr std::uint32_t none = PointNumbers::none;
    std::vector<std::uint32_t> places(points.size(), none);
    for (const VisiblePiece& piece : pieces)
        places[piece.from] = places[piece.to] = 0;
    {
        const PointNumbers numbers(guests, guests.size());
        constexpr std::uint32_t unused = none - 1;
        parallel_ranges(points.size(), 4096, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                places[i] = places[i] == none ? unused : numbers.find(points[i]);
        });
        std::uint32_t own = 0;
        for (std::size_t i = 0; i < places.size(); ++i)
            if (places[i] == none)
                points[own++] = points[i];
        std::uint32_t place = 0;
        for (std::uint32_t& at : places)
            at = at == none ? place++ : own + at; // of those that are forgotten it means nothing
        points.resize(own);
    }
    points.reserve(points.size() + guests.size());
    points.insert(points.end(), guests.begin(), guests.end());
    free_room(guests);
    return places;
}

/// Puts the point in place i in place numbers[i]; leaves out those that have none.
void put_in_order(
    const std::vector<std::uint32_t>& numbers,
    std::uint32_t count,
    std::vector<PackedPoint>& points) {
    constexpr std::uint32_t none = PointNumbers::none;
    std::vector<bool> is_moved(points.size());
    for (std::uint32_t start = 0; start < points.size(); ++start) {
        if (is_moved[start] || numbers[start] == none)
            continue;
        // What stands where a point belongs is taken along, and put where it belongs itself.
        PackedPoint point = points[start];
        std::uint32_t from = start;
        while (true) {
            is_moved[from] = true;
            const std::uint32_t to = numbers[from];
            std::swap(point, points[to]);
            if (is_moved[to] || numbers[to] == none)
                break;
            from = to;
        }
    }
    points.resize(count);
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

VisiblePieces joined(std::vector<SeenPart> parts, std::size_t others) {
    const PartedPoints parted(parts);
    std::size_t pieces = 0;
    std::size_t unlit = 0;
    for (const SeenPart& part : parts) {
        pieces += part.size();
        unlit += part.unlit();
    }
    FreedBlocks freed;
    VisiblePieces result;
    UnfilledVector<std::uint32_t> numbers;
    result.points = joined_points(parted, parts, numbers, freed, [&](std::size_t points) {
        return pieces == 0 ? 0 : points * others / pieces; // as many of a piece as here
    });
    result.pieces.reserve(pieces + others);
    result.unlit.reserve(unlit == 0 ? 0 : unlit + others);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        freed.count(parts[i].room());
        const VisiblePieces list = parts[i].take();
        for (VisiblePiece piece : list.pieces) {
            piece.from = numbers[parted.start(i) + piece.from];
            piece.to = numbers[parted.start(i) + piece.to];
            result.pieces.push_back(piece);
        }
        result.unlit.insert(result.unlit.end(), list.unlit.begin(), list.unlit.end());
        result.penetrating.insert(
            result.penetrating.end(), parts[i].penetrating.begin(), parts[i].penetrating.end());
        free_room(parts[i].penetrating);
    }
    return result;
}

namespace {

/// Leaves out the other pieces and the points that only they have. The list keeps its room, but not
/// the memory of what is not used.
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
    give_back_unused(list.pieces);
    list.unlit.resize(list.unlit.empty() ? 0 : kept);
    give_back_unused(list.unlit);
    forget_unused_points(list);
}

} // namespace

void forget_unused_points(VisiblePieces& list) {
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
    give_back_unused(list.points);
    for (VisiblePiece& piece : list.pieces) {
        piece.from = numbers[piece.from];
        piece.to = numbers[piece.to];
    }
}

void join_along_edges(VisiblePieces& list) {
    std::vector<std::uint8_t> ends(list.points.size()); // at each point, or 3 of more
    for (const VisiblePiece& piece : list.pieces)
        for (const std::uint32_t point : {piece.from, piece.to})
            ends[point] = static_cast<std::uint8_t>(std::min(ends[point] + 1, 3));
    const auto goes_on = [&](std::size_t before, std::size_t after) {
        const VisiblePiece& a = list.pieces[before];
        const VisiblePiece& b = list.pieces[after];
        const UnlitBeside unlit_a = list.unlit_beside(before);
        const UnlitBeside unlit_b = list.unlit_beside(after);
        return a.to == b.from && ends[b.from] == 2 && a.edge == b.edge && a.left == b.left
            && a.right == b.right && unlit_a.left == unlit_b.left && unlit_a.right == unlit_b.right;
    };
    std::vector<std::uint8_t> is_kept(list.pieces.size(), 1);
    for (std::size_t first = 0, i = 1; i < list.pieces.size(); ++i)
        if (goes_on(first, i)) {
            list.pieces[first].to = list.pieces[i].to;
            is_kept[i] = 0;
        } else {
            first = i;
        }
    keep_pieces(is_kept, list);
}

VisiblePieces merged(VisiblePieces before, VisiblePieces found) {
    constexpr std::uint32_t none = PointNumbers::none;
    if (before.pieces.empty())
        return found;
    // All in the room of one of the lists: the guest's points go behind the host's.
    VisiblePieces& host = before.pieces.size() < found.pieces.size() ? found : before;
    VisiblePieces& guest = &host == &before ? found : before;
    const std::size_t guests = guest.points.size();
    const std::vector<std::uint32_t> places =
        take_points_in(host.points, host.pieces, guest.points);
    const std::size_t own = host.points.size() - guests;
    const auto place_of = [&](const VisiblePieces& list, std::uint32_t point) {
        return &list == &host ? places[point] : own + point;
    };
    // The numbers in which the pieces have them, as if all had been followed.
    std::vector<std::uint32_t> numbers(host.points.size(), none);
    std::uint32_t points = 0;
    for_each_merged(before, found, [&](const VisiblePieces& list, std::size_t i) {
        for (const std::uint32_t point : {list.pieces[i].from, list.pieces[i].to})
            if (std::uint32_t& number = numbers[place_of(list, point)]; number == none)
                number = points++;
    });
    put_in_order(numbers, points, host.points);
    // From behind, so that no piece of the host is written over before it is read.
    std::size_t of_host = host.pieces.size();
    std::size_t of_guest = guest.pieces.size();
    const bool may_be_unlit = !host.unlit.empty() || !guest.unlit.empty();
    grow_to(of_host + of_guest, host.pieces);
    if (may_be_unlit)
        grow_to(of_host + of_guest, host.unlit);
    for (std::size_t at = host.pieces.size(); at-- > 0;) {
        const bool is_of_guest = of_guest > 0
            && (of_host == 0
                || (&guest == &found
                        ? !(guest.pieces[of_guest - 1].edge < host.pieces[of_host - 1].edge)
                        : host.pieces[of_host - 1].edge < guest.pieces[of_guest - 1].edge));
        const VisiblePieces& list = is_of_guest ? guest : host;
        const std::size_t i = is_of_guest ? --of_guest : --of_host;
        VisiblePiece piece = list.pieces[i];
        piece.from = numbers[place_of(list, piece.from)];
        piece.to = numbers[place_of(list, piece.to)];
        host.pieces[at] = piece;
        if (may_be_unlit)
            host.unlit[at] = list.unlit_beside(i);
    }
    if (&host != &found)
        host.penetrating = std::move(found.penetrating);
    return std::move(host);
}

} // namespace vera
