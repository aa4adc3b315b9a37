// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/surface.h"

#include "vera/generate/surface_mesh.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vera {

namespace {

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

/// length(), but infinite or not a number where any component is.
double size_of(Vec3 a) {
    return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
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
    bound.cut_u = is_better_cut_across_u(place, a, b);
    const bool u_whole = cell.u_end - cell.u_begin == 1;
    const bool v_whole = cell.v_end - cell.v_begin == 1;
    if (u_whole || v_whole)
        bound.cut_u = !u_whole;
    return bound;
}

[[noreturn]] void refuse_place(const ParameterGrid& grid, const ParameterCell& cell) {
    throw SurfaceError(
        fmt::format(
            "the surface has no value, is not bounded or jumps near u = {:.6g}, v = {:.6g}",
            grid.u(cell.u_begin),
            grid.v(cell.v_begin)),
        "keep the place out of the ranges of u and v");
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
    throw SurfaceError(
        fmt::format("this takes about {:.2g} triangles, and {} are allowed", triangles, most),
        "allow a larger deviation, or more triangles");
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
    return detail::mesh_of_cells(grid, cells, settings.allowed);
}

Box3 sampled_bounds(const Surface& surface) {
    constexpr int steps = 32;
    Box3 box;
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= steps; ++j) {
            const double u =
                surface.u_begin + (surface.u_end - surface.u_begin) * i / double{steps};
            const double v =
                surface.v_begin + (surface.v_end - surface.v_begin) * j / double{steps};
            const Vec3 place = {
                surface.x.at(u, v).value, surface.y.at(u, v).value, surface.z.at(u, v).value};
            if (is_finite(place))
                box = grown(box, place);
        }
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
