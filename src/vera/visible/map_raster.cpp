// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/map_raster.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace vera {

namespace {

/// What covers less of a pixel cannot be told from the rounding of sums of areas, and is too little
/// for any picture's samples.
constexpr double least_area = 0x1p-24;

/// An area, and its integrals of x and y from a pixel's upper left corner.
struct Moments {
    double area = 0;
    double x = 0;
    double y = 0;

    Moments& operator+=(const Moments& more) {
        area += more.area;
        x += more.x;
        y += more.y;
        return *this;
    }
};

/// What the sides that pass through a pixel change, in a sweep from the left to the right: in it,
/// the area on their right; in all pixels behind it, the rows that they span.
struct Cell {
    Moments within;
    double height = 0;
    double height_y = 0; ///< integral of y over them
};

/// The moments of what lies in the unit square on the right of the way from (x, y) to (to_x, to_y).
Moments right_of(double x, double y, double to_x, double to_y) {
    const double height = to_y - y;
    const double left_y =
        (2 * x * y + x * to_y + to_x * y + 2 * to_x * to_y) / 6; // integral of x y, per height
    return {
        height * (1 - (x + to_x) / 2),
        height * (1 - (x * x + x * to_x + to_x * to_x) / 3) / 2,
        height * ((y + to_y) / 2 - left_y)};
}

/// The cells of some rows of a picture, while one source after the other is put into them.
class CellRows {
public:
    CellRows(std::size_t width, std::size_t first_row, std::size_t last_row)
        : width_(width)
        , first_row_(first_row)
        , cells_(width * (last_row - first_row))
        , touched_(last_row - first_row) {}

    /// From an upper to a lower point, in pixels; inside_sign is 1 where the source lies on the
    /// right of it.
    void add(double x, double y, double to_x, double to_y, double inside_sign);

    /// Adds the parts of the source, and forgets it.
    void take(std::uint32_t source, std::vector<PixelPart>& parts);

private:
    /// The cells of a row that are not 0.
    struct Touched {
        std::size_t first = ~std::size_t{0};
        std::size_t last = 0;
    };

    void add_in_row(std::size_t row, double x, double y, double to_x, double to_y, double sign);
    void add_in_cell(
        std::size_t row,
        std::size_t column,
        double x,
        double y,
        double to_x,
        double to_y,
        double sign);

    std::size_t width_;
    std::size_t first_row_;
    std::vector<Cell> cells_;
    std::vector<Touched> touched_;
};

void CellRows::add(double x, double y, double to_x, double to_y, double inside_sign) {
    if (!(y < to_y))
        return;
    const auto x_at = [&](double row) { return x + (row - y) * (to_x - x) / (to_y - y); };
    const auto top = static_cast<double>(first_row_);
    const double bottom = top + static_cast<double>(touched_.size());
    for (double row = std::max(std::floor(y), top); row < std::min(to_y, bottom); ++row) {
        const bool begins = row <= y;
        const bool ends = to_y <= row + 1;
        add_in_row(
            static_cast<std::size_t>(row - top),
            begins ? x : x_at(row),
            begins ? y - row : 0,
            ends ? to_x : x_at(row + 1),
            ends ? to_y - row : 1,
            inside_sign);
    }
}

/// y and to_y from the row's upper side.
void CellRows::add_in_row(
    std::size_t row, double x, double y, double to_x, double to_y, double sign) {
    const auto width = static_cast<double>(width_);
    x = std::clamp(x, 0.0, width);
    to_x = std::clamp(to_x, 0.0, width);
    const double step = to_x < x ? -1 : 1;
    double column = step > 0 ? std::floor(x) : std::ceil(x) - 1;
    double here_x = x;
    double here_y = y;
    while (true) {
        const double border = step > 0 ? column + 1 : column;
        const bool ends = step > 0 ? to_x <= border : to_x >= border;
        const double next_x = ends ? to_x : border;
        const double next_y =
            ends ? to_y : std::clamp(y + (border - x) * (to_y - y) / (to_x - x), here_y, to_y);
        if (column >= 0 && column < width)
            add_in_cell(
                row,
                static_cast<std::size_t>(column),
                here_x - column,
                here_y,
                next_x - column,
                next_y,
                sign);
        if (ends)
            return;
        here_x = next_x;
        here_y = next_y;
        column += step;
    }
}

void CellRows::add_in_cell(
    std::size_t row,
    std::size_t column,
    double x,
    double y,
    double to_x,
    double to_y,
    double sign) {
    Cell& cell = cells_[row * width_ + column];
    const Moments right = right_of(x, y, to_x, to_y);
    cell.within += {sign * right.area, sign * right.x, sign * right.y};
    cell.height += sign * (to_y - y);
    cell.height_y += sign * (to_y - y) * (y + to_y) / 2;
    Touched& touched = touched_[row];
    touched.first = std::min(touched.first, column);
    touched.last = std::max(touched.last, column + 1);
}

void CellRows::take(std::uint32_t source, std::vector<PixelPart>& parts) {
    for (std::size_t row = 0; row < touched_.size(); ++row) {
        const Touched touched = touched_[row];
        touched_[row] = {};
        double height = 0;
        double height_y = 0;
        // What is open at the last side of all goes on to the frame.
        for (std::size_t column = touched.first; column < width_; ++column) {
            if (column >= touched.last && height < least_area)
                break;
            Cell& cell = cells_[row * width_ + column];
            Moments here = {height, height / 2, height_y};
            here += cell.within;
            height += cell.height;
            height_y += cell.height_y;
            cell = {};
            if (here.area < least_area)
                continue;
            PixelPart part = {
                static_cast<std::uint32_t>(column),
                static_cast<std::uint32_t>(first_row_ + row),
                source};
            if (here.area < 1 - least_area) {
                part.area = here.area;
                part.across = std::clamp(here.x / here.area, 0.0, 1.0);
                part.down = std::clamp(here.y / here.area, 0.0, 1.0);
            }
            parts.push_back(part);
        }
    }
}

/// Adds what is left of the pixel as background, and lets the areas add up to 1.
void complete_pixel(
    std::uint32_t x, std::uint32_t y, std::size_t first, std::vector<PixelPart>& parts) {
    Moments left = {1, 0.5, 0.5};
    for (std::size_t i = first; i < parts.size(); ++i) {
        const double area = parts[i].area;
        left += {-area, -area * parts[i].across, -area * parts[i].down};
    }
    if (left.area >= least_area)
        parts.push_back(
            {x,
             y,
             PixelPart::background,
             left.area,
             std::clamp(left.x / left.area, 0.0, 1.0),
             std::clamp(left.y / left.area, 0.0, 1.0)});
    else if (parts.size() == first + 1)
        parts.back().area = 1;
    else
        for (std::size_t i = first; i < parts.size(); ++i)
            parts[i].area /= 1 - left.area;
}

/// A side that a row passes.
struct Passed {
    double x = 0;
    int change = 0;
};

} // namespace

