// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/elliptic_arc.h"
#include "vera/drawing/snapped_path.h"
#include "vera/drawing/svg_path.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace vera::detail {
namespace {

/// The points of path data of m, l, h, v and z, read as the SVG grammar has it: a number ends where
/// it cannot go on.
class PathData {
public:
    explicit PathData(std::string text)
        : text_(std::move(text)) {}

    std::vector<std::vector<DrawingPoint>> points() {
        std::vector<std::vector<DrawingPoint>> paths;
        DrawingPoint at;
        char command = '\0';
        while (position_ < text_.size()) {
            if (std::isalpha(text_[position_]))
                command = text_[position_++];
            if (command == 'z') {
                at = paths.back().front();
                continue;
            }
            if (command != 'v')
                at.x += number();
            if (command != 'h')
                at.y += number();
            if (command == 'm')
                paths.emplace_back();
            paths.back().push_back(at);
            command = command == 'm' ? 'l' : command;
        }
        return paths;
    }

private:
    double number() {
        std::string digits;
        bool point = false;
        position_ += text_[position_] == ' ';
        for (; position_ < text_.size(); ++position_) {
            const char letter = text_[position_];
            if (!(std::isdigit(letter) || (letter == '-' && digits.empty())
                  || (letter == '.' && !point)))
                break;
            point = point || letter == '.';
            digits += letter;
        }
        return std::stod(digits);
    }

    std::string text_;
    std::size_t position_ = 0;
};

TEST(SnappedPath, NumbersAreRoundedAsTheLibraryDoes) {
    std::mt19937_64 numbers(1);
    for (int i = 0; i < 20'000; ++i) {
        // Near halves of numbers of every length.
        const double whole = static_cast<double>(numbers() >> 14U >> numbers() % 50);
        double number = std::min(whole, 9e14) + 0.25 * static_cast<double>(numbers() % 4);
        number = i % 2 == 0 ? number : std::nextafter(number, i % 4 == 1 ? 0.0 : 1e15);
        for (const double signed_number : {number, -number})
            EXPECT_EQ(rounded(signed_number), std::llround(signed_number)) << signed_number;
    }
    EXPECT_EQ(rounded(0x1.fffffffffffffp-2), 0) << "the sum with a half would be rounded up";
}

TEST(Lattice, IsOfTheCoarsestPowerOfATenthThatIsFineEnough) {
    for (int digits = 0; digits <= 6; ++digits) {
        EXPECT_EQ(Lattice(std::stod("1e-" + std::to_string(digits))).digits(), digits);
        EXPECT_EQ(Lattice(std::stod("9e-" + std::to_string(digits))).digits(), digits);
    }
    EXPECT_EQ(Lattice(0.0999).digits(), 2);
    EXPECT_EQ(Lattice(5).digits(), 0);
    EXPECT_EQ(Lattice(1e-30).digits(), 6);
    EXPECT_EQ(Lattice(0.01).snapped({1.2349, -0.005}), (SnappedPoint{123, -1}));
}

TEST(LatticeDeathTest, HoldsNoPointThatIsNotFinite) {
    const Lattice lattice(0.01);
    for (const double wrong :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300})
        EXPECT_DEATH(lattice.snapped({0, wrong}), "most_units");
    EXPECT_DEATH(Lattice(0), "precision > 0");
}

TEST(Decimal, HasNothingThatCanBeLeftOut) {
    EXPECT_EQ(decimal(std::int64_t{0}, 2), "0");
    EXPECT_EQ(decimal(std::int64_t{-50}, 2), "-.5");
    EXPECT_EQ(decimal(std::int64_t{5}, 2), ".05");
    EXPECT_EQ(decimal(std::int64_t{1200}, 2), "12");
    EXPECT_EQ(decimal(std::int64_t{-12345}, 2), "-123.45");
    EXPECT_EQ(decimal(std::int64_t{700}, 0), "700");
    EXPECT_EQ(decimal(-0.00001, 4), "0");
    EXPECT_EQ(decimal(0.75, 4), ".75");
}

