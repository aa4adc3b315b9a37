// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/horizon_profile.h"

#include "vera/base/check.h"
#include "vera/base/random.h"
#include "vera/math/elementary.h"

#include <utility>

namespace vera {

namespace {

constexpr double full_turn = 360;

double from_0_to_360(double azimuth) {
    const double positive = azimuth < 0 ? azimuth + full_turn : azimuth;
    return positive < full_turn ? positive : positive - full_turn;
}

/// Of length 1 along the level.
Vec3 direction_to(const ProfilePoint& point) {
    return {
        sin_degrees(point.azimuth_degrees),
        sin_degrees(point.elevation_degrees) / cos_degrees(point.elevation_degrees),
        -cos_degrees(point.azimuth_degrees)};
}

void check_points(const std::vector<ProfilePoint>& points) {
    VERA_CHECK(points.size() >= 3 && points.size() <= HorizonProfile::most_points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool last = i + 1 == points.size();
        const double next =
            last ? points[0].azimuth_degrees + full_turn : points[i + 1].azimuth_degrees;
        const double gap = next - points[i].azimuth_degrees;
        VERA_CHECK(gap >= HorizonProfile::narrowest_gap && gap <= HorizonProfile::widest_gap);
    }
}

/// From -1 to 1.
double random_height(std::uint64_t seed, std::uint64_t round, std::size_t i) {
    return static_cast<double>(random(seed, round, i) >> 11U) * 0x1p-52 - 1;
}

/// Heights of a closed range, each round of them halfway between those of the round before and off
/// by less (Fournier, Fussell and Carpenter 1982).
std::vector<double> random_heights(const Mountains& mountains) {
    constexpr std::size_t first_count = 9;
    constexpr std::uint64_t rounds = 8;
    const double smaller = 0.35 + 0.3 * mountains.roughness;
    std::vector<double> heights(first_count);
    for (std::size_t i = 0; i < heights.size(); ++i)
        heights[i] = random_height(mountains.seed, 0, i);
    double reach = 1;
    for (std::uint64_t round = 1; round <= rounds; ++round) {
        reach *= smaller;
        std::vector<double> finer;
        finer.reserve(2 * heights.size());
        for (std::size_t i = 0; i < heights.size(); ++i) {
            const double next = heights[i + 1 < heights.size() ? i + 1 : 0];
            finer.push_back(heights[i]);
            finer.push_back(
                0.5 * (heights[i] + next) + reach * random_height(mountains.seed, round, i));
        }
        heights = std::move(finer);
    }
    return heights;
}

std::vector<ProfilePoint> mountain_points(const Mountains& mountains) {
    const std::vector<double> heights = random_heights(mountains);
    const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
    const double scale = mountains.height_degrees / (*highest - *lowest);
    std::vector<ProfilePoint> points;
    points.reserve(heights.size());
    for (std::size_t i = 0; i < heights.size(); ++i)
        points.push_back(
            {full_turn * static_cast<double>(i) / static_cast<double>(heights.size()),
             scale * (heights[i] - *lowest)});
    return points;
}

} // namespace

HorizonProfile::HorizonProfile(std::vector<ProfilePoint> points)
    : points_(std::move(points)) {
    check_points(points_);
    for (ProfilePoint& point : points_)
        point.azimuth_degrees = from_0_to_360(point.azimuth_degrees);
    std::rotate(
        points_.begin(),
        std::min_element(
            points_.begin(),
            points_.end(),
            [](const auto& a, const auto& b) { return a.azimuth_degrees < b.azimuth_degrees; }),
        points_.end());

    const std::size_t count = points_.size();
    for (const ProfilePoint& point : points_) {
        directions_.push_back(direction_to(point));
        turns_.push_back(turn_of(directions_.back()));
    }
    for (std::size_t i = 0; i < count; ++i)
        normals_.push_back(cross(directions_[i + 1 < count ? i + 1 : 0], directions_[i]));

    buckets_per_turn_ = static_cast<double>(count);
    const std::size_t buckets = 4 * count + 1; // 4 itself is a turn as well
    for (std::size_t i = 0; i < buckets; ++i)
        first_in_bucket_.push_back(static_cast<std::uint32_t>(
            std::partition_point(
                turns_.begin(),
                turns_.end(),
                [&](double turn) { return static_cast<std::size_t>(turn * buckets_per_turn_) < i; })
            - turns_.begin()));
    first_in_bucket_.push_back(static_cast<std::uint32_t>(count));
}

HorizonProfile::HorizonProfile(const Mountains& mountains)
    : HorizonProfile(mountain_points(mountains)) {
    mountains_ = mountains;
}

} // namespace vera
