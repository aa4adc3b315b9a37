// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/wide_integer.h"
#include "vera/solids/triangle_relation.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

// The reference: triangles of small whole coordinates, and fractions.

struct Whole {
    std::int64_t x, y, z;
};

struct WholeTriangle {
    std::array<Whole, 3> corners;
};

Whole operator-(Whole a, Whole b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

Whole cross(Whole a, Whole b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

std::int64_t dot(Whole a, Whole b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Whole normal(const WholeTriangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    return cross(b - a, c - a);
}

struct Fraction {
    std::int64_t above, below; // below > 0

    friend bool operator<(Fraction a, Fraction b) {
        return Int128{a.above} * b.below < Int128{b.above} * a.below;
    }
};

/// Where the plane cuts the triangle, along a direction.
std::vector<Fraction> cuts(const WholeTriangle& triangle, const WholeTriangle& plane, Whole along) {
    std::vector<Fraction> cuts;
    const Whole n = normal(plane);
    for (std::size_t i = 0; i < 3; ++i) {
        const Whole a = triangle.corners[i];
        const Whole b = triangle.corners[(i + 1) % 3];
        const std::int64_t at_a = dot(n, a - plane.corners[0]);
        const std::int64_t at_b = dot(n, b - plane.corners[0]);
        if (at_a == 0)
            cuts.push_back({dot(along, a), 1});
        if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0)) {
            // a + at_a / (at_a - at_b) (b - a)
            const std::int64_t below = at_a - at_b;
            const std::int64_t above = dot(along, a) * below + at_a * dot(along, b - a);
            cuts.push_back(below > 0 ? Fraction{above, below} : Fraction{-above, -below});
        }
    }
    return cuts;
}

bool goes_through(const WholeTriangle& triangle, const WholeTriangle& plane) {
    bool above = false;
    bool below = false;
    for (const Whole corner : triangle.corners) {
        const std::int64_t at = dot(normal(plane), corner - plane.corners[0]);
        above = above || at > 0;
        below = below || at < 0;
    }
    return above && below;
}

/// Of triangles in one plane, by clipping one by the other's sides. In doubles: of such small
/// numbers, an area is either none or far above what rounding makes.
bool have_an_area_in_common(const WholeTriangle& a, const WholeTriangle& b) {
    struct Point {
        double x, y, z;
    };

    std::vector<Point> ring;
    for (const Whole c : b.corners)
        ring.push_back({double(c.x), double(c.y), double(c.z)});
    const Whole n = normal(a);
    for (std::size_t i = 0; i < 3; ++i) {
        const Whole inward = cross(n, a.corners[(i + 1) % 3] - a.corners[i]);
        const auto within = [&](Point p) {
            return double(inward.x) * (p.x - double(a.corners[i].x))
                + double(inward.y) * (p.y - double(a.corners[i].y))
                + double(inward.z) * (p.z - double(a.corners[i].z));
        };
        std::vector<Point> kept;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            const Point p = ring[k];
            const Point q = ring[(k + 1) % ring.size()];
            if (within(p) >= 0)
                kept.push_back(p);
            if ((within(p) > 0 && within(q) < 0) || (within(p) < 0 && within(q) > 0)) {
                const double t = within(p) / (within(p) - within(q));
                kept.push_back(
                    {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)});
            }
        }
        ring = kept;
    }
    double area = 0;
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
        const Vec3 u = {ring[k].x - ring[0].x, ring[k].y - ring[0].y, ring[k].z - ring[0].z};
        const Vec3 v = {
            ring[k + 1].x - ring[0].x, ring[k + 1].y - ring[0].y, ring[k + 1].z - ring[0].z};
        area += length(vera::cross(u, v));
    }
    return area > 1e-9;
}

TriangleRelation expected(const WholeTriangle& a, const WholeTriangle& b) {
    const Whole along = cross(normal(a), normal(b));
    if (along.x == 0 && along.y == 0 && along.z == 0) {
        const Whole n = normal(a);
        const bool are_in_one_plane = dot(n, b.corners[0] - a.corners[0]) == 0 && dot(n, n) > 0
            && dot(normal(b), normal(b)) > 0;
        return are_in_one_plane && have_an_area_in_common(a, b) ? TriangleRelation::covering
                                                                : TriangleRelation::apart;
    }
    if (!goes_through(a, b) || !goes_through(b, a))
        return TriangleRelation::apart;
    const auto of_a = cuts(a, b, along);
    const auto of_b = cuts(b, a, along);
    const auto [first_a, last_a] = std::minmax_element(of_a.begin(), of_a.end());
    const auto [first_b, last_b] = std::minmax_element(of_b.begin(), of_b.end());
    const bool overlap = *first_a < *last_b && *first_b < *last_a;
    return overlap ? TriangleRelation::crossing : TriangleRelation::apart;
}

TriangleCorners as_doubles(const WholeTriangle& triangle, double unit) {
    TriangleCorners corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const Whole& c = triangle.corners[i];
        corners[i] = {unit * double(c.x), unit * double(c.y), unit * double(c.z)};
    }
    return corners;
}

TEST(TriangleRelation, IsThatOfFractionsOnSmallWholeNumbers) {
    std::mt19937 random(1988);
    std::array<int, 3> counts = {};
    for (int round = 0; round < 60000; ++round) {
        const int flat = round % 4 == 0 ? 1 : 5; // many in one plane
        WholeTriangle triangles[2];
        for (WholeTriangle& triangle : triangles)
            for (Whole& corner : triangle.corners)
                corner = {
                    static_cast<int>(random() % 5) - 2,
                    static_cast<int>(random() % 5) - 2,
                    static_cast<int>(random() % static_cast<unsigned>(flat)) - 2};
        const TriangleRelation wanted = expected(triangles[0], triangles[1]);
        ++counts[static_cast<std::size_t>(wanted)];
        const double unit = round % 3 == 0 ? 0x1p-500 : 3;
        const TriangleCorners a = as_doubles(triangles[0], unit);
        const TriangleCorners b = as_doubles(triangles[1], unit);
        ASSERT_EQ(relation(a, b), wanted) << "round " << round;
        ASSERT_EQ(relation(b, a), wanted) << "round " << round;
        ASSERT_EQ(relation({a[2], a[0], a[1]}, {b[1], b[0], b[2]}), wanted) << "round " << round;
    }
    EXPECT_GT(counts[0], 10000);
    EXPECT_GT(counts[1], 5000);
    EXPECT_GT(counts[2], 1000);
}

TEST(TriangleRelation, OfFacesThatTouchIsApart) {
    const TriangleCorners floor = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    EXPECT_EQ(relation(floor, {{{1, 1, 0}, {2, 1, 0}, {1, 1, 5}}}), TriangleRelation::apart);
    EXPECT_EQ(relation(floor, {{{1, 1, 0}, {2, 1, 1}, {1, 2, 5}}}), TriangleRelation::apart);
    EXPECT_EQ(
        relation(floor, {{{1, 1, -1e-300}, {2, 1, 1}, {1, 2, 5}}}), TriangleRelation::crossing);
    EXPECT_EQ(relation(floor, {{{0, 0, 0}, {4, 0, 0}, {0, -4, 0}}}), TriangleRelation::apart);
    EXPECT_EQ(relation(floor, {{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}}}), TriangleRelation::covering);
}

} // namespace
} // namespace vera