/// All digits, of which those at the ends that are zeros are taken off.
std::string plain_decimal(std::int64_t units, int digits) {
    std::string text = std::to_string(std::abs(units));
    const auto places = static_cast<std::size_t>(digits);
    if (text.size() < places)
        text.insert(0, places - text.size(), '0');
    std::string whole = text.substr(0, text.size() - places);
    std::string fraction = text.substr(text.size() - places);
    whole.erase(0, whole.find_first_not_of('0'));
    fraction.erase(fraction.find_last_not_of('0') + 1);
    if (whole.empty() && fraction.empty())
        return "0";
    return (units < 0 ? "-" : "") + whole + (fraction.empty() ? "" : "." + fraction);
}

TEST(Decimal, IsThatOfAllDigitsWithoutTheZerosAtItsEnds) {
    std::mt19937_64 random(3);
    for (int round = 0; round < 20'000; ++round) {
        const int digits = static_cast<int>(random() % 13);
        const auto shift = static_cast<unsigned>(1 + random() % 63);
        const std::uint64_t size = random() >> shift;
        const std::uint64_t step = random() % 4 == 0 ? 1'000'000 : 1; // many end in zeros
        const auto units = static_cast<std::int64_t>(size / step * step);
        ASSERT_EQ(decimal(units, digits), plain_decimal(units, digits));
        ASSERT_EQ(decimal(-units, digits), plain_decimal(-units, digits));
    }
}

TEST(SvgPathData, IsAsShortAsTheGrammarAllows) {
    EXPECT_EQ(
        svg_path_data(std::vector<SnappedPath>{{{{100, 50}, {150, 25}, {225, 100}}, false}}, 2),
        "m1 .5.5-.25.75.75");
    EXPECT_EQ(
        svg_path_data(
            std::vector<SnappedPath>{
                {{{0, 0}, {2, 0}, {3, 0}, {3, 5}, {1, 4}}, true}, {{{1, 1}, {2, 2}, {1, 3}}, true}},
            0),
        "m0 0h2 1v5l-2-1zm1 1 1 1-1 1z");
}

TEST(SvgPathData, DoesNotLetRoundingAddUp) {
    std::mt19937 random(1988);
    const double values[] = {0, 0.004, 0.005, 1 / 3.0, 0.5, -0.5, 1, 99.994, 99.996, -1234.5678};
    for (int round = 0; round < 2000; ++round) {
        FilledOutline fill;
        fill.rings.resize(1 + random() % 3);
        for (auto& ring : fill.rings)
            for (std::size_t i = random() % 9; i > 0; --i)
                ring.push_back({values[random() % 10], values[random() % 10]});

        const Lattice lattice(round % 2 == 0 ? 0.01 : 0.1);
        const std::vector<SnappedPath> rings = snapped_rings(fill, lattice);
        const auto points = PathData(svg_path_data(rings, lattice.digits())).points();
        ASSERT_EQ(points.size(), rings.size());
        for (std::size_t r = 0; r < rings.size(); ++r) {
            ASSERT_EQ(points[r].size(), rings[r].points.size());
            for (std::size_t i = 0; i < points[r].size(); ++i)
                ASSERT_EQ(lattice.snapped(points[r][i]), rings[r].points[i]) << "round " << round;
        }
    }
}

TEST(SnappedRings, LeaveOutWhatRoundingMakesEqual) {
    const Lattice lattice(1);
    const FilledOutline fill = {
        .rings = {
            {{0, 0}, {0.2, 0.3}, {5, 0}, {5, 5}, {5.1, 5.2}, {0.4, 0}, {0, 0}},
            {{0, 0}, {5, 5}, {0.1, 0.1}},
            {{7, 7}},
            {}}};
    const std::vector<SnappedPath> rings = snapped_rings(fill, lattice);
    ASSERT_EQ(rings.size(), 1U);
    EXPECT_EQ(rings[0].points, (std::vector<SnappedPoint>{{0, 0}, {5, 0}, {5, 5}}));
    EXPECT_TRUE(rings[0].closed);
}

TEST(SnappedLine, NeedsTwoPoints) {
    const Lattice lattice(1);
    EXPECT_FALSE(snapped_line({.points = {}}, lattice));
    EXPECT_FALSE(snapped_line({.points = {{1, 1}, {1.2, 1.2}}, .closed = true}, lattice));
    EXPECT_FALSE(
        snapped_line({.points = {{1, 1}, {9, 1}, {1, 1}}, .closed = true}, lattice)->closed);
    EXPECT_EQ(snapped_line({.points = {{1, 1}, {9, 1}, {1, 1}}}, lattice)->points.size(), 3U);
}

