// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/open_points.h"

#include "vera/base/disjoint_sets.h"
#include "vera/base/random.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>

namespace vera {

namespace {

struct OpenPoint {
    std::int64_t strip = 0; ///< of the picture, from the left
    double x = 0;
    double y = 0;
    std::uint64_t sum = 0; ///< of the sources round which a way begins, without those of ends
    std::size_t number = 0;
};

std::vector<OpenPoint>
all_open_points(const ScreenScene& scene, const VisiblePieces& pieces, double width_of_strips) {
    // Scrambled, so that sums of a few are the same only where the sources are.
    const auto number = [&](std::uint32_t triangle) {
        return scrambled_bits(
            triangle == no_triangle ? no_source : scene.triangles[triangle].source);
    };
    std::vector<OpenPoint> open;
    // Half of the points at a time, as all pieces are there.
    const std::size_t count = pieces.points.size();
    for (const bool is_later_half : {false, true}) {
        const std::size_t first = is_later_half ? count / 2 : 0;
        const std::size_t last = is_later_half ? count : count / 2;
        std::vector<std::uint64_t> sums(last - first);
        const auto add = [&](std::size_t point, std::uint64_t difference) {
            if (point >= first && point < last)
                sums[point - first] += difference;
        };
        for (const VisiblePiece& piece : pieces.pieces) {
            const std::uint64_t difference = number(piece.left) - number(piece.right);
            add(piece.from, difference);
            add(piece.to, 0 - difference);
        }
        for (std::size_t i = first; i < last; ++i)
            if (const std::uint64_t sum = sums[i - first]; sum != 0) {
                const double x = pieces.points[i].x();
                const auto strip = static_cast<std::int64_t>(std::floor(x / width_of_strips));
                open.push_back({strip, x, pieces.points[i].y(), sum, i});
            }
    }
    std::sort(open.begin(), open.end(), [](const OpenPoint& a, const OpenPoint& b) {
        return std::tuple(a.strip, a.y, a.number) < std::tuple(b.strip, b.y, b.number);
    });
    return open;
}

/// Calls visit(i, j) for two of the points, in their order, that are within reach, which is not
/// wider than the strips.
template <typename Visit>
void for_each_near(std::span<const OpenPoint> open, double reach, const Visit& visit) {
    std::size_t beside = 0; // the first in the next strip that is not too low
    for (std::size_t i = 0; i < open.size(); ++i) {
        const auto visit_from = [&](std::size_t j, std::int64_t strip) {
            for (; j < open.size() && open[j].strip == strip && open[j].y - open[i].y <= reach; ++j)
                if (std::abs(open[j].x - open[i].x) <= reach)
                    visit(i, j);
        };
        const std::int64_t next = open[i].strip + 1;
        visit_from(i + 1, open[i].strip);
        while (beside < open.size()
               && (open[beside].strip < next
                   || (open[beside].strip == next && open[i].y - open[beside].y > reach)))
            ++beside;
        visit_from(beside, next);
    }
}

} // namespace

std::vector<PackedPoint>
open_points(const ScreenScene& scene, const VisiblePieces& pieces, double reach) {
    const std::vector<OpenPoint> open = all_open_points(scene, pieces, std::max(reach, 1.0));
    DisjointSets groups(open.size());
    for_each_near(open, reach, [&](std::size_t i, std::size_t j) {
        groups.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    });
    const auto group = [&](std::size_t i) {
        return groups.first_of(static_cast<std::uint32_t>(i));
    };
    std::vector<std::uint64_t> sums(open.size());
    for (std::size_t i = 0; i < open.size(); ++i)
        sums[group(i)] += open[i].sum;
    std::vector<PackedPoint> left;
    for (std::size_t i = 0; i < open.size(); ++i)
        if (sums[group(i)] != 0)
            left.push_back(pieces.points[open[i].number]);
    return left;
}

} // namespace vera
