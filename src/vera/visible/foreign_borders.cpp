// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/foreign_borders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vera {

namespace {

struct Offset {
    double x = 0;
    double y = 0;
};

Offset from_to(DrawingPoint from, DrawingPoint to) {
    return {to.x - from.x, to.y - from.y};
}

double dot(Offset a, Offset b) {
    return a.x * b.x + a.y * b.y;
}

double cross(Offset a, Offset b) {
    return a.x * b.y - a.y * b.x;
}

/// A part of a segment, from 0 at its beginning to 1 at its end.
struct Part {
    double first = 1;
    double last = 0;

    bool empty() const { return !(first < last); }

    void include(double place) {
        first = std::min(first, place);
        last = std::max(last, place);
    }
};

/// Adds where the segment comes as close to a point as reach.
void include_disc(Part& part, Offset along, Offset to_center, double reach) {
    const double squared = dot(along, along);
    const double middle = dot(along, to_center) / squared;
    const double off = cross(along, to_center);
    const double half_squared = reach * reach - off * off / squared;
    if (half_squared <= 0)
        return;
    const double half = std::sqrt(half_squared / squared);
    part.include(middle - half);
    part.include(middle + half);
}

/// Where the segment comes as close to another as reach: what is so close to a segment is convex.
Part close_part(
    DrawingPoint begin, DrawingPoint end, const ForeignBorders::Border& border, double reach) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Offset along = from_to(begin, end);
    const Offset side = from_to(border.begin, border.end);
    Part part = {infinity, -infinity};
    include_disc(part, along, from_to(begin, border.begin), reach);
    include_disc(part, along, from_to(begin, border.end), reach);
    const double side_squared = dot(side, side);
    if (side_squared > 0) {
        // Beside the border: between its ends, and no farther off than reach.
        const Offset from_border = from_to(border.begin, begin);
        double first = -infinity;
        double last = infinity;
        const auto keep = [&](double at, double speed, double least, double most) {
            if (speed == 0) {
                if (at < least || at > most)
                    last = -infinity;
                return;
            }
            const double one = (least - at) / speed;
            const double other = (most - at) / speed;
            first = std::max(first, std::min(one, other));
            last = std::min(last, std::max(one, other));
        };
        const double most_off = reach * std::sqrt(side_squared);
        keep(dot(side, from_border), dot(side, along), 0, side_squared);
        keep(cross(side, from_border), cross(side, along), -most_off, most_off);
        if (first < last) {
            part.include(first);
            part.include(last);
        }
    }
    return {std::max(part.first, 0.0), std::min(part.last, 1.0)};
}

} // namespace

ForeignBorders::ForeignBorders(
    double width, double height, double reach, std::vector<Border> borders)
    : borders_(std::move(borders))
    , reach_(reach) {
    // About a border a cell, no cell narrower than a line.
    const double per_side = std::sqrt(static_cast<double>(borders_.size()) + 1);
    const auto count = [&](double size) {
        return static_cast<std::size_t>(
            std::max(1.0, std::floor(std::min(per_side, size / (2 * reach)))));
    };
    columns_ = count(width);
    rows_ = count(height);
    columns_per_pixel_ = static_cast<double>(columns_) / width;
    rows_per_pixel_ = static_cast<double>(rows_) / height;
    first_of_cell_.assign(columns_ * rows_ + 1, 0);
    for (const Border& border : borders_)
        for_each_cell(
            border.begin, border.end, [&](std::size_t cell) { ++first_of_cell_[cell + 1]; });
    for (std::size_t cell = 0; cell < columns_ * rows_; ++cell)
        first_of_cell_[cell + 1] += first_of_cell_[cell];
    in_cells_.resize(first_of_cell_.back());
    std::vector<std::size_t> next(first_of_cell_.begin(), first_of_cell_.end() - 1);
    for (std::uint32_t i = 0; i < borders_.size(); ++i)
        for_each_cell(borders_[i].begin, borders_[i].end, [&](std::size_t cell) {
            in_cells_[next[cell]++] = i;
        });
}

template <typename Visit>
void ForeignBorders::for_each_cell(DrawingPoint begin, DrawingPoint end, const Visit& visit) const {
    if (end.x < begin.x)
        std::swap(begin, end);
    const auto cell_of = [](double value, std::size_t count) {
        return static_cast<std::size_t>(
            std::clamp(std::floor(value), 0.0, static_cast<double>(count - 1)));
    };
    const std::size_t last = cell_of((end.x + reach_) * columns_per_pixel_, columns_);
    for (std::size_t column = cell_of((begin.x - reach_) * columns_per_pixel_, columns_);
         column <= last;
         ++column) {
        // Of the segment what lies in the column, or no farther from it than reach.
        const double left = static_cast<double>(column) / columns_per_pixel_ - reach_;
        const double right = static_cast<double>(column + 1) / columns_per_pixel_ + reach_;
        const auto y_at = [&](double x) {
            const double part = end.x > begin.x ? (x - begin.x) / (end.x - begin.x) : 0;
            return begin.y + std::clamp(part, 0.0, 1.0) * (end.y - begin.y);
        };
        double top = end.x > begin.x ? y_at(left) : begin.y;
        double bottom = end.x > begin.x ? y_at(right) : end.y;
        if (bottom < top)
            std::swap(top, bottom);
        const std::size_t last_row = cell_of((bottom + reach_) * rows_per_pixel_, rows_);
        for (std::size_t row = cell_of((top - reach_) * rows_per_pixel_, rows_); row <= last_row;
             ++row)
            visit(row * columns_ + column);
    }
}

std::vector<std::vector<DrawingPoint>> ForeignBorders::clear_parts(
    DrawingPoint begin, DrawingPoint end, std::uint32_t order, std::uint32_t thing) const {
    std::vector<Part> close;
    if (begin == end)
        return {};
    for_each_cell(begin, end, [&](std::size_t cell) {
        for (std::size_t i = first_of_cell_[cell]; i < first_of_cell_[cell + 1]; ++i) {
            const Border& border = borders_[in_cells_[i]];
            if (border.order >= order || border.thing == thing)
                continue;
            const Part part = close_part(begin, end, border, reach_);
            if (!part.empty())
                close.push_back(part);
        }
    });
    std::sort(
        close.begin(), close.end(), [](const Part& a, const Part& b) { return a.first < b.first; });
    close.push_back({1, 1});
    std::vector<std::vector<DrawingPoint>> clear;
    const auto point_at = [&](double place) -> DrawingPoint {
        if (place == 0 || place == 1)
            return place == 0 ? begin : end;
        return {begin.x + place * (end.x - begin.x), begin.y + place * (end.y - begin.y)};
    };
    double from = 0;
    for (const Part& part : close) {
        if (part.first > from)
            clear.push_back({point_at(from), point_at(part.first)});
        from = std::max(from, part.last);
    }
    return clear;
}

} // namespace vera