TEST(SnappedLine, KeepsArcsWithTheirPointsWhateverRoundingMakesEqual) {
    const Lattice lattice(1);
    const DrawingEllipse circle = {{10, 10}, {5, 0}, {0, 5}};
    // The first segment vanishes, the arc behind it stays, and a small one goes.
    const auto line = snapped_line(
        {.points = {{14.9, 10.1}, {15, 10}, {10, 15}, {9.9, 15}, {0, 15}},
         .arcs = {{1, circle, 0, 90}, {2, circle, 90, 91}}},
        lattice);
    ASSERT_TRUE(line);
    EXPECT_EQ(line->points, (std::vector<SnappedPoint>{{15, 10}, {10, 15}, {0, 15}}));
    ASSERT_EQ(line->arcs.size(), 1U);
    EXPECT_EQ(line->arcs[0].segment, 0U);

    // Whole ones, closed or but for a gap that is less than the precision.
    for (const bool closed : {true, false}) {
        const auto whole = snapped_line(
            {.points = closed ? std::vector<DrawingPoint>{{15, 10}}
                              : std::vector<DrawingPoint>{{15, 10}, {15, 9.9}},
             .closed = closed,
             .arcs = {{0, circle, 0, closed ? 360.0 : 359.0}}},
            lattice);
        ASSERT_TRUE(whole) << closed;
        EXPECT_EQ(whole->arcs.size(), 1U) << closed;
    }
    EXPECT_FALSE(
        snapped_line({.points = {{15, 10}, {15, 10.1}}, .arcs = {{0, circle, 0, 1}}}, lattice));
    // Of a slice, the point that rounding makes equal to the first one goes, with the arc to it.
    const auto slice = snapped_line(
        {.points = {{10, 10}, {15, 10}, {10, 15}, {10.1, 10}},
         .closed = true,
         .arcs = {{1, circle, 0, 90}}},
        lattice);
    ASSERT_TRUE(slice);
    EXPECT_EQ(slice->points, (std::vector<SnappedPoint>{{10, 10}, {15, 10}, {10, 15}}));
    EXPECT_TRUE(slice->closed);
}

/// The parts of one path of arcs alone, as the SVG grammar has them.
struct SvgArc {
    double rx = 0;
    double ry = 0;
    double turn = 0;
    double large = 0;
    double sweep = 0;
    DrawingPoint from;
    DrawingPoint to;
};

std::vector<double> numbers_of(const std::string& text) {
    std::vector<double> numbers;
    std::string digits;
    for (const char letter : text + ' ') {
        const bool goes_on = std::isdigit(letter) || (letter == '-' && digits.empty())
            || (letter == '.' && digits.find('.') == std::string::npos);
        if (!goes_on && !digits.empty()) {
            numbers.push_back(std::stod(digits));
            digits.clear();
        }
        if (std::isdigit(letter) || letter == '-' || letter == '.')
            digits += letter;
    }
    return numbers;
}

std::vector<SvgArc> svg_arcs(const std::string& text) {
    const std::vector<double> numbers = numbers_of(text);
    std::vector<SvgArc> arcs;
    DrawingPoint at = {numbers[0], numbers[1]};
    for (std::size_t i = 2; i + 6 < numbers.size(); i += 7) {
        const DrawingPoint to = {at.x + numbers[i + 5], at.y + numbers[i + 6]};
        arcs.push_back(
            {numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3], numbers[i + 4], at, to});
        at = to;
    }
    return arcs;
}

