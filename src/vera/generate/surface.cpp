// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/surface.h"

#include "vera/generate/surface_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace vera {

namespace {

using detail::halves;
using detail::ParameterCell;
using detail::ParameterGrid;

/// How far the triangles of a cell may lie off the surface, whatever its triangles are, and across
/// which side it is best cut.
struct CellBound {
    double deviation = 0;
    double allowed = 0;
    bool cut_u = true;
};

/// The largest absolute values of the members of the jets of x, y and z.
Vec3 magnitudes(const std::array<Jet<Interval>, 3>& place, Interval Jet<Interval>::*member) {
    return {magnitude(place[0].*member), magnitude(place[1].*member), magnitude(place[2].*member)};
}

/// length(), but infinite or not a number where any component is, and there alone.
double size_of(Vec3 a) {
    const double size = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    constexpr double small = 0x1p-600; // squares do not overflow
    return std::isfinite(size) ? size : std::sqrt(dot(small * a, small * a)) / small;
}

/// A triangle with its corners in the cell meets the linear function through its corners. By
/// Taylor's theorem from a point to the corners, with the point's weights l_i, these differ by at
/// most the sum of l_i (|uu| du_i^2 / 2 + |uv| |du_i dv_i| + |vv| dv_i^2 / 2): the linear terms
/// cancel. The weighted squares of distances in a range of width a are at most a^2 / 4 (Popoviciu),
/// which gives an eighth of |uu| a^2 + 2 |uv| a b + |vv| b^2. By first derivatives alone it is half
/// of |u| a + |v| b, and by values alone what they differ by.
double component_deviation(const Jet<Interval>& jet, double a, double b) {
    const double second =
        (magnitude(jet.uu) * a * a + 2 * magnitude(jet.uv) * a * b + magnitude(jet.vv) * b * b) / 8;
    const double first = (magnitude(jet.u) * a + magnitude(jet.v) * b) / 2;
    double least = jet.value.upper - jet.value.lower;
    for (const double bound : {first, second})
        if (bound < least || std::isnan(least))
            least = bound;
    return std::isnan(least) ? std::numeric_limits<double>::infinity() : least;
}

bool is_better_cut_across_u(const std::array<Jet<Interval>, 3>& place, double a, double b) {
    using J = Jet<Interval>;
    const double second_u = size_of(magnitudes(place, &J::uu)) * a * a;
    const double second_v = size_of(magnitudes(place, &J::vv)) * b * b;
    if (std::isfinite(second_u) && std::isfinite(second_v) && second_u + second_v > 0)
        return second_u >= second_v;
    const double first_u = size_of(magnitudes(place, &J::u)) * a;
    const double first_v = size_of(magnitudes(place, &J::v)) * b;
    if (std::isfinite(first_u) && std::isfinite(first_v) && first_u + first_v > 0)
        return first_u >= first_v;
    return a >= b;
}

CellBound
bound_of(const ParameterGrid& grid, const ParameterCell& cell, const AllowedDeviation& allowed) {
    const Interval u = {grid.u(cell.u_begin), grid.u(cell.u_end)};
    const Interval v = {grid.v(cell.v_begin), grid.v(cell.v_end)};
    const auto place = grid.jets(u, v);
    const double a = next_above(u.upper - u.lower);
    const double b = next_above(v.upper - v.lower);
    CellBound bound;
    bound.deviation = size_of(
        {component_deviation(place[0], a, b),
         component_deviation(place[1], a, b),
         component_deviation(place[2], a, b)});
    const Vec3 lower = {place[0].value.lower, place[1].value.lower, place[2].value.lower};
    const Vec3 upper = {place[0].value.upper, place[1].value.upper, place[2].value.upper};
    const bool bounded =
        place[0].value.is_bounded() && place[1].value.is_bounded() && place[2].value.is_bounded();
    // A millionth of it is left for the rounding of this and of the corners.
    bound.allowed = bounded ? (1 - 1e-6) * allowed({lower, upper}) : 0;
    // Also of a formula that is constant, and so has derivatives of 0.
    if (!bounded)
        bound.deviation = std::numeric_limits<double>::infinity();
    bound.cut_u = is_better_cut_across_u(place, a, b);
    const bool u_whole = cell.u_end - cell.u_begin == 1;
    const bool v_whole = cell.v_end - cell.v_begin == 1;
    if (u_whole || v_whole)
        bound.cut_u = !u_whole;
    return bound;
}

constexpr std::array<char, 3> axis_names = {'x', 'y', 'z'};

/// By a corner of the cell, or its middle, at which a formula has no value; or else as a whole.
[[noreturn]] void refuse_place(const ParameterGrid& grid, const ParameterCell& cell) {
    constexpr const char* remedy = "keep the place out of the ranges of u and v";
    const ParameterCell middle = halves(halves(cell, true).second, false).second;
    for (const auto& [u, v] :
         {std::pair(middle.u_begin, middle.v_begin),
          std::pair(cell.u_begin, cell.v_begin),
          std::pair(cell.u_end, cell.v_begin),
          std::pair(cell.u_begin, cell.v_end),
          std::pair(cell.u_end, cell.v_end)}) {
        const auto jets = grid.jets(grid.u(u), grid.v(v));
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!std::isfinite(jets[axis].value))
                throw SurfaceError(
                    fmt::format(
                        "{} has no finite value at u = {:.6g}, v = {:.6g}",
                        axis_names[axis],
                        grid.u(u),
                        grid.v(v)),
                    remedy);
    }
    throw SurfaceError(
        fmt::format(
            "the surface has no bound, jumps or has a place without value near u = {:.6g}, "
            "v = {:.6g}",
            grid.u(middle.u_begin),
            grid.v(middle.v_begin)),
        remedy);
}

