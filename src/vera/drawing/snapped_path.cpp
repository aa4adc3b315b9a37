// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/snapped_path.h"

#include "vera/base/check.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace vera::detail {

namespace {

/// Doubles below this are whole numbers of units to a fraction that rounds right.
constexpr double most_units = 1e15;

std::int64_t rounded(double units) {
    VERA_CHECK(std::abs(units) < most_units); // false for what is not a number
    return std::llround(units);
}

/// Path data of an SVG that is as short as its grammar allows.
class SvgPathWriter {
public:
    explicit SvgPathWriter(int digits)
        : digits_(digits) {}

    void write(const SnappedPath& path) {
        // An m at the very beginning counts from (0, 0). Numbers behind it are lines, relative too.
        begin('m');
        write(path.points.front().x - at_.x);
        write(path.points.front().y - at_.y);
        implied_ = 'l';
        at_ = path.points.front();
        for (const SnappedPoint point : std::span(path.points).subspan(1))
            write_line_to(point);
        implied_ = '\0';
        if (path.closed) {
            text_ += 'z';
            at_ = path.points.front(); // where z leads back to
        }
    }

    std::string take() { return std::move(text_); }

private:
    void write_line_to(SnappedPoint point) {
        if (point.y == at_.y) {
            begin('h');
            write(point.x - at_.x);
        } else if (point.x == at_.x) {
            begin('v');
            write(point.y - at_.y);
        } else {
            begin('l');
            write(point.x - at_.x);
            write(point.y - at_.y);
        }
        at_ = point;
    }

    void begin(char command) {
        if (command == implied_)
            return;
        text_ += command;
        implied_ = command;
        last_ = Last::command;
    }

    void write(std::int64_t units) {
        const std::string number = decimal(units, digits_);
        const bool ends_the_last = number.front() == '-' || last_ == Last::command
            || (number.front() == '.' && last_ == Last::fraction);
        if (!ends_the_last)
            text_ += ' ';
        text_ += number;
        last_ = number.find('.') == std::string::npos ? Last::integer : Last::fraction;
    }

    enum class Last { command, integer, fraction };

    int digits_;
    std::string text_;
    SnappedPoint at_;
    char implied_ = '\0'; ///< the command that further numbers would repeat
    Last last_ = Last::command;
};

} // namespace

Lattice::Lattice(double precision) {
    VERA_CHECK(precision > 0 && std::isfinite(precision));
    constexpr int most_digits = 6;
    while (digits_ < most_digits && 1 / units_per_pixel_ > precision) {
        ++digits_;
        units_per_pixel_ *= 10;
    }
}

SnappedPoint Lattice::snapped(DrawingPoint point) const {
    return {rounded(point.x * units_per_pixel_), rounded(point.y * units_per_pixel_)};
}

std::vector<SnappedPoint>
snapped_points(std::span<const DrawingPoint> points, const Lattice& lattice) {
    std::vector<SnappedPoint> snapped;
    snapped.reserve(points.size());
    for (const DrawingPoint point : points)
        if (const SnappedPoint next = lattice.snapped(point);
            snapped.empty() || next != snapped.back())
            snapped.push_back(next);
    return snapped;
}

std::vector<SnappedPath> snapped_rings(const FilledOutline& fill, const Lattice& lattice) {
    std::vector<SnappedPath> rings;
    for (const auto& ring : fill.rings) {
        std::vector<SnappedPoint> points = snapped_points(ring, lattice);
        while (points.size() > 1 && points.back() == points.front())
            points.pop_back();
        if (points.size() >= 3)
            rings.push_back({std::move(points), true});
    }
    return rings;
}

std::optional<SnappedPath> snapped_line(const Stroke& stroke, const Lattice& lattice) {
    SnappedPath line = {snapped_points(stroke.points, lattice), stroke.closed};
    while (line.closed && line.points.size() > 1 && line.points.back() == line.points.front())
        line.points.pop_back();
    if (line.points.size() < 2)
        return std::nullopt;
    if (line.points.size() == 2)
        line.closed = false; // there and back is there
    return line;
}

std::string decimal(std::int64_t units, int digits) {
    std::string text = std::to_string(units < 0 ? -units : units);
    const auto behind = static_cast<std::size_t>(digits);
    if (text.size() < behind)
        text.insert(0, behind - text.size(), '0');
    std::string fraction = text.substr(text.size() - behind);
    fraction.erase(fraction.find_last_not_of('0') + 1);
    std::string number = text.substr(0, text.size() - behind);
    if (number == "0")
        number.clear();
    if (!fraction.empty())
        number.append(".").append(fraction);
    if (number.empty())
        return "0";
    return units < 0 ? "-" + number : number;
}

std::string decimal(double number, int digits) {
    double units = number;
    for (int i = 0; i < digits; ++i)
        units *= 10;
    return decimal(rounded(units), digits);
}

std::string svg_path_data(std::span<const SnappedPath> paths, int digits) {
    SvgPathWriter writer(digits);
    for (const SnappedPath& path : paths)
        writer.write(path);
    return writer.take();
}

} // namespace vera::detail