/// The middle of an arc by its ends (Scalable Vector Graphics 1.1, F.6.5).
DrawingPoint middle_of(const SvgArc& arc) {
    const double turn = arc.turn * 3.14159265358979 / 180;
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    const double dx = (arc.from.x - arc.to.x) / 2;
    const double dy = (arc.from.y - arc.to.y) / 2;
    // Where the ellipse is the unit circle.
    const double x = (c * dx + s * dy) / arc.rx;
    const double y = (c * dy - s * dx) / arc.ry;
    const double half = x * x + y * y; // of the chord, squared
    const double off = std::sqrt(std::max(0.0, 1 - half)) * (arc.large == arc.sweep ? -1 : 1);
    const double size = std::sqrt(half);
    const double center_x = off * y / size;
    const double center_y = -off * x / size;
    // From the middle of the chord, away from the center by a radius: these arcs are small.
    const double away = std::sqrt(center_x * center_x + center_y * center_y);
    const double mx = center_x - center_x / away;
    const double my = center_y - center_y / away;
    return {
        (arc.from.x + arc.to.x) / 2 + c * arc.rx * mx - s * arc.ry * my,
        (arc.from.y + arc.to.y) / 2 + s * arc.rx * mx + c * arc.ry * my};
}

TEST(SvgPathData, HasArcsThatLieOnTheirEllipse) {
    std::mt19937 random(1988);
    const double sizes[] = {3, 20, 20.001, 150};
    for (int round = 0; round < 2000; ++round) {
        const double a = sizes[random() % 4];
        const double b = std::max(a / 4, std::min(a, sizes[random() % 4])); // no flatter ones
        const double turn = 15 * static_cast<double>(random() % 24);
        const DrawingPoint to = {
            std::cos(turn * 3.14159265358979 / 180), std::sin(turn * 3.14159265358979 / 180)};
        const DrawingEllipse ellipse = {{50, 40}, {a * to.x, a * to.y}, {-b * to.y, b * to.x}};
        const double sweep = (60 + static_cast<double>(random() % 301)) * (round % 2 * 2 - 1);
        const DrawingArc arc = {0, ellipse, turn / 2, turn / 2 + sweep};
        const Lattice lattice(0.01);
        const auto line = snapped_line(
            {.points = {point_at(ellipse, arc.begin_degrees), point_at(ellipse, arc.end_degrees)},
             .arcs = {arc}},
            lattice);
        ASSERT_TRUE(line);
        const auto arcs = svg_arcs(svg_path_data({&*line, 1}, 2));
        const auto count = static_cast<std::size_t>(std::ceil(std::abs(sweep) / 90));
        ASSERT_EQ(arcs.size(), count) << round;
        for (std::size_t i = 0; i < count; ++i) {
            const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
            // Rounding moves each end, and the center by as much again; along ellipses that are
            // longer than wide by more.
            const DrawingPoint middle = middle_of(arcs[i]);
            const double off =
                distance(middle, point_at(ellipse, nearest_degrees(ellipse, middle)));
            EXPECT_LE(off, 0.02 + 0.003 * a / b) << round << ' ' << i;
            const DrawingPoint expected = point_at(ellipse, arc.begin_degrees + at * sweep);
            EXPECT_LE(distance(middle, expected), 0.05 + 0.02 * a / b) << round << ' ' << i;
            EXPECT_EQ(arcs[i].sweep, sweep > 0 ? 1 : 0);
            EXPECT_EQ(arcs[i].large, 0);
        }
    }
}

/// A point of the Bezier curve with these control points, after one of lower degree.
DrawingPoint point_of_curve(std::vector<DrawingPoint> controls, double part) {
    while (controls.size() > 1) {
        for (std::size_t i = 0; i + 1 < controls.size(); ++i)
            controls[i] = {
                controls[i].x + part * (controls[i + 1].x - controls[i].x),
                controls[i].y + part * (controls[i + 1].y - controls[i].y)};
        controls.pop_back();
    }
    return controls.front();
}

