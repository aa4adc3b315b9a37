// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/surface_mesh.h"

#include "vera/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

namespace vera::detail {

std::pair<ParameterCell, ParameterCell> halves(const ParameterCell& cell, bool across_u) {
    ParameterCell first = cell;
    ParameterCell second = cell;
    if (across_u)
        first.u_end = second.u_begin = cell.u_begin + (cell.u_end - cell.u_begin) / 2;
    else
        first.v_end = second.v_begin = cell.v_begin + (cell.v_end - cell.v_begin) / 2;
    return {first, second};
}

std::vector<ParameterCell> ParameterGrid::first_cells() const {
    constexpr std::uint32_t each_way = 4;
    constexpr std::uint32_t side = steps / each_way;
    std::vector<ParameterCell> cells;
    for (std::uint32_t v = 0; v < each_way; ++v)
        for (std::uint32_t u = 0; u < each_way; ++u)
            cells.push_back({u * side, (u + 1) * side, v * side, (v + 1) * side});
    return cells;
}

namespace {

/// The part of what is allowed that corners may be moved by: by rounding, and where sides are
/// joined.
constexpr double corner_part = 2e-7;

struct GridPoint {
    std::uint32_t u = 0;
    std::uint32_t v = 0;
};

std::uint64_t key(GridPoint point) {
    return (std::uint64_t{point.u} << 32U) | point.v;
}

/// Makes the mesh: first it is known which points there are on each line of the grid, then each
/// cell becomes triangles.
class CellMesher {
public:
    CellMesher(const ParameterGrid& grid, const AllowedDeviation& allowed)
        : grid_(grid)
        , allowed_(allowed) {}

    Mesh mesh(const std::vector<ParameterCell>& cells) {
        for (const ParameterCell& cell : cells)
            for (const GridPoint point : corners(cell)) {
                on_u_[point.u].push_back(point.v);
                on_v_[point.v].push_back(point.u);
            }
        for (auto* lines : {&on_u_, &on_v_})
            for (auto& [line, points] : *lines)
                make_unique(points);
        join_sides();
        for (const ParameterCell& cell : cells)
            add_cell(cell);
        return std::move(mesh_);
    }

private:
    using Points = std::vector<std::uint32_t>;
    using Lines = std::unordered_map<std::uint32_t, Points>;

    struct Place {
        Vec3 position;
        std::optional<Vec3> normal; ///< unit
    };

    static std::array<GridPoint, 4> corners(const ParameterCell& cell) {
        return {{
            {cell.u_begin, cell.v_begin},
            {cell.u_end, cell.v_begin},
            {cell.u_end, cell.v_end},
            {cell.u_begin, cell.v_end},
        }};
    }

    static void make_unique(Points& points) {
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
    }

    Place place_at(double u, double v) const {
        const auto jets = grid_.jets(u, v);
        const Vec3 along_u = {jets[0].u, jets[1].u, jets[2].u};
        const Vec3 along_v = {jets[0].v, jets[1].v, jets[2].v};
        Place place;
        place.position = {jets[0].value, jets[1].value, jets[2].value};
        // Compared as lengths of the whole ranges: what is left of 0 by rounding is far below.
        const double u_length = length(along_u) * grid_.u_range();
        const double v_length = length(along_v) * grid_.v_range();
        const Vec3 normal = cross(along_u, along_v);
        constexpr double least = 1e-9;
        if (is_finite(normal) && u_length > least * v_length && v_length > least * u_length
            && length(normal) > least * length(along_u) * length(along_v))
            place.normal = normalized(normal);
        return place;
    }

    Place place_of(GridPoint point) const { return place_at(grid_.u(point.u), grid_.v(point.v)); }

    double allowed_at(Vec3 position) const { return corner_part * allowed_({position, position}); }

    bool are_joined(GridPoint a, GridPoint b) const {
        const Vec3 first = place_of(a).position;
        return length(first - place_of(b).position) <= allowed_at(first);
    }

