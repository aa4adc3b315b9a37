// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/faces.h"

#include "vera/math/box3.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace vera {

namespace {

double largest_coordinate(std::span<const Vec3> corners) {
    double largest = 0;
    for (const Vec3& corner : corners)
        largest = std::max(largest, max_component(abs(corner)));
    return largest;
}

/// Scaling by a power of two changes no decision here, and keeps products of coordinates within
/// range.
struct Scaled {
    std::vector<Vec3> corners;

    explicit Scaled(std::span<const Vec3> original) {
        int exponent = 0;
        std::frexp(largest_coordinate(original), &exponent);
        for (const Vec3& corner : original)
            corners.push_back(
                {std::ldexp(corner.x, -exponent),
                 std::ldexp(corner.y, -exponent),
                 std::ldexp(corner.z, -exponent)});
    }
};

/// Products of three such coordinates neither overflow nor lose bits below the range.
bool of_common_size(double largest) {
    return largest > 1e-50 && largest < 1e50;
}

/// What rounding coordinates of this size to 53 bits may make of a cross product of sides of that
/// length: each coordinate moves by 2^-53 of its size, each component of a side by twice that, and
/// a component of the product by four times that times the length.
double area_noise(double coordinate, double side) {
    return 0x1p-50 * coordinate * side;
}

std::optional<Vec3> normal_of_cross(Vec3 a, Vec3 b, double coordinate) {
    const Vec3 area = cross(a, b);
    const double side = std::max(max_component(abs(a)), max_component(abs(b)));
    if (!(max_component(abs(area)) > area_noise(coordinate, side)))
        return std::nullopt;
    return normalized(area);
}

} // namespace

std::optional<Vec3> triangle_normal(std::span<const Vec3, 3> corners) {
    const double largest = largest_coordinate(corners);
    if (!of_common_size(largest) && largest > 0) {
        const Scaled scaled(corners);
        return normal_of_cross(
            scaled.corners[1] - scaled.corners[0], scaled.corners[2] - scaled.corners[0], 1);
    }
    return normal_of_cross(corners[1] - corners[0], corners[2] - corners[0], largest);
}

namespace {

struct Point2 {
    double x = 0;
    double y = 0;

    friend bool operator==(const Point2&, const Point2&) = default;
};

/// On which side of the line from a to b the point c lies: 1 to the left, -1 to the right, 0 where
/// rounding leaves it open.
int side_of(Point2 a, Point2 b, Point2 c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double determinant = left - right;
    // Rounding can have moved it by at most this much (Shewchuk 1997, section 4.1).
    constexpr double epsilon = 0x1p-53;
    const double bound = (3 + 16 * epsilon) * epsilon * (std::abs(left) + std::abs(right));
    return determinant > bound ? 1 : determinant < -bound ? -1 : 0;
}

bool within_box(Point2 a, Point2 b, Point2 c) {
    return std::min(a.x, b.x) <= c.x && c.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= c.y
        && c.y <= std::max(a.y, b.y);
}

/// A closed chain of corners, none equal to the next one; number[i] is the corner's number in the
/// statement.
struct Outline {
    std::vector<Point2> corners;
    std::vector<std::size_t> numbers;

    std::size_t size() const { return corners.size(); }

    std::size_t next(std::size_t i) const { return i + 1 == size() ? 0 : i + 1; }

    std::size_t previous(std::size_t i) const { return i == 0 ? size() - 1 : i - 1; }
};

/// The polygon seen along the axis nearest to its normal, turned so that its area is positive.
Outline outline(std::span<const Vec3> corners, Vec3 normal) {
    const std::size_t axis = longest_axis(normal);
    const std::size_t first = (axis + 1) % 3;
    const std::size_t second = (axis + 2) % 3;
    const bool turned = normal[axis] < 0;
    Outline result;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point2 point = {
            corners[i][turned ? second : first], corners[i][turned ? first : second]};
        if (!result.corners.empty() && result.corners.back() == point)
            continue;
        result.corners.push_back(point);
        result.numbers.push_back(i);
    }
    while (result.size() > 1 && result.corners.back() == result.corners.front()) {
        result.corners.pop_back();
        result.numbers.pop_back();
    }
    return result;
}

bool is_convex(const Outline& polygon) {
    // No right turn, no turning back, and once round: the direction passes from the lower half
    // plane to the upper one only once.
    int rises = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 a = polygon.corners[polygon.previous(i)];
        const Point2 b = polygon.corners[i];
        const Point2 c = polygon.corners[polygon.next(i)];
        const int turn = side_of(a, b, c);
        const double along = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y);
        if (turn < 0 || (turn == 0 && !(along > 0)))
            return false;
        const bool first_up = b.y > a.y || (b.y == a.y && b.x > a.x);
        const bool second_up = c.y > b.y || (c.y == b.y && c.x > b.x);
        if (!first_up && second_up)
            ++rises;
    }
    return rises == 1;
}