TEST(SvgPathData, HasCurvesForShortAndForFlatArcs) {
    std::mt19937 random(1989);
    const double sizes[] = {0.02, 0.5, 3, 20, 150};
    int short_ones = 0;
    for (int round = 0; round < 2000; ++round) {
        const double a = sizes[1 + random() % 4];
        const bool is_short = round % 2 == 0;
        const double b = is_short ? std::min(a, sizes[random() % 5]) : a / 5;
        const double turn = 15 * static_cast<double>(random() % 24);
        const DrawingPoint to = {
            std::cos(turn * 3.14159265358979 / 180), std::sin(turn * 3.14159265358979 / 180)};
        const DrawingEllipse ellipse = {{50, 40}, {a * to.x, a * to.y}, {-b * to.y, b * to.x}};
        const double sweep = (is_short ? 1 + static_cast<double>(random() % 14)
                                       : 20 + static_cast<double>(random() % 341))
            * (random() % 2 == 0 ? 1 : -1);
        const auto begin = static_cast<double>(random() % 360);
        const DrawingArc arc = {0, ellipse, begin, begin + sweep};
        const auto line = snapped_line(
            {.points = {point_at(ellipse, begin), point_at(ellipse, begin + sweep)}, .arcs = {arc}},
            Lattice(0.01));
        if (!line)
            continue;
        const std::string text = svg_path_data({&*line, 1}, 2);
        ASSERT_EQ(text.find('a'), std::string::npos) << text;
        const bool is_quadratic = text.find('q') != std::string::npos;
        short_ones += is_quadratic ? 1 : 0;
        const std::size_t degree = is_quadratic ? 2 : 3;
        const std::vector<double> numbers = numbers_of(text);
        DrawingPoint at = {numbers[0], numbers[1]};
        for (std::size_t i = 2; i < numbers.size(); i += 2 * degree) {
            std::vector<DrawingPoint> controls = {at};
            for (std::size_t j = 0; j < degree; ++j)
                controls.push_back({at.x + numbers[i + 2 * j], at.y + numbers[i + 2 * j + 1]});
            for (const double part : {0.2, 0.5, 0.7}) {
                const DrawingPoint on = point_of_curve(controls, part);
                // Half a unit, and what rounding does to ends and control points.
                EXPECT_LE(distance(on, point_at(ellipse, nearest_degrees(ellipse, on))), 0.0125)
                    << round << ' ' << text;
            }
            at = controls.back();
        }
        EXPECT_LE(distance(at, point_at(ellipse, begin + sweep)), 0.0072) << round;
    }
    EXPECT_GT(short_ones, 500);
}

TEST(SnappedRings, KeepArcsThatAreNotStraight) {
    const DrawingEllipse circle = {{10, 10}, {5, 0}, {0, 5}};
    FilledOutline slice;
    slice.rings = {{{10, 10}, {15, 10}, {10, 15}}, {{20, 0}, {21, 0}, {20, 1}}, {{15, 10}}};
    slice.arcs = {{{1, circle, 0, 90}}, {}, {{0, circle, 0, 360}}};
    const auto rings = snapped_rings(slice, Lattice(0.01));
    ASSERT_EQ(rings.size(), 3U);
    EXPECT_EQ(rings[0].arcs.size(), 1U);
    EXPECT_EQ(rings[1].arcs.size(), 0U);
    EXPECT_EQ(rings[2].points.size(), 1U);
    EXPECT_EQ(
        svg_path_data(rings, 0),
        "m1000 1000h500a500 500 0 0 1-500 500z"
        "m1000-1000h100l-100 100zm-500 1000"
        "a500 500 0 0 1-500 500 500 500 0 0 1-500-500 500 500 0 0 1 500-500 500 500 0 0 1 500 "
        "500z");
    // One that is off its chord by less than half a unit.
    const DrawingPoint end = point_at(circle, 4);
    slice.rings = {{{10, 10}, {15, 10}, end}};
    slice.arcs = {{{1, circle, 0, 4}}};
    EXPECT_EQ(snapped_rings(slice, Lattice(0.01)).at(0).arcs.size(), 0U);
    EXPECT_EQ(snapped_rings(slice, Lattice(0.001)).at(0).arcs.size(), 1U);
}

TEST(SvgPathData, WritesAnArcBetweenLines) {
    const DrawingEllipse ellipse = {{10, 10}, {0, 5}, {-2, 0}};
    const auto line = snapped_line(
        {.points = {{0, 15}, {10, 15}, {8, 10}, {0, 10}},
         .closed = true,
         .arcs = {{1, ellipse, 0, 90}}},
        Lattice(0.1));
    EXPECT_EQ(svg_path_data({&*line, 1}, 1), "m0 15h10a5 2 90 0 1-2-5h-8z");
}

} // namespace
} // namespace vera::detail
