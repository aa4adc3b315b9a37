// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/penetrations.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/exact/front_order.h"
#include "vera/visible/cell_raster_stages.h"
#include "vera/visible/edges.h"
#include "vera/visible/open_points.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/point_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace vera {

namespace {

constexpr std::uint32_t no_vertex = ~std::uint32_t{0};

/// The new corners on the sides of a triangle, or no_vertex.
using SideCuts = std::array<std::uint32_t, 3>;

ScreenVertex between(const ScreenVertex& a, const ScreenVertex& b, double part) {
    const auto mixed = [&](auto from, auto to) {
        const auto begin = static_cast<double>(from);
        return std::floor(begin + part * (static_cast<double>(to) - begin) + 0.5);
    };
    return {
        {static_cast<std::int32_t>(mixed(a.point.x, b.point.x)),
         static_cast<std::int32_t>(mixed(a.point.y, b.point.y))},
        static_cast<std::int64_t>(mixed(a.nearness, b.nearness))};
}

/// Cuts edges, each once at most.
class EdgeCuts {
public:
    EdgeCuts(ScreenScene& scene, const ScreenEdges& edges)
        : scene_(scene)
        , edges_(edges)
        , cuts_(edges.edges.size(), no_vertex) {}

    /// Cuts the triangle's sides where the other's plane passes them. Nothing where one of them was
    /// cut already.
    void cut(std::uint32_t triangle, const NearnessSlope& own, const NearnessSlope& other) {
        const std::array<ScreenVertex, 3> corners = corners_of(scene_, scene_.triangles[triangle]);
        const std::array<std::uint32_t, 3>& sides = edges_.of_triangle[triangle];
        std::array<double, 3> ahead;
        for (std::size_t i = 0; i < 3; ++i) {
            const ScreenPoint point = corners[i].point;
            const NearnessPlace place = {
                static_cast<double>(point.x), static_cast<double>(point.y)};
            ahead[i] = own.at(place) - other.at(place);
        }
        std::array<std::optional<ScreenVertex>, 3> found;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t next = (i + 1) % 3;
            if (ahead[i] * ahead[next] >= 0)
                continue;
            if (cuts_[sides[i]] != no_vertex)
                return;
            const ScreenVertex at =
                between(corners[i], corners[next], ahead[i] / (ahead[i] - ahead[next]));
            // At a corner the side is passed already.
            if (at.point != corners[i].point && at.point != corners[next].point)
                found[i] = at;
        }
        for (std::size_t i = 0; i < 3; ++i)
            if (found[i]) {
                cuts_[sides[i]] = static_cast<std::uint32_t>(scene_.vertices.size());
                scene_.vertices.push_back(*found[i]);
            }
    }

    SideCuts of_triangle(std::uint32_t triangle) const {
        const std::array<std::uint32_t, 3>& sides = edges_.of_triangle[triangle];
        return {cuts_[sides[0]], cuts_[sides[1]], cuts_[sides[2]]};
    }

private:
    ScreenScene& scene_;
    const ScreenEdges& edges_;
    std::vector<std::uint32_t> cuts_; ///< the vertex on each edge
};

/// Puts the parts of the triangle whose sides have these new corners in its place, and those for
/// which there is none at the end.
void replace_by_parts(
    ScreenScene& scene, std::uint32_t number, const SideCuts& cuts, SceneChange& change) {
    const ScreenTriangle triangle = scene.triangles[number];
    const std::size_t before = scene.triangles.size();
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        add_part(scene, {a, b, c}, triangle, triangle.light);
    };
    const auto& corners = triangle.vertices;
    std::size_t count = 0;
    std::size_t first = 0; // the side with which the cut sides begin
    for (std::size_t i = 0; i < 3; ++i) {
        count += cuts[i] != no_vertex ? 1 : 0;
        if (cuts[i] != no_vertex && cuts[(i + 2) % 3] == no_vertex)
            first = i;
    }
    const std::uint32_t a = corners[first];
    const std::uint32_t b = corners[(first + 1) % 3];
    const std::uint32_t c = corners[(first + 2) % 3];
    const std::uint32_t ab = cuts[first];
    const std::uint32_t bc = cuts[(first + 1) % 3];
    const std::uint32_t ca = cuts[(first + 2) % 3];
    switch (count) {
    case 0:
        return;
    case 1:
        add(a, ab, c);
        add(ab, b, c);
        break;
    case 2:
        add(ab, b, bc);
        add(a, ab, bc);
        add(a, bc, c);
        break;
    default:
        add(a, ab, ca);
        add(ab, b, bc);
        add(bc, c, ca);
        add(ab, bc, ca);
    }
    if (scene.triangles.size() == before) {
        // Of one that is hardly as wide as a step, no part has an area. It is left whole, in the
        // plane that the grid gives it.
        scene.triangles[number].plane = triangle.vertices;
        change.triangles.push_back(number);
        return;
    }
    change.places.push_back(corners_of(scene, triangle));
    scene.triangles[number] = scene.triangles.back();
    scene.triangles.pop_back();
    change.triangles.push_back(number);
    for (std::size_t i = before; i < scene.triangles.size(); ++i)
        change.triangles.push_back(static_cast<std::uint32_t>(i));
}

