// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/hidden_squares.h"

#include "vera/visible/screen_box.h"

#include <algorithm>
#include <limits>
#include <span>

namespace vera {

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
    ScreenBox around;
    for (const ScreenPoint corner : std::span(corners, count)) {
        around.x.include(corner.x);
        around.y.include(corner.y);
    }
    return std::max(around.x.most - around.x.least, around.y.most - around.y.least)
        >= std::int64_t{2 * smallest} << shift_;
}

bool HiddenSquares::may_touch(const Square& square, const Figure& figure) const {
    constexpr std::int64_t beside = 2; // steps, in which for_each_cell_of() may visit a cell
    const std::int64_t width = std::int64_t{smallest}
        << (square.level + static_cast<std::size_t>(shift_));
    const auto range = [&](std::int32_t number) {
        return ScreenRange{number * width - beside, (number + 1) * width + beside};
    };
    return do_meet(
        {range(square.column), range(square.row)}, std::span(figure.corners, figure.count));
}

} // namespace vera
