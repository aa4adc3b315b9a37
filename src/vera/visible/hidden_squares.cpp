// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/hidden_squares.h"

#include <algorithm>
#include <limits>
#include <span>

namespace vera {

namespace {

/// From the least to the most.
struct Range {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    std::int64_t most = std::numeric_limits<std::int64_t>::min();

    void include(std::int64_t value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }

    bool meets(const Range& other) const { return least <= other.most && other.least <= most; }
};

} // namespace

HiddenSquares::HiddenSquares(const Cells& cells)
    : shift_(cells.shift) {
    if (cells.per_side < smallest)
        return;
    std::int32_t per_side = cells.per_side / smallest;
    std::vector<double> least(
        static_cast<std::size_t>(per_side) * static_cast<std::size_t>(per_side),
        std::numeric_limits<double>::infinity());
    for (std::int32_t row = 0; row < cells.per_side; ++row)
        for (std::int32_t column = 0; column < cells.per_side; ++column) {
            double& square = least
                [static_cast<std::size_t>(row / smallest) * static_cast<std::size_t>(per_side)
                 + static_cast<std::size_t>(column / smallest)];
            square = std::min(square, cells.blocked[cells.number(column, row)]);
        }
    levels_.push_back(std::move(least));
    for (; per_side > 1; per_side /= 2) {
        const std::vector<double>& below = levels_.back();
        std::vector<double> above(below.size() / 4);
        const auto wide = static_cast<std::size_t>(per_side);
        for (std::size_t i = 0; i < above.size(); ++i) {
            const std::size_t first = 2 * (i / (wide / 2)) * wide + 2 * (i % (wide / 2));
            above[i] = std::min(
                {below[first], below[first + 1], below[first + wide], below[first + wide + 1]});
        }
        levels_.push_back(std::move(above));
    }
}

bool HiddenSquares::is_long(const ScreenPoint* corners, std::size_t count) const {
    Range x;
    Range y;
    for (const ScreenPoint corner : std::span(corners, count)) {
        x.include(corner.x);
        y.include(corner.y);
    }
    return std::max(x.most - x.least, y.most - y.least) >= std::int64_t{2 * smallest} << shift_;
}

/// By the directions that could part them: along the axes, and across each side of the figure.
bool HiddenSquares::may_touch(const Square& square, const Figure& figure) const {
    constexpr std::int64_t beside = 2; // steps, in which for_each_cell_of() may visit a cell
    const std::int64_t width = std::int64_t{smallest}
        << (square.level + static_cast<std::size_t>(shift_));
    const Range columns = {square.column * width - beside, (square.column + 1) * width + beside};
    const Range rows = {square.row * width - beside, (square.row + 1) * width + beside};
    Range x;
    Range y;
    for (const ScreenPoint corner : std::span(figure.corners, figure.count)) {
        x.include(corner.x);
        y.include(corner.y);
    }
    if (!x.meets(columns) || !y.meets(rows))
        return false;
    for (std::size_t i = 0; i < figure.count; ++i) {
        const ScreenPoint a = figure.corners[i];
        const ScreenStep side = step(a, figure.corners[(i + 1) % figure.count]);
        Range figures;
        for (const ScreenPoint corner : std::span(figure.corners, figure.count))
            figures.include(cross(side, step(a, corner)));
        Range squares;
        for (const std::int64_t column : {columns.least, columns.most})
            for (const std::int64_t row : {rows.least, rows.most})
                squares.include(cross(side, {column - a.x, row - a.y}));
        if (!figures.meets(squares))
            return false;
    }
    return true;
}

} // namespace vera