/// Room for what replace_by_parts() adds of all triangles: of each one more than cuts.
void reserve_parts(ScreenScene& scene, const EdgeCuts& cuts, SceneChange& change) {
    std::size_t parts = 0;
    std::size_t triangles = 0;
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const SideCuts of_triangle = cuts.of_triangle(i);
        const auto uncut = std::count(of_triangle.begin(), of_triangle.end(), no_vertex);
        parts += of_triangle.size() - static_cast<std::size_t>(uncut);
        triangles += static_cast<std::size_t>(uncut) < of_triangle.size() ? 1 : 0;
    }
    scene.triangles.reserve(scene.triangles.size() + parts);
    change.triangles.reserve(triangles + parts);
    change.places.reserve(triangles);
}

/// Closes ways round what is seen, until none is open or nothing new is, or for a number of rounds;
/// nothing is where that shows triangles that pass through each other. Where the order of three
/// goes round, within what the grid did to them, the front is a matter of which of them are surely
/// hidden along a part of an edge, and another edge of the same area may tell another one. Near
/// such places all is asked again among all that is there, which is the same for all edges of an
/// area. `open` are the points that were open in rounds before, near which that was done, and takes
/// those that are now.
void close_ways(
    const ScreenScene& scene,
    VisiblePieces& pieces,
    std::vector<PackedPoint>& open,
    const CancelFlag* cancel) {
    constexpr int most_rounds = 24;
    for (int round = 0; round < most_rounds && pieces.penetrating.empty(); ++round) {
        const std::vector<PackedPoint> here = open_points(scene, pieces);
        const std::size_t before = open.size();
        PointNumbers numbers(open, before + here.size());
        for (const PackedPoint& point : here)
            numbers.number(point);
        if (open.size() == before)
            return;
        SceneChange change;
        change.asked.assign(open.begin() + static_cast<std::ptrdiff_t>(before), open.end());
        pieces = cell_raster_after(change, open, std::move(pieces), scene, {}, cancel);
    }
}

} // namespace

SceneChange cut_penetrations(
    ScreenScene& scene,
    std::span<const std::pair<std::uint32_t, std::uint32_t>> penetrating,
    const CancelFlag* cancel) {
    const ScreenEdges edges = screen_edges(scene);
    EdgeCuts cuts(scene, edges);
    const auto slope_of = [&](std::uint32_t triangle) {
        return nearness_slope(plane_of(scene, scene.triangles[triangle]));
    };
    const LongLoop pairs(penetrating.size(), {}, cancel);
    for (std::size_t i = 0; i < penetrating.size(); ++i) {
        pairs.turn(i);
        const auto [a, b] = penetrating[i];
        cuts.cut(a, slope_of(a), slope_of(b));
        cuts.cut(b, slope_of(b), slope_of(a));
    }
    SceneChange change;
    const std::size_t count = scene.triangles.size();
    reserve_parts(scene, cuts, change);
    const LongLoop loop(count, {}, cancel);
    for (std::uint32_t i = 0; i < count; ++i) {
        loop.turn(i);
        replace_by_parts(scene, i, cuts.of_triangle(i), change);
    }
    return change;
}

WholePieces whole_pieces(
    ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    VisibilityEngine engine,
    const ExpectPieces& expect) {
    constexpr std::size_t many = std::size_t{1} << 15U;
    if (scene.triangles.size() >= many) // of fewer, all there is takes little memory
        spare_memory();
    constexpr int most_rounds = 24;
    // Where each passes through each, cutting all would take the square of their number.
    const std::size_t most_triangles = 16 * scene.triangles.size() + 100'000;
    // Nobody knows how many rounds there will be: each takes a part of what is left of the
    // progress.
    double done = 0.75;
    const auto next_round = [&] {
        constexpr double part = 0.25;
        const double begin = done;
        done += part * (1 - done);
        return progress_between(progress, begin, done);
    };
    std::vector<PackedPoint> open; // there was a way
    const auto swept = [&](const Progress& round) {
        VisiblePieces pieces = plane_sweep(scene, {}, round, cancel);
        if (!open.empty())
            pieces = cell_raster_after({{}, {}, open}, open, std::move(pieces), scene, {}, cancel);
        return parted(std::move(pieces));
    };
    WholePieces result;
    const Progress first_round = progress_between(progress, 0, done);
    SeenPieces seen = engine == VisibilityEngine::sweep
        ? swept(first_round)
        : cell_raster_parts(scene, first_round, cancel, expect);
    while (true) {
        give_back_freed_memory(); // of what edges were compared with, and of parts
        const bool may_be_last =
            result.rounds == most_rounds || scene.triangles.size() > most_triangles;
        if (seen.penetrating.empty() || may_be_last) {
            result.pieces = joined(std::move(seen));
            give_back_freed_memory();
            close_ways(scene, result.pieces, open, cancel);
            result.opened = open.size();
            result.left = result.pieces.penetrating.size();
            if (result.left == 0 || may_be_last)
                return result;
            seen = parted(std::exchange(result.pieces, {}));
        }
        const SceneChange change = cut_penetrations(scene, seen.penetrating, cancel);
        seen = engine == VisibilityEngine::sweep
            ? swept(next_round())
            : cell_raster_parts_after(
                change, open, std::move(seen), scene, next_round(), cancel, expect);
        ++result.rounds;
    }
}

} // namespace vera
