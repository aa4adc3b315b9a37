// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/box_tree_cuts.h"

#include "vera/base/check.h"
#include "vera/base/parallel.h"

#include <algorithm>
#include <vector>

namespace vera::detail {

namespace {

/// What a thread takes of the references. The parts do not depend on how many threads there are.
constexpr std::size_t part_size = std::size_t{1} << 16U;

std::size_t part_count(std::size_t size) {
    return (size + part_size - 1) / part_size;
}

/// Calls turn(i, first, last) for the parts [first, last) of a range.
template <typename Turn>
void for_parts(std::size_t first, std::size_t last, const Turn& turn) {
    parallel_ranges(part_count(last - first), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            turn(i, first + i * part_size, std::min(first + (i + 1) * part_size, last));
    });
}

void add(Bins& bins, const Bins& more, std::size_t count) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < count; ++i) {
            include(bins.boxes[i][axis], more.boxes[i][axis]);
            bins.counts[i][axis] += more.counts[i][axis];
        }
}

Bins bins_of(std::span<const BoxReference> references, const Binning& binning) {
    Bins bins;
    if (references.size() <= part_size) {
        fill_bins(references, binning, bins);
        return bins;
    }
    std::vector<Bins> parts(part_count(references.size()));
    for_parts(0, references.size(), [&](std::size_t i, std::size_t first, std::size_t last) {
        fill_bins(references.subspan(first, last - first), binning, parts[i]);
    });
    for (std::size_t i = 1; i < parts.size(); ++i)
        add(parts[0], parts[i], binning.count);
    return parts[0];
}

/// References [first, last).
struct Piece {
    std::size_t first = 0;
    std::size_t last = 0;
};

/// Swaps the references of pieces with those of others, which together are as many.
void swap_pieces(
    std::span<BoxReference> references, std::vector<Piece> some, std::vector<Piece> others) {
    struct Swap {
        std::size_t from = 0;
        std::size_t to = 0;
        std::size_t count = 0;
    };

    std::vector<Swap> swaps;
    for (std::size_t i = 0, j = 0; i < some.size();) {
        Piece& a = some[i];
        Piece& b = others[j];
        const std::size_t count = std::min(a.last - a.first, b.last - b.first);
        swaps.push_back({a.first, b.first, count});
        a.first += count;
        b.first += count;
        i += a.first == a.last ? 1 : 0;
        j += b.first == b.last ? 1 : 0;
    }
    parallel_ranges(swaps.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto from = references.subspan(swaps[i].from, swaps[i].count);
            const auto to = references.subspan(swaps[i].to, swaps[i].count);
            std::swap_ranges(from.begin(), from.end(), to.begin());
        }
    });
}

/// The same as take_sides, first within each part.
Sides sides_of(std::span<BoxReference> references, const Binning& binning, const Cut& cut) {
    if (references.size() <= part_size)
        return take_sides(references, binning, cut);
    std::vector<Sides> parts(part_count(references.size()));
    for_parts(0, references.size(), [&](std::size_t i, std::size_t first, std::size_t last) {
        parts[i] = take_sides(references.subspan(first, last - first), binning, cut);
    });
    Sides sides;
    for (const Sides& part : parts) {
        include(sides.left, part.left);
        include(sides.right, part.right);
        sides.left_count += part.left_count;
    }
    std::vector<Piece> too_early;
    std::vector<Piece> too_late;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::size_t first = i * part_size;
        const std::size_t last = std::min(first + part_size, references.size());
        const std::size_t first_right = first + parts[i].left_count;
        const Piece early = {first_right, std::min(last, sides.left_count)};
        const Piece late = {std::max(first, sides.left_count), first_right};
        if (early.first < early.last)
            too_early.push_back(early);
        if (late.first < late.last)
            too_late.push_back(late);
    }
    swap_pieces(references, too_early, too_late);
    return sides;
}

} // namespace

ReferenceRange
range_of(std::span<const BoxReference> references, std::size_t first, std::size_t last) {
    ReferenceRange range = {first, last, empty_box, empty_box};
    if (range.size() <= part_size) {
        include(references.subspan(first, range.size()), range.box, range.middles);
        return range;
    }
    std::vector<ReferenceRange> parts(part_count(range.size()));
    for_parts(first, last, [&](std::size_t i, std::size_t begin, std::size_t end) {
        include(references.subspan(begin, end - begin), parts[i].box, parts[i].middles);
    });
    for (const ReferenceRange& part : parts) {
        include(range.box, part.box);
        include(range.middles, part.middles);
    }
    return range;
}

std::optional<Halves>
halves_by_surface(std::span<BoxReference> references, const ReferenceRange& range) {
    const std::span<BoxReference> own = references.subspan(range.first, range.size());
    const Binning binning(range.size(), range.middles);
    const Cut cut = best_cut(bins_of(own, binning), binning);
    if (cut.axis == 3)
        return std::nullopt;
    const Sides sides = sides_of(own, binning, cut);
    VERA_CHECK(sides.left_count > 0 && sides.left_count < own.size());
    const std::size_t middle = range.first + sides.left_count;
    return Halves(
        {range.first, middle, cut.left, sides.left}, {middle, range.last, cut.right, sides.right});
}

} // namespace vera::detail
