// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/svg_path.h"

#include "vera/drawing/elliptic_arc.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vera::detail {

namespace {

/// The center of an arc of an SVG is found from its ends. Rounding these moves the far ends of flat
/// ellipses by as many times as much as they are longer than wide.
constexpr double flattest_arc = 4;

} // namespace

void SvgPathWriter::write(const SnappedPath& path) {
    begin_path(path.points.front());
    for_each_segment(
        path,
        [&](SnappedPoint point) { write_line_to(point); },
        [&](const DrawingArc& arc, SnappedPoint point) { write_arc_to(arc, point); });
    implied_ = '\0';
    if (path.closed)
        end_path();
}

void SvgPathWriter::write_ring(std::span<const SnappedPoint> points) {
    begin_path(points.front());
    for (const SnappedPoint point : points.subspan(1))
        write_line_to(point);
    implied_ = '\0';
    end_path();
}

void SvgPathWriter::begin_path(SnappedPoint point) {
    // An m at the very beginning counts from (0, 0). Numbers behind it are lines, relative too.
    begin('m');
    write_point(point);
    implied_ = 'l';
    at_ = start_ = point;
}

void SvgPathWriter::end_path() {
    text_ += 'z';
    at_ = start_; // where z leads back to
}

void SvgPathWriter::write_line_to(SnappedPoint point) {
    if (point.y == at_.y) {
        begin('h');
        write(point.x - at_.x);
    } else if (point.x == at_.x) {
        begin('v');
        write(point.y - at_.y);
    } else {
        begin('l');
        write_point(point);
    }
    at_ = point;
}

/// A short one as a curve, which takes fewer bytes, and a flat one too. Others in parts of 90
/// degrees at most: the center, which is found from the ends, is then off by no
/// more than these, and no part is the larger one of two.
void SvgPathWriter::write_arc_to(const DrawingArc& arc, SnappedPoint point) {
    constexpr int angle_digits = 4;
    const double sweep = arc.end_degrees - arc.begin_degrees;
    const double a = distance(arc.ellipse.major, {});
    const double b = distance(arc.ellipse.minor, {});
    if (quadratic_error(arc) <= most_off) {
        begin('q');
        write_point(rounded_point(quadratic_control(arc)));
        write_point(point);
        at_ = point;
        return;
    }
    if (a > flattest_arc * b) {
        write_curves_to(arc, point);
        return;
    }
    double turn = rounded(a) == rounded(b) ? 0 : direction_degrees(arc.ellipse.major);
    turn = turn > 90 + 1e-6 ? turn - 180 : turn < -90 + 1e-6 ? turn + 180 : turn;
    const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / 90 - 1e-9)));
    for (int i = 1; i <= parts; ++i) {
        const SnappedPoint to = i == parts
            ? point
            : rounded_point(point_at(arc.ellipse, arc.begin_degrees + sweep * i / parts));
        begin('a');
        write(rounded(a));
        write(rounded(b));
        write(rounded(turn, angle_digits), angle_digits);
        write(0, 0);
        write(sweep > 0 ? 1 : 0, 0);
        write_point(to);
        at_ = to;
    }
}

void SvgPathWriter::write_curves_to(const DrawingArc& arc, SnappedPoint point) {
    for (const SnappedCurve& curve : curves_along(arc, point)) {
        begin('c');
        for (const SnappedPoint to : {curve.first, curve.second, curve.end})
            write_point(to);
        at_ = curve.end;
    }
}

void SvgPathWriter::begin(char command) {
    if (command == implied_)
        return;
    text_ += command;
    implied_ = command;
    last_ = Last::command;
}

void SvgPathWriter::write_point(SnappedPoint point) {
    write(point.x - at_.x);
    write(point.y - at_.y);
}

void SvgPathWriter::write(std::int64_t units, int digits) {
    std::array<char, 1 + longest_decimal(most_digits)> number;
    char* const begin = number.data() + 1;
    char* const end = write_decimal(begin, units, digits);
    const bool ends_the_last =
        *begin == '-' || last_ == Last::command || (*begin == '.' && last_ == Last::fraction);
    number[0] = ' ';
    text_.append(ends_the_last ? begin : number.data(), end);
    last_ = std::find(begin, end, '.') == end ? Last::integer : Last::fraction;
}

std::string svg_path_data(std::span<const SnappedPath> paths, int digits) {
    std::string text;
    SvgPathWriter writer(text, digits);
    for (const SnappedPath& path : paths)
        writer.write(path);
    return text;
}

} // namespace vera::detail