    /// Where the two ends of a range are the same curve, each side gets the other's points.
    void join_sides() {
        constexpr std::uint32_t last = ParameterGrid::steps;
        const auto joined = [&](Lines& lines, const auto& point) {
            Points both = lines[0];
            both.insert(both.end(), lines[last].begin(), lines[last].end());
            make_unique(both);
            const bool meet = std::all_of(both.begin(), both.end(), [&](std::uint32_t i) {
                return are_joined(point(0, i), point(last, i));
            });
            if (meet)
                lines[0] = lines[last] = both;
            return meet;
        };
        joined_u_ = joined(on_u_, [](std::uint32_t u, std::uint32_t v) { return GridPoint{u, v}; });
        joined_v_ = joined(on_v_, [](std::uint32_t v, std::uint32_t u) { return GridPoint{u, v}; });
        // A side that is one point, as at a pole.
        const auto shrunk = [&](Lines& lines, std::uint32_t line, const auto& point) {
            const Points& points = lines[line];
            return std::all_of(points.begin(), points.end(), [&](std::uint32_t i) {
                return are_joined(point(line, points.front()), point(line, i));
            });
        };
        for (std::size_t end = 0; end < 2; ++end) {
            const std::uint32_t line = end == 0 ? 0 : last;
            shrunk_u_[end] = shrunk(on_u_, line, [](std::uint32_t u, std::uint32_t v) {
                return GridPoint{u, v};
            });
            shrunk_v_[end] = shrunk(on_v_, line, [](std::uint32_t v, std::uint32_t u) {
                return GridPoint{u, v};
            });
        }
    }

    /// The point that stands for it where sides are joined or shrunk to a point.
    GridPoint representative(GridPoint point) const {
        constexpr std::uint32_t last = ParameterGrid::steps;
        if (joined_u_ && point.u == last)
            point.u = 0;
        if (joined_v_ && point.v == last)
            point.v = 0;
        for (std::size_t end = 0; end < 2; ++end) {
            const std::uint32_t line = end == 0 ? 0 : last;
            if (shrunk_u_[end] && point.u == line)
                point.v = 0;
            if (shrunk_v_[end] && point.v == line)
                point.u = 0;
        }
        return point;
    }

    std::uint32_t position_of(GridPoint point) {
        const GridPoint stand_in = representative(point);
        const auto [entry, added] = positions_.try_emplace(
            key(stand_in), static_cast<std::uint32_t>(mesh_.positions.size()));
        if (added) {
            const Vec3 position = place_of(stand_in).position;
            check_reach(position);
            check_rounding(stand_in, position);
            mesh_.positions.push_back(position);
        }
        return entry->second;
    }

    static void check_reach(Vec3 position) {
        constexpr double most = largest_reach / 1000; // the rest is for what stands round it
        if (!(max_component(abs(position)) <= most))
            throw SurfaceError(
                fmt::format(
                    "the surface goes farther than {:.0e} from the origin, too far for a scene",
                    most),
                "make x, y and z smaller, or leave out the parts of u and v where they grow so");
    }

    void check_rounding(GridPoint point, Vec3 position) const {
        const auto jets = grid_.jets(Interval(grid_.u(point.u)), Interval(grid_.v(point.v)));
        Vec3 off;
        for (std::size_t axis = 0; axis < 3; ++axis)
            off[axis] = std::max(
                position[axis] - jets[axis].value.lower, jets[axis].value.upper - position[axis]);
        if (!(length(off) <= allowed_at(position)))
            throw SurfaceError(
                fmt::format(
                    "numbers near {:.2g} are rounded too coarsely for a deviation of {:.2g}",
                    max_component(abs(position)),
                    allowed_({position, position})),
                fmt::format(
                    "leave out what only moves the surface (TR in a scene moves it), or allow a "
                    "deviation of about {:.1g}",
                    2 * length(off) / corner_part));
    }

    /// The corners of the triangles of the cell, counterclockwise from the first corner.
    std::vector<GridPoint> outline(const ParameterCell& cell) const {
        std::vector<GridPoint> points;
        const auto between = [](const Points& all, std::uint32_t begin, std::uint32_t end) {
            return std::pair(
                std::lower_bound(all.begin(), all.end(), begin),
                std::upper_bound(all.begin(), all.end(), end));
        };
        const auto along = [&](const Points& all,
                               std::uint32_t begin,
                               std::uint32_t end,
                               bool forwards,
                               const auto& point) {
            const auto [first, last] = between(all, begin, end);
            Points side(first, last);
            if (!forwards)
                std::reverse(side.begin(), side.end());
            // The last one is the first of the next side.
            for (std::size_t i = 0; i + 1 < side.size(); ++i)
                points.push_back(point(side[i]));
        };
        along(on_v_.at(cell.v_begin), cell.u_begin, cell.u_end, true, [&](std::uint32_t u) {
            return GridPoint{u, cell.v_begin};
        });
        along(on_u_.at(cell.u_end), cell.v_begin, cell.v_end, true, [&](std::uint32_t v) {
            return GridPoint{cell.u_end, v};
        });
        along(on_v_.at(cell.v_end), cell.u_begin, cell.u_end, false, [&](std::uint32_t u) {
            return GridPoint{u, cell.v_end};
        });
        along(on_u_.at(cell.u_begin), cell.v_begin, cell.v_end, false, [&](std::uint32_t v) {
            return GridPoint{cell.u_begin, v};
        });
        return points;
    }