/// Calls visit(place) of places all over the ranges.
template <typename Visitor>
void for_each_sample(const Surface& surface, const Visitor& visit) {
    constexpr int steps = 32;
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= steps; ++j) {
            const double u =
                surface.u_begin + (surface.u_end - surface.u_begin) * i / double{steps};
            const double v =
                surface.v_begin + (surface.v_end - surface.v_begin) * j / double{steps};
            visit(
                Vec3{surface.x.at(u, v).value, surface.y.at(u, v).value, surface.z.at(u, v).value});
        }
}

/// A formula that has a value nowhere is wrong as a whole, and not at a place.
void refuse_without_values(const Surface& surface) {
    std::array<bool, 3> has_value = {};
    for_each_sample(surface, [&](Vec3 place) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            has_value[axis] = has_value[axis] || std::isfinite(place[axis]);
    });
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!has_value[axis])
            throw SurfaceError(
                fmt::format(
                    "{} has a finite value nowhere in the ranges of u and v", axis_names[axis]),
                "there is no log of 0 or below, no root or broken power below 0, and nothing "
                "divided by 0");
}

/// Triangles of a line or a point are slivers by rounding alone, or none.
void refuse_without_area(const Mesh& mesh) {
    Box3 box;
    for (const Vec3 position : mesh.positions)
        box = grown(box, position);
    const double size = length(box.upper - box.lower);
    double area = 0;
    for (std::size_t i = 0; i < mesh.position_indices.size(); i += 3) {
        const Vec3 corner = mesh.positions[mesh.position_indices[i]];
        area += length(cross(
                    mesh.positions[mesh.position_indices[i + 1]] - corner,
                    mesh.positions[mesh.position_indices[i + 2]] - corner))
            / 2;
    }
    constexpr double least_part = 1e-12; // of the square
    if (area > least_part * size * size)
        return;
    constexpr double least_size = 1e-140; // its square, and parts of it, are doubles
    if (size > 0 && size < least_size)
        throw SurfaceError(
            fmt::format("the surface is only {:.2g} across, too small to have an area", size),
            "make x, y and z larger; SC shrinks what a scene calls");
    throw SurfaceError(
        fmt::format("the surface has no area: all of it is one {}", size > 0 ? "line" : "point"),
        "x, y and z must change with both u and v, and not all in the same way");
}

/// How many triangles it would be in all, should the bounds shrink with the area of cells.
double forecast(std::size_t done, const std::vector<CellBound>& bounds) {
    auto cells = static_cast<double>(done);
    for (const CellBound& bound : bounds)
        cells += std::max(1.0, bound.deviation / bound.allowed);
    return 2 * cells;
}

