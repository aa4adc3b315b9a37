// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/plane_points.h"

#include "vera/math/elementary.h"
#include "vera/theory/whole_within.h"

#include <algorithm>
#include <cmath>

namespace vera {

namespace {

template <typename Make>
PlanePoints made(std::size_t count, const Make& make) {
    PlanePoints points(count);
    std::generate(points.begin(), points.end(), make);
    return points;
}

} // namespace

PlanePoints scattered_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const std::int32_t x = whole_within(1'000'000, random);
        return PlanePoint{x, whole_within(1'000'000, random)};
    });
}

PlanePoints circle_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const double angle_degrees = 180e-9 * whole_within(1'000'000'000, random);
        return PlanePoint{
            static_cast<std::int32_t>(1e9 * cos_degrees(angle_degrees)),
            static_cast<std::int32_t>(1e9 * sin_degrees(angle_degrees))};
    });
}

PlanePoints thin_diagonal_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const std::int32_t along = whole_within(1'000'000'000, random);
        return PlanePoint{along, along + whole_within(100, random)};
    });
}

PlanePoints lattice_points(std::size_t count, std::mt19937_64& /*random*/) {
    const auto side = static_cast<std::int32_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    std::int32_t i = 0;
    return made(count, [&] {
        const PlanePoint point = {i % side, i / side};
        ++i;
        return point;
    });
}

PlanePoints column_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const std::int32_t x = whole_within(2, random);
        return PlanePoint{x, whole_within(1000, random)};
    });
}

PlanePoints collinear_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&, reach = static_cast<std::int32_t>(count)] {
        const std::int32_t along = whole_within(reach, random);
        return PlanePoint{3 * along, 2 * along - 5};
    });
}

PlanePoints repeated_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const std::int32_t x = whole_within(1, random);
        return PlanePoint{x, whole_within(1, random)};
    });
}

PlanePoints crowded_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const auto value = [&] {
            return whole_within(largest_plane_coordinate, random) >> (random() % 31);
        };
        const std::int32_t x = value();
        return PlanePoint{x, value()};
    });
}

PlanePoints extreme_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const auto value = [&] {
            const std::int32_t end = whole_within(1, random) * largest_plane_coordinate;
            return end > 0 ? end - static_cast<std::int32_t>(random() % 2) : end;
        };
        const std::int32_t x = value();
        return PlanePoint{x, value()};
    });
}

const std::vector<PointFamily>& point_families() {
    static const std::vector<PointFamily> families = {
        {"scattered", scattered_points, "all over a square"},
        {"circle", circle_points, "on a circle"},
        {"thin-diagonal", thin_diagonal_points, "in a thin strip along a diagonal"},
        {"lattice", lattice_points, "in a square lattice"},
        {"columns", column_points, "on five vertical lines"},
        {"collinear", collinear_points, "on one line"},
        {"repeated", repeated_points, "at nine places"},
        {"crowded", crowded_points, "ever closer to one another"},
        {"extreme", extreme_points, "at the largest coordinates"}};
    return families;
}

PlaneStrip strip_near(const PlanePoints& points, PlaneDirection normal, std::mt19937_64& random) {
    const auto bound = [&] {
        return dot(normal, points[random() % points.size()]) + whole_within(1, random);
    };
    const std::uint64_t kind = random() % 3;
    PlaneStrip strip = {normal};
    if (kind != 0)
        strip.lowest = bound();
    if (kind != 1)
        strip.highest = bound();
    return strip;
}

PlaneStrip
half_plane_near(const PlanePoints& points, PlaneDirection normal, std::mt19937_64& random) {
    PlaneStrip strip = strip_near(points, normal, random);
    if (strip.highest != PlaneStrip().highest)
        strip.lowest = PlaneStrip().lowest;
    return strip;
}

PlaneDirection some_normal(const PlanePoints& points, std::mt19937_64& random) {
    const auto kind = random() % 3;
    if (kind == 0) {
        const std::int64_t x = whole_within(2, random);
        return {x, whole_within(2, random)};
    }
    if (kind == 1) {
        const PlaneDirection way =
            direction_between(points[random() % points.size()], points[random() % points.size()]);
        return {-way.y, way.x};
    }
    const std::int64_t x = 2 * std::int64_t{whole_within(largest_plane_coordinate, random)};
    return {x, 2 * std::int64_t{whole_within(largest_plane_coordinate, random)}};
}

} // namespace vera