    void add_cell(const ParameterCell& cell) {
        const std::vector<GridPoint> points = outline(cell);
        if (points.size() == 4) {
            const auto diagonal = [&](std::size_t a, std::size_t b) {
                return length(
                    mesh_.positions[position_of(points[a])]
                    - mesh_.positions[position_of(points[b])]);
            };
            for (const GridPoint point : points)
                position_of(point);
            const std::size_t first = diagonal(0, 2) <= diagonal(1, 3) ? 0 : 1;
            add_triangle(points[first], points[first + 1], points[first + 2]);
            add_triangle(points[first], points[first + 2], points[(first + 3) % 4]);
            return;
        }
        // Sides of triangles would lie on one line: all go to the middle. Cells with such points
        // are longer than a step.
        const GridPoint middle = {
            cell.u_begin + (cell.u_end - cell.u_begin) / 2,
            cell.v_begin + (cell.v_end - cell.v_begin) / 2};
        for (std::size_t i = 0; i < points.size(); ++i)
            add_triangle(points[i], points[(i + 1) % points.size()], middle);
    }

    void add_triangle(GridPoint a, GridPoint b, GridPoint c) {
        const std::array<GridPoint, 3> points = {a, b, c};
        std::array<std::uint32_t, 3> positions = {};
        for (std::size_t i = 0; i < 3; ++i)
            positions[i] = position_of(points[i]);
        const Vec3 first = mesh_.positions[positions[0]];
        const Vec3 area =
            cross(mesh_.positions[positions[1]] - first, mesh_.positions[positions[2]] - first);
        // At a pole.
        if (!(length(area) > 0))
            return;
        const Vec3 own = normalized(area);
        for (std::size_t i = 0; i < 3; ++i) {
            mesh_.position_indices.push_back(positions[i]);
            mesh_.normal_indices.push_back(normal_of(points, i, own));
        }
    }

    std::uint32_t add_normal(Vec3 normal) {
        mesh_.normals.push_back(normal);
        return static_cast<std::uint32_t>(mesh_.normals.size() - 1);
    }

    /// Of a corner of a triangle whose own normal is given.
    std::uint32_t normal_of(const std::array<GridPoint, 3>& points, std::size_t corner, Vec3 own) {
        const auto known = normals_.find(key(points[corner]));
        if (known != normals_.end())
            return known->second;
        const double u = grid_.u(points[corner].u);
        const double v = grid_.v(points[corner].v);
        if (const auto normal = place_at(u, v).normal) {
            const std::uint32_t number = add_normal(*normal);
            normals_.emplace(key(points[corner]), number);
            return number;
        }
        // The limit, from within the triangle: each triangle round the tip of a cone has its own.
        double middle_u = 0;
        double middle_v = 0;
        for (const GridPoint point : points) {
            middle_u += grid_.u(point.u) / 3;
            middle_v += grid_.v(point.v) / 3;
        }
        for (const double part : {1e-4, 1e-2, 1.0})
            if (const auto normal =
                    place_at(u + part * (middle_u - u), v + part * (middle_v - v)).normal)
                return add_normal(*normal);
        return add_normal(own);
    }

    const ParameterGrid& grid_;
    const AllowedDeviation& allowed_;
    Lines on_u_; ///< by u, the v of the points
    Lines on_v_; ///< by v, the u
    bool joined_u_ = false;
    bool joined_v_ = false;
    std::array<bool, 2> shrunk_u_ = {};
    std::array<bool, 2> shrunk_v_ = {};
    Mesh mesh_;
    std::unordered_map<std::uint64_t, std::uint32_t> positions_;
    std::unordered_map<std::uint64_t, std::uint32_t> normals_;
};

} // namespace

Mesh mesh_of_cells(
    const ParameterGrid& grid,
    const std::vector<ParameterCell>& cells,
    const AllowedDeviation& allowed) {
    return CellMesher(grid, allowed).mesh(cells);
}

} // namespace vera::detail