/// Whether the way a, centre, b passes from one side of the way c, centre, d to the other.
bool ways_cross(Point2 center, Point2 a, Point2 b, Point2 c, Point2 d) {
    const auto between = [&](Point2 x) {
        // Strictly within the angle that begins at a and ends, counterclockwise, at b.
        const int from_a = side_of(center, a, x);
        const int from_b = side_of(center, b, x);
        const int turn = side_of(center, a, b);
        if (turn > 0)
            return from_a > 0 && from_b < 0;
        return turn < 0 ? from_a > 0 || from_b < 0 : from_a > 0;
    };
    const auto beside = [&](Point2 x) {
        return side_of(center, a, x) != 0 && side_of(center, b, x) != 0;
    };
    return beside(c) && beside(d) && between(c) != between(d);
}

/// Whether the sides i and j, which begin at these corners, cross: not whether they only touch.
bool sides_cross(const Outline& polygon, std::size_t i, std::size_t j) {
    const auto& p = polygon.corners;
    const Point2 a = p[i];
    const Point2 b = p[polygon.next(i)];
    const Point2 c = p[j];
    const Point2 d = p[polygon.next(j)];
    const int c_side = side_of(a, b, c);
    const int d_side = side_of(a, b, d);
    const int a_side = side_of(c, d, a);
    const int b_side = side_of(c, d, b);
    if (c_side * d_side < 0 && a_side * b_side < 0)
        return true;
    if (polygon.next(i) == j || polygon.next(j) == i)
        return false;
    if (a == c)
        return ways_cross(a, p[polygon.previous(i)], b, p[polygon.previous(j)], d);
    // A corner on the other side, whose neighbours lie on both sides of it.
    const auto passes = [&](std::size_t corner, Point2 from, Point2 to) {
        return p[corner] != from && p[corner] != to && within_box(from, to, p[corner])
            && side_of(from, to, p[polygon.previous(corner)])
                * side_of(from, to, p[polygon.next(corner)])
            < 0;
    };
    return (a_side == 0 && passes(i, c, d)) || (c_side == 0 && passes(j, a, b));
}

struct Crossing {
    bool found = false;
    bool too_involved = false;
    std::pair<std::size_t, std::size_t> sides = {};
};

Crossing crossing_of(const Outline& polygon, std::uint64_t most_side_pairs) {
    // Sides sorted by where they begin along one axis: only those that overlap there are compared.
    double x_total = 0;
    double y_total = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        x_total += std::abs(polygon.corners[polygon.next(i)].x - polygon.corners[i].x);
        y_total += std::abs(polygon.corners[polygon.next(i)].y - polygon.corners[i].y);
    }

    struct Range {
        double first;
        double last;
        std::size_t side;
    };

    std::vector<Range> ranges(polygon.size());
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 a = polygon.corners[i];
        const Point2 b = polygon.corners[polygon.next(i)];
        const auto [first, last] =
            x_total <= y_total ? std::minmax({a.x, b.x}) : std::minmax({a.y, b.y});
        ranges[i] = {first, last, i};
    }
    std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) {
        return a.first != b.first ? a.first < b.first : a.side < b.side;
    });
    std::uint64_t side_pairs = 0;
    for (std::size_t i = 0; i < ranges.size(); ++i)
        for (std::size_t j = i + 1; j < ranges.size() && ranges[j].first <= ranges[i].last; ++j) {
            if (++side_pairs > most_side_pairs)
                return {.too_involved = true};
            const auto [earlier, later] = std::minmax(ranges[i].side, ranges[j].side);
            if (sides_cross(polygon, earlier, later))
                return {.found = true, .sides = {polygon.numbers[earlier], polygon.numbers[later]}};
        }
    return {};
}

Vec3 area_vector(std::span<const Vec3> corners) {
    Vec3 area;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        area = area + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return area;
}

/// The normal of the plane through the corners that are farthest apart; nothing when all lie on one
/// line.
std::optional<Vec3> widest_normal(std::span<const Vec3> corners) {
    const auto farthest = [&](const auto& measure) {
        Vec3 best;
        double most = -1;
        for (const Vec3& corner : corners) {
            const double distance = measure(corner - corners[0]);
            if (distance > most) {
                most = distance;
                best = corner - corners[0];
            }
        }
        return best;
    };
    const Vec3 along = farthest([](Vec3 offset) { return dot(offset, offset); });
    const Vec3 across = farthest([&](Vec3 offset) {
        const Vec3 area = cross(along, offset);
        return dot(area, area);
    });
    return normal_of_cross(along, across, largest_coordinate(corners));
}

