// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/seams.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace vera::detail {
namespace {

const Lattice lattice(1);

std::vector<SnappedPath>
lines_of(const FilledOutline& fill, double width, const PassedPoints& passed = {}) {
    std::vector<SnappedPath> seams = joined_seams(fill, lattice);
    draw_ends_back(seams, snapped_rings(fill, lattice), passed, width);
    return seams;
}

TEST(JoinedSeams, AreOneWhereSeamsFollowUponOneAnother) {
    const FilledOutline open = {
        .seams = {{{2, 0}, {3, 0}}, {{3, 0}, {4, 1}}, {{6, 6}, {7, 7}}, {{0, 0}, {2, 0}}}};
    const std::vector<SnappedPath> paths = joined_seams(open, lattice);
    ASSERT_EQ(paths.size(), 2U);
    EXPECT_EQ(paths[0].points, (std::vector<SnappedPoint>{{6, 6}, {7, 7}}));
    EXPECT_EQ(paths[1].points, (std::vector<SnappedPoint>{{0, 0}, {2, 0}, {3, 0}, {4, 1}}));
    EXPECT_FALSE(paths[1].closed);
}

TEST(JoinedSeams, AreClosedRoundAWholeRing) {
    const FilledOutline round = {
        .rings = {{{0, 0}, {3, 0}, {0, 4}}},
        .seams = {{{0, 0}, {3, 0}}, {{3, 0}, {0, 4}}, {{0, 4}, {0.2, 0.1}}}};
    const std::vector<SnappedPath> ring = lines_of(round, 2);
    ASSERT_EQ(ring.size(), 1U);
    EXPECT_EQ(ring[0].points, (std::vector<SnappedPoint>{{0, 0}, {3, 0}, {0, 4}}));
    EXPECT_TRUE(ring[0].closed);
}

/// The line of a seam from (0, 100) to (0, 0), where the border goes on in a direction.
std::vector<SnappedPath> line_to(double x, double y, const PassedPoints& passed = {}) {
    const FilledOutline fill = {
        .rings = {{{0, 0}, {x, y}, {200, 300}, {200, 100}, {0, 100}}},
        .seams = {{{0, 100}, {0, 0}}}};
    return lines_of(fill, 20, passed);
}

TEST(DrawEndsBack, ShortensSeamsThatWouldStickOut) {
    const std::pair<DrawingPoint, std::int64_t> ends[] = {
        {{50, 0}, 0},   // square: the cap lies on the border
        {{50, 25}, 5},  // the corner on this side would stick out
        {{50, -25}, 5}, // and that on the other, if the border goes straight on
        {{50, 50}, 10},
        {{10, 50}, 10}, // never more than half the width
        {{0, -50}, 10}};
    for (const auto& [direction, back] : ends) {
        const std::vector<SnappedPath> lines = line_to(direction.x, direction.y);
        ASSERT_EQ(lines.size(), 1U);
        EXPECT_EQ(lines[0].points, (std::vector<SnappedPoint>{{0, 100}, {0, back}}))
            << direction.x << ' ' << direction.y;
    }
}

TEST(DrawEndsBack, GoesByTheTangentWhereTheBorderGoesOnInAnArc) {
    const DrawingEllipse circle = {{0, 50}, {50, 0}, {0, 50}};
    FilledOutline fill = {
        .rings = {{{0, 0}, {50, 50}, {200, 300}, {200, 100}, {0, 100}}},
        .arcs = {{{0, circle, -90, 0}}},
        .seams = {{{0, 100}, {0, 0}}}};
    EXPECT_EQ(lines_of(fill, 20)[0].points.back(), (SnappedPoint{0, 0})); // square
    std::reverse(fill.rings[0].begin(), fill.rings[0].end());
    fill.arcs = {{{3, circle, 0, -90}}};
    EXPECT_EQ(lines_of(fill, 20)[0].points.back(), (SnappedPoint{0, 0}));
    fill.arcs.clear();
    EXPECT_EQ(lines_of(fill, 20)[0].points.back(), (SnappedPoint{0, 10}));
}

TEST(DrawEndsBack, TakesLessOffWhereAnotherSeamPasses) {
    PassedPoints passed;
    passed.add(std::vector<SnappedPath>{{{{-9, 0}, {0, 0}, {9, 0}}, false}});
    EXPECT_EQ(line_to(50, 40, passed)[0].points.back(), (SnappedPoint{0, 5}));
    EXPECT_EQ(line_to(50, 10, passed)[0].points.back(), (SnappedPoint{0, 2}));
    EXPECT_FALSE(passed.contains({9, 0}));
    passed.add(std::vector<SnappedPath>{{{{9, 0}, {1, 1}, {5, 5}}, true}});
    EXPECT_TRUE(passed.contains({9, 0}));
}

TEST(DrawEndsBack, LeavesOutWhatIsShorterThanWhatIsTakenOff) {
    const FilledOutline slanted = {
        .rings = {{{0, 0}, {10, 3}, {10, 6}}}, .seams = {{{0, 0}, {10, 3}}}};
    EXPECT_EQ(lines_of(slanted, 4).size(), 1U);
    EXPECT_EQ(lines_of(slanted, 40).size(), 0U);
}

} // namespace
} // namespace vera::detail