MapRaster::MapRaster(
    const VisibleMap& map, std::size_t width, std::size_t height, const CancelFlag* cancel)
    : bands_{width, height}
    , strips_(
          map,
          static_cast<double>(PixelBands::rows) * screen_size / static_cast<double>(height),
          cancel) {}

void MapRaster::add_centers(std::size_t band, std::vector<PixelPart>& parts) const {
    const double per_pixel = screen_size / static_cast<double>(bands_.width);
    const double per_row = screen_size / static_cast<double>(bands_.height);
    std::vector<Passed> passed;
    for (std::size_t y = bands_.first_row(band); y < bands_.last_row(band); ++y) {
        const std::size_t first_part = parts.size();
        for (std::size_t x = 0; x < bands_.width; ++x)
            parts.push_back({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)});
        const std::span<PixelPart> row = std::span(parts).subspan(first_part);
        // The first pixel of which the middle is not on the left of a place.
        const auto pixel_from = [&](double place) {
            const double pixel = std::ceil(place / per_pixel - 0.5);
            return static_cast<std::size_t>(
                std::clamp(pixel, 0.0, static_cast<double>(bands_.width)));
        };
        const double middle = (static_cast<double>(y) + 0.5) * per_row;
        for_each_source(strips_, strips_.of_strip(band), [&](std::uint32_t source, auto sides) {
            passed.clear();
            for (const std::uint32_t number : sides)
                if (const MapSide& side = strips_[number]; side.crosses(middle))
                    passed.push_back({side.x_at(middle), side.is_right_end ? -1 : 1});
            std::sort(passed.begin(), passed.end(), [](const Passed& a, const Passed& b) {
                return a.x < b.x;
            });
            int inside = 0;
            for (std::size_t i = 0; i + 1 < passed.size(); ++i) {
                inside += passed[i].change;
                const std::size_t last = pixel_from(passed[i + 1].x);
                for (std::size_t x = pixel_from(passed[i].x); inside > 0 && x < last; ++x)
                    row[x].source = source;
            }
        });
    }
}

void MapRaster::add_areas(std::size_t band, std::vector<PixelPart>& parts) const {
    const double across = static_cast<double>(bands_.width) / screen_size;
    const double down = static_cast<double>(bands_.height) / screen_size;
    const std::size_t first_row = bands_.first_row(band);
    CellRows rows(bands_.width, first_row, bands_.last_row(band));
    std::vector<PixelPart> found;
    for_each_source(strips_, strips_.of_strip(band), [&](std::uint32_t source, auto sides) {
        for (const std::uint32_t number : sides) {
            const MapSide& side = strips_[number];
            rows.add(
                across * side.x,
                down * side.y,
                across * side.to_x,
                down * side.to_y,
                side.is_right_end ? -1 : 1);
        }
        rows.take(source, found);
    });
    const auto place = [&](const PixelPart& part) {
        return (part.y - first_row) * bands_.width + part.x;
    };
    std::stable_sort(found.begin(), found.end(), [&](const PixelPart& a, const PixelPart& b) {
        return place(a) < place(b);
    });
    std::size_t next = 0;
    for (std::size_t y = first_row; y < bands_.last_row(band); ++y)
        for (std::size_t x = 0; x < bands_.width; ++x) {
            const std::size_t first_part = parts.size();
            for (; next < found.size() && found[next].x == x && found[next].y == y; ++next)
                parts.push_back(found[next]);
            complete_pixel(
                static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), first_part, parts);
        }
}

} // namespace vera