PolygonForm plane_form(
    std::span<const Vec3> corners, Vec3 normal, bool has_area, std::uint64_t most_side_pairs) {
    const Outline polygon = outline(corners, normal);
    PolygonForm form;
    form.normal = normal;
    const Crossing crossing = crossing_of(polygon, most_side_pairs);
    if (crossing.too_involved)
        form.kind = PolygonForm::Kind::too_involved;
    else if (crossing.found) {
        form.kind = PolygonForm::Kind::crossing;
        form.crossing_sides = crossing.sides;
    } else if (!has_area)
        form.kind = PolygonForm::Kind::no_area;
    else
        form.kind = is_convex(polygon) ? PolygonForm::Kind::convex : PolygonForm::Kind::simple;
    return form;
}

/// The normal to check a polygon with, and whether it is that of its area.
struct CheckNormal {
    Vec3 normal;
    bool of_area = false;
};

std::optional<CheckNormal> check_normal(std::span<const Vec3> corners) {
    const double extent = [&] {
        Box3 box;
        for (const Vec3& corner : corners)
            box = grown(box, corner);
        return max_component(box.upper - box.lower);
    }();
    const Vec3 area = area_vector(corners);
    const double noise =
        static_cast<double>(corners.size()) * area_noise(largest_coordinate(corners), extent);
    if (max_component(abs(area)) > noise)
        return CheckNormal{normalized(area), true};
    const auto widest = widest_normal(corners);
    if (!widest)
        return std::nullopt;
    return CheckNormal{*widest, false};
}

/// Whether the lines of the diagonals pass at more than 1e-6 of the longer one.
bool is_twisted(std::span<const Vec3, 4> corners) {
    const Vec3 first = corners[2] - corners[0];
    const Vec3 second = corners[3] - corners[1];
    const double longer = std::max(length(first), length(second));
    const Vec3 across = cross(first, second);
    const double size = length(across);
    // Diagonals this close to parallel pass at no distance that can be told from rounding.
    if (!(size > 1e-9 * length(first) * length(second)))
        return false;
    return std::abs(dot(corners[1] - corners[0], across)) > 1e-6 * longer * size;
}

/// The normal of a quadrangle that turns the same way at all four corners, by far more than
/// rounding: four such turns go round once, so that it is convex and its sides do not cross.
std::optional<Vec3> clearly_convex_normal(std::span<const Vec3, 4> corners) {
    const Vec3 area = cross(corners[2] - corners[0], corners[3] - corners[1]);
    const double least = 1e-6 * dot(area, area);
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 in = corners[i] - corners[(i + 3) % 4];
        const Vec3 out = corners[(i + 1) % 4] - corners[i];
        if (!(dot(cross(in, out), area) > least))
            return std::nullopt;
    }
    const Vec3 first = corners[2] - corners[0];
    const Vec3 second = corners[3] - corners[1];
    return normal_of_cross(first, second, largest_coordinate(corners));
}

} // namespace

PolygonForm quadrangle_form(std::span<const Vec3, 4> corners) {
    const double largest = largest_coordinate(corners);
    if (!of_common_size(largest) && largest > 0) {
        const Scaled scaled(corners);
        return quadrangle_form(std::span<const Vec3, 4>(scaled.corners.data(), 4));
    }
    if (is_twisted(corners))
        return {.kind = PolygonForm::Kind::not_plane};
    if (const auto normal = clearly_convex_normal(corners))
        return {.kind = PolygonForm::Kind::convex, .normal = *normal};
    const auto check = check_normal(corners);
    if (!check)
        return {};
    constexpr std::uint64_t all_side_pairs = 6;
    return plane_form(corners, check->normal, check->of_area, all_side_pairs);
}

PolygonForm polygon_form(std::span<const Vec3> corners, std::uint64_t most_side_pairs) {
    const double largest = largest_coordinate(corners);
    if (!of_common_size(largest) && largest > 0)
        return polygon_form(Scaled(corners).corners, most_side_pairs);
    const auto check = check_normal(corners);
    if (!check)
        return {};
    Box3 box;
    double lowest = 0;
    double highest = 0;
    for (const Vec3& corner : corners) {
        const double height = dot(check->normal, corner - corners[0]);
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
        box = grown(box, corner);
    }
    if ((highest - lowest) / 2 > 1e-6 * max_component(box.upper - box.lower))
        return {.kind = PolygonForm::Kind::not_plane};
    return plane_form(corners, check->normal, check->of_area, most_side_pairs);
}

std::optional<Outside> outside_of(Vec3 unit_normal, Vec3 first_corner, Vec3 inner_point) {
    const Vec3 offset = inner_point - first_corner;
    const double distance = dot(unit_normal, offset);
    if (!(std::abs(distance) > 1e-9 * length(offset)))
        return std::nullopt;
    return distance > 0 ? Outside::against_normal : Outside::along_normal;
}

} // namespace vera
