// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/snapped_path.h"

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

} // namespace
} // namespace vera::detail
