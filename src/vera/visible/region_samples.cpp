// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_samples.h"

#include "vera/base/random.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace vera {

namespace {

/// Calls sink(i) for all whole numbers i with from < step * (i + 1/2) < to.
template <typename Sink>
void for_each_step(double from, double to, double step, const Sink& sink) {
    for (double i = std::floor(from / step + 0.5); step * (i + 0.5) < to; ++i)
        if (step * (i + 0.5) > from)
            sink(step * (i + 0.5));
}

void add_border_points(
    const std::vector<BorderRing>& rings, double spacing, std::vector<DrawingPoint>& points) {
    for (const BorderRing& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const DrawingPoint from = ring[i];
            const DrawingPoint to = ring[i + 1 == ring.size() ? 0 : i + 1];
            const double x = to.x - from.x;
            const double y = to.y - from.y;
            const double parts = std::ceil(std::sqrt(x * x + y * y) / spacing);
            points.push_back(from);
            for (double part = 1; part < parts; ++part)
                points.push_back({from.x + part / parts * x, from.y + part / parts * y});
        }
}

/// Calls visit(row, y, from, to) for each part inside the areas of rows that are so far apart.
template <typename Visit>
void for_each_inner_part(const std::vector<BorderRing>& rings, double spacing, const Visit& visit) {
    const Extent extent = extent_of(rings);
    const double top = extent.least.y;
    // The rows' crossings with the sides, all sides once.
    const auto rows = static_cast<std::size_t>((extent.most.y - top) / spacing) + 1;
    std::vector<std::vector<double>> crossings(rows);
    for (const BorderRing& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            DrawingPoint from = ring[i];
            DrawingPoint to = ring[i + 1 == ring.size() ? 0 : i + 1];
            if (from.y > to.y)
                std::swap(from, to);
            for_each_step(from.y - top, to.y - top, spacing, [&](double y) {
                const double part = (top + y - from.y) / (to.y - from.y);
                const auto row = static_cast<std::size_t>(y / spacing);
                if (row < rows)
                    crossings[row].push_back(from.x + part * (to.x - from.x));
            });
        }
    for (std::size_t row = 0; row < rows; ++row) {
        std::ranges::sort(crossings[row]);
        const double y = top + spacing * (static_cast<double>(row) + 0.5);
        for (std::size_t i = 0; i + 1 < crossings[row].size(); i += 2)
            visit(row, y, crossings[row][i], crossings[row][i + 1]);
    }
}

void add_inner_points(
    const std::vector<BorderRing>& rings, double spacing, std::vector<DrawingPoint>& points) {
    const double left = extent_of(rings).least.x;
    for_each_inner_part(rings, spacing, [&](std::size_t, double y, double from, double to) {
        for_each_step(from - left, to - left, spacing, [&](double x) {
            points.push_back({left + x, y});
        });
    });
}

} // namespace

double Extent::length() const {
    return std::max(most.x - least.x, most.y - least.y);
}

Extent extent_of(const std::vector<BorderRing>& rings) {
    Extent extent;
    for (const BorderRing& ring : rings)
        for (const DrawingPoint point : ring) {
            extent.least = {std::min(extent.least.x, point.x), std::min(extent.least.y, point.y)};
            extent.most = {std::max(extent.most.x, point.x), std::max(extent.most.y, point.y)};
        }
    return extent;
}

double area_of(const std::vector<BorderRing>& rings) {
    double doubled = 0;
    for (const BorderRing& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const DrawingPoint next = ring[i + 1 == ring.size() ? 0 : i + 1];
            doubled += ring[i].x * next.y - ring[i].y * next.x;
        }
    return std::abs(doubled) / 2;
}

double sample_spacing(double length, double area) {
    constexpr double widest = 6; // pixels: highlights are not much smaller
    const double across = std::max(area / length / 2, length / 64);
    return std::max(std::min({length / 4, across, widest}), length / 128);
}

std::vector<DrawingPoint> sample_points(const std::vector<BorderRing>& rings, double spacing) {
    std::vector<DrawingPoint> points;
    add_border_points(rings, spacing, points);
    add_inner_points(rings, spacing, points);
    return points;
}

std::vector<DrawingPoint>
scattered_points(const std::vector<BorderRing>& rings, double spacing, std::uint64_t round) {
    // Rows are closer together than the points of one, which begins anywhere.
    constexpr double rows = 4;
    constexpr std::uint64_t seed = 1972;
    const double along = rows * spacing;
    std::vector<DrawingPoint> points;
    for_each_inner_part(
        rings, spacing / rows, [&](std::size_t row, double y, double from, double to) {
            const double part = static_cast<double>(random(seed, row, round) >> 11U) * 0x1p-53;
            const double shift = part * along;
            for_each_step(from - shift, to - shift, along, [&](double x) {
                points.push_back({x + shift, y});
            });
        });
    return points;
}

} // namespace vera
