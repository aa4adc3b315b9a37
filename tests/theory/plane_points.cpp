// SPDX-License-Identifier: Apache-2.0
#include "theory/plane_points.h"

#include <algorithm>
#include <cmath>

namespace vera::testing {

namespace {

/// From -reach to reach.
std::int32_t any_within(std::int32_t reach, std::mt19937_64& random) {
    const auto values = static_cast<std::uint64_t>(2 * std::int64_t{reach} + 1);
    return static_cast<std::int32_t>(static_cast<std::int64_t>(random() % values) - reach);
}

template <typename Make>
PlanePoints made(std::size_t count, const Make& make) {
    PlanePoints points(count);
    std::generate(points.begin(), points.end(), make);
    return points;
}

} // namespace

PlanePoints scattered_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const std::int32_t x = any_within(1'000'000, random);
        return PlanePoint{x, any_within(1'000'000, random)};
    });
}

PlanePoints circle_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const double angle = 1e-9 * any_within(1'000'000'000, random) * 3.14159265358979;
        return PlanePoint{
            static_cast<std::int32_t>(1e9 * std::cos(angle)),
            static_cast<std::int32_t>(1e9 * std::sin(angle))};
    });
}

PlanePoints thin_diagonal_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const std::int32_t along = any_within(1'000'000'000, random);
        return PlanePoint{along, along + any_within(100, random)};
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
        const std::int32_t x = any_within(2, random);
        return PlanePoint{x, any_within(1000, random)};
    });
}

PlanePoints collinear_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&, reach = static_cast<std::int32_t>(count)] {
        const std::int32_t along = any_within(reach, random);
        return PlanePoint{3 * along, 2 * along - 5};
    });
}

PlanePoints repeated_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const std::int32_t x = any_within(1, random);
        return PlanePoint{x, any_within(1, random)};
    });
}

PlanePoints crowded_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const auto value = [&] {
            return any_within(largest_plane_coordinate, random) >> (random() % 31);
        };
        const std::int32_t x = value();
        return PlanePoint{x, value()};
    });
}

PlanePoints extreme_points(std::size_t count, std::mt19937_64& random) {
    return made(count, [&] {
        const auto value = [&] {
            const std::int32_t end = any_within(1, random) * largest_plane_coordinate;
            return end > 0 ? end - static_cast<std::int32_t>(random() % 2) : end;
        };
        const std::int32_t x = value();
        return PlanePoint{x, value()};
    });
}

const std::vector<PointFamily>& point_families() {
    static const std::vector<PointFamily> families = {
        {"scattered", scattered_points},
        {"circle", circle_points},
        {"thin diagonal", thin_diagonal_points},
        {"lattice", lattice_points},
        {"columns", column_points},
        {"collinear", collinear_points},
        {"repeated", repeated_points},
        {"crowded", crowded_points},
        {"extreme", extreme_points}};
    return families;
}

PlaneStrip strip_near(const PlanePoints& points, PlaneDirection normal, std::mt19937_64& random) {
    const auto bound = [&] {
        return dot(normal, points[random() % points.size()]) + any_within(1, random);
    };
    const std::uint64_t kind = random() % 3;
    PlaneStrip strip = {normal};
    if (kind != 0)
        strip.lowest = bound();
    if (kind != 1)
        strip.highest = bound();
    return strip;
}

PlaneDirection some_normal(const PlanePoints& points, std::mt19937_64& random) {
    const auto kind = random() % 3;
    if (kind == 0) {
        const std::int64_t x = any_within(2, random);
        return {x, any_within(2, random)};
    }
    if (kind == 1) {
        const PlaneDirection way =
            direction_between(points[random() % points.size()], points[random() % points.size()]);
        return {-way.y, way.x};
    }
    const std::int64_t x = 2 * std::int64_t{any_within(largest_plane_coordinate, random)};
    return {x, 2 * std::int64_t{any_within(largest_plane_coordinate, random)}};
}

} // namespace vera::testing
