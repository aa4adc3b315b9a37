// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/wide_integer.h"
#include "vera/theory/ham_sandwich.h"
#include "vera/theory/plane_points.h"

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace vera {
namespace {

using Points = std::span<const PlanePoint>;

struct Sides {
    std::size_t right = 0;
    std::size_t left = 0;
};

/// How many points lie strictly on either side of a line.
Sides sides(Points points, PlaneDirection direction, std::int64_t at) {
    Sides found;
    for (const PlanePoint point : points) {
        found.right += offset(direction, point) < at ? 1 : 0;
        found.left += offset(direction, point) > at ? 1 : 0;
    }
    return found;
}

bool halves(Points points, PlaneDirection direction, std::int64_t at) {
    const Sides found = sides(points, direction, at);
    return std::max(found.right, found.left) <= points.size() / 2;
}

/// Whether some line along the direction halves both: one through a point of the first, then.
bool halves_both(Points lower, Points upper, PlaneDirection direction) {
    return std::any_of(lower.begin(), lower.end(), [&](PlanePoint point) {
        const std::int64_t at = offset(direction, point);
        return halves(lower, direction, at) && halves(upper, direction, at);
    });
}

/// Points sorted across a direction, which is any that leads from one of them to another.
struct Halves {
    PlanePoints points;
    PlaneDirection line;

    std::size_t middle() const { return points.size() / 2; }

    Points lower() const { return Points(points).first(middle()); }

    Points upper() const { return Points(points).subspan(middle()); }
};

Halves random_halves(const PointFamily& family, std::mt19937_64& random) {
    Halves made;
    made.points = family.points(2 + random() % 30, random);
    // Across a normal, and so in a third of the cases along the way between two of the points.
    const PlaneDirection normal = some_normal(made.points, random);
    made.line =
        normal == PlaneDirection{} ? PlaneDirection{1, 0} : PlaneDirection{normal.y, -normal.x};
    std::sort(made.points.begin(), made.points.end(), TurnedOrder{made.line});
    return made;
}

bool all_on_the_line(Points points, PlaneDirection line, std::int64_t at) {
    return std::all_of(
        points.begin(), points.end(), [&](PlanePoint point) { return offset(line, point) == at; });
}

TEST(HamSandwichCut, HalvesBothSetsExactly) {
    std::mt19937_64 random(1986);
    std::map<std::string, int> own_lines;
    for (const PointFamily& family : point_families())
        for (std::uint64_t round = 0; round < 3000; ++round) {
            const Halves made = random_halves(family, random);
            const PlaneDirection found =
                conjugate_direction(made.lower(), made.upper(), made.line, round);
            if (found != made.line) {
                ASSERT_TRUE(halves_both(made.lower(), made.upper(), found)) << family.name;
                // To the left of the line: it turns by less than half a turn.
                ASSERT_GT(Int128{made.line.x} * found.y - Int128{made.line.y} * found.x, 0);
                continue;
            }
            ++own_lines[family.name];
            const Points left_of_lower = made.lower().subspan(made.lower().size() / 2);
            const Points right_of_upper = made.upper().first(made.upper().size() / 2);
            const std::int64_t at = offset(found, made.points[made.middle()]);
            ASSERT_TRUE(all_on_the_line(left_of_lower, found, at)) << family.name;
            ASSERT_TRUE(all_on_the_line(right_of_upper, found, at)) << family.name;
        }
    EXPECT_GT(own_lines["collinear"], 500);
    EXPECT_GT(own_lines["repeated"], 50);
}

TEST(HamSandwichCut, IsTheLineItselfOnlyWhereTheMediansMeetNowhereElse) {
    std::mt19937_64 random(3);
    int without = 0;
    for (const PointFamily& family : point_families())
        for (std::uint64_t round = 0; round < 300; ++round) {
            const Halves made = random_halves(family, random);
            const PlanePoint last = made.points[made.middle() - 1];
            const PlanePoint next = made.points[made.middle()];
            if (last == next)
                continue; // any line through it may halve both
            bool exists = false;
            for (const PlanePoint from : made.lower())
                for (const PlanePoint to : made.upper())
                    exists = exists
                        || (offset(made.line, from) < offset(made.line, to)
                            && halves_both(
                                made.lower(), made.upper(), direction_between(from, to)));
            const PlaneDirection found =
                conjugate_direction(made.lower(), made.upper(), made.line, round);
            without += exists ? 0 : 1;
            if (!exists) {
                ASSERT_EQ(found, made.line) << family.name;
            }
        }
    EXPECT_GT(without, 50);
}

TEST(HamSandwichCut, IsFoundOfManyPoints) {
    std::mt19937_64 random(4);
    for (const PointFamily& family : point_families()) {
        Halves made;
        made.points = family.points(5000, random);
        made.line = {1, 0};
        std::sort(made.points.begin(), made.points.end(), TurnedOrder{made.line});
        const PlaneDirection found = conjugate_direction(made.lower(), made.upper(), made.line);
        if (found != made.line) {
            EXPECT_TRUE(halves_both(made.lower(), made.upper(), found)) << family.name;
        }
    }
}

} // namespace
} // namespace vera