[[noreturn]] void refuse_many(
    const ParameterGrid& grid,
    const std::vector<ParameterCell>& open,
    const std::vector<CellBound>& bounds,
    double triangles,
    std::size_t most) {
    for (std::size_t i = 0; i < open.size(); ++i)
        if (!std::isfinite(bounds[i].deviation))
            refuse_place(grid, open[i]);
    throw TooManyTriangles(
        fmt::format("this takes about {:.2g} triangles, and {} are allowed", triangles, most),
        "allow a larger deviation");
}

/// Cells that cover the ranges, each within what is allowed.
std::vector<ParameterCell>
good_cells(const ParameterGrid& grid, const TessellationSettings& settings) {
    std::vector<ParameterCell> good;
    // Some at the least, so that what is closed does not fold up.
    std::vector<ParameterCell> open = grid.first_cells();
    std::vector<CellBound> bounds;
    while (!open.empty()) {
        if (settings.cancel != nullptr)
            settings.cancel->throw_if_raised();
        bounds.resize(open.size());
        parallel_ranges(open.size(), 64, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                bounds[i] = bound_of(grid, open[i], settings.allowed);
        });
        const double triangles = forecast(good.size(), bounds);
        if (2 * (good.size() + open.size()) > settings.most_triangles)
            refuse_many(grid, open, bounds, triangles, settings.most_triangles);
        std::vector<ParameterCell> next;
        for (std::size_t i = 0; i < open.size(); ++i) {
            const ParameterCell& cell = open[i];
            if (bounds[i].deviation <= bounds[i].allowed) {
                good.push_back(cell);
                continue;
            }
            if (cell.u_end - cell.u_begin == 1 && cell.v_end - cell.v_begin == 1)
                refuse_place(grid, cell);
            const auto [first, second] = halves(cell, bounds[i].cut_u);
            next.push_back(first);
            next.push_back(second);
        }
        open = std::move(next);
        if (settings.progress && triangles > 0)
            settings.progress(std::min(1.0, 2 * static_cast<double>(good.size()) / triangles));
    }
    return good;
}

} // namespace

Mesh tessellated(const Surface& surface, const TessellationSettings& settings) {
    refuse_without_values(surface);
    const ParameterGrid grid(surface);
    // Progress never goes back, while a forecast may.
    TessellationSettings forward = settings;
    double told = 0;
    if (settings.progress)
        forward.progress = [&](double done) {
            told = std::max(told, done);
            settings.progress(told);
        };
    const std::vector<ParameterCell> cells = good_cells(grid, forward);
    Mesh mesh = detail::mesh_of_cells(grid, cells, settings.allowed);
    refuse_without_area(mesh);
    return mesh;
}

Box3 sampled_bounds(const Surface& surface) {
    Box3 box;
    for_each_sample(surface, [&](Vec3 place) {
        if (is_finite(place))
            box = grown(box, place);
    });
    return box;
}

AllowedDeviation deviation_of(double length) {
    return [length](const Box3&) { return length; };
}

AllowedDeviation deviation_of_pixels(double pixels, const Camera& camera, std::uint32_t width) {
    const Vec3 across = camera.lower_right - camera.lower_left;
    const Vec3 up = camera.upper_left - camera.lower_left;
    Vec3 forward = normalized(cross(up, across));
    double distance = dot(camera.lower_left - camera.viewpoint, forward);
    if (distance < 0) {
        forward = -forward;
        distance = -distance;
    }
    const double pixels_per_slope = static_cast<double>(width) * distance / length(across);
    return [=, viewpoint = camera.viewpoint](const Box3& part) {
        const Vec3 center = 0.5 * (part.lower + part.upper) - viewpoint;
        const double radius = 0.5 * length(part.upper - part.lower);
        const double nearest = dot(center, forward) - radius;
        if (!(nearest > 0))
            return 0.0;
        // What lies at depth z and at slope r off the axis is shifted by at most
        // d sqrt(1 + r^2) / (z - d) when it moves by d.
        const double aside = length(center - dot(center, forward) * forward) + radius;
        const double slope = aside / nearest;
        return pixels * nearest / (pixels_per_slope * std::sqrt(1 + slope * slope) + pixels);
    };
}

} // namespace vera
