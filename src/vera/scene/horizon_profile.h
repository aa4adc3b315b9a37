// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// A point of a profile. Azimuths are those of a compass with north at -z: 0 is -z, 90 is x, 180 is
/// z. Elevations are above the level.
struct ProfilePoint {
    double azimuth_degrees = 0;
    double elevation_degrees = 0;

    friend constexpr bool operator==(const ProfilePoint&, const ProfilePoint&) = default;
};

/// PROFILE MOUNTAINS seed height roughness
struct Mountains {
    std::uint64_t seed = 1;
    double height_degrees = 10; ///< elevation of the highest peak; the lowest place is level
    double roughness = 0.5;     ///< from 0, soft hills, to 1, jagged rocks

    friend constexpr bool operator==(const Mountains&, const Mountains&) = default;
};

/// The shape of the horizon: earth below, sky above (VERA 2.3). Between its points it runs along
/// great circles, which every view in perspective shows as straight lines.
class HorizonProfile {
public:
    static constexpr std::size_t most_points = 100'000;
    static constexpr double largest_azimuth = 360; ///< and -360 the smallest
    static constexpr double widest_gap = 120;      ///< between neighbours, degrees
    static constexpr double narrowest_gap = 1e-6;  ///< so that rounding turns no side over
    static constexpr double steepest = 80;         ///< elevation, up or down, degrees

    /// Three points or more, from most_points on none, with azimuths that grow by no less than
    /// narrowest_gap and no more than widest_gap, also from the last round to the first.
    explicit HorizonProfile(std::vector<ProfilePoint> points);

    /// A range all round, its shape by random numbers that depend on the seed alone.
    explicit HorizonProfile(const Mountains& mountains);

    /// By their azimuths, from 0 to less than 360.
    std::span<const ProfilePoint> points() const { return points_; }

    /// Directions to the points, of any length.
    std::span<const Vec3> directions() const { return directions_; }

    /// What the points were made from, if anything.
    const std::optional<Mountains>& mountains() const { return mountains_; }

    /// Whether the direction, of any length, lies below the profile. Quick for any number of
    /// points, and the same on every machine.
    bool hides(Vec3 direction) const { return dot(normals_[side_of(direction)], direction) < 0; }

    /// The side, from that point to the next, that lies below or above the direction.
    std::size_t side_of(Vec3 direction) const {
        const double turn = turn_of(direction);
        const auto bucket = static_cast<std::size_t>(turn * buckets_per_turn_);
        const auto first = turns_.begin() + first_in_bucket_[bucket];
        const auto last = turns_.begin() + first_in_bucket_[bucket + 1];
        const auto after = std::upper_bound(first, last, turn);
        // Before the first point it is the side that leads round to it.
        return after == turns_.begin() ? turns_.size() - 1
                                       : static_cast<std::size_t>(after - turns_.begin()) - 1;
    }

    /// A number from 0 to 4 that grows with the azimuth: 1 for each quarter turn, found without
    /// angles.
    static constexpr double turn_of(Vec3 direction) {
        const double x = direction.x < 0 ? -direction.x : direction.x;
        const double z = direction.z < 0 ? -direction.z : direction.z;
        const double sum = x + z;
        if (!(sum > 0))
            return 0; // all sides agree on what is straight above and below
        if (direction.z < 0)
            return direction.x < 0 ? 3 + z / sum : x / sum;
        return direction.x > 0 ? 1 + z / sum : 2 + x / sum;
    }

private:
    std::vector<ProfilePoint> points_;
    std::optional<Mountains> mountains_;
    std::vector<Vec3> directions_;
    std::vector<Vec3> normals_;                  ///< of the sides' planes, upwards
    std::vector<double> turns_;                  ///< of the points
    std::vector<std::uint32_t> first_in_bucket_; ///< of turns_, and in the end their number
    double buckets_per_turn_ = 1;
};

} // namespace vera
