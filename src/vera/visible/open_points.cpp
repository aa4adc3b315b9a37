// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/open_points.h"

#include "vera/base/disjoint_sets.h"
#include "vera/base/random.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace vera {

namespace {

struct OpenPoint {
    double x = 0;
    double y = 0;
    std::uint64_t sum = 0; ///< of the sources round which a way begins, without those of ends
    std::size_t number = 0;
};

std::vector<OpenPoint> all_open_points(const ScreenScene& scene, const VisiblePieces& pieces) {
    // Scrambled, so that sums of a few are the same only where the sources are.
    const auto number = [&](std::uint32_t triangle) {
        return scrambled_bits(
            triangle == no_triangle ? no_source : scene.triangles[triangle].source);
    };
    std::vector<std::uint64_t> sums(pieces.points.size());
    for (const VisiblePiece& piece : pieces.pieces) {
        const std::uint64_t difference = number(piece.left) - number(piece.right);
        sums[piece.from] += difference;
        sums[piece.to] -= difference;
    }
    std::vector<OpenPoint> open;
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i] != 0)
            open.push_back({pieces.points[i].x(), pieces.points[i].y(), sums[i], i});
    return open;
}

} // namespace

std::vector<PackedPoint>
open_points(const ScreenScene& scene, const VisiblePieces& pieces, double reach) {
    std::vector<OpenPoint> open = all_open_points(scene, pieces);
    std::sort(open.begin(), open.end(), [](const OpenPoint& a, const OpenPoint& b) {
        return a.x != b.x ? a.x < b.x : a.number < b.number;
    });
    DisjointSets groups(open.size());
    for (std::size_t i = 0; i < open.size(); ++i)
        for (std::size_t j = i + 1; j < open.size() && open[j].x - open[i].x <= reach; ++j)
            if (std::abs(open[j].y - open[i].y) <= reach)
                groups.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
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
