// SPDX-License-Identifier: Apache-2.0
// The order in which a plane across the z axis meets rays, by one coordinate, while the plane moves
// (VERA 3.3.2): a kinetic sorted list. Of each ray that coordinate is slope z + offset. Two rays
// exchange their places where they cross, and only neighbours can be the next to cross: this is the
// plane sweep of Bentley and Ottmann, for whole lines.
#pragma once

#include "vera/theory/plane_strip.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// A z that two lines have in common: numerator / denominator, which is positive. Both are the
/// difference of two coordinates, and so are compared in 63 bits.
struct CrossingZ {
    std::int64_t numerator = 0;
    std::int64_t denominator = 1;

    friend constexpr bool operator<(CrossingZ a, CrossingZ b) {
        return a.numerator * b.denominator < b.numerator * a.denominator;
    }
};

/// Neighbours in the order that meet there, and then exchange their places.
struct Crossing {
    CrossingZ z;
    std::uint32_t left = 0; ///< the ray that is the smaller one until then
    std::uint32_t right = 0;
};

/// Of m rays in O(m) of space; a crossing takes O(log m). Which of several crossings at one z comes
/// first makes no difference to the order after all of them.
class KineticOrder {
public:
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    /// Rays of which the points are (slope, offset), in the order at first_z; of those that meet
    /// there, in that behind it. What crosses behind last_z is left out. The points must be as
    /// require_plane_points() has them, and outlive the order; the zs at most
    /// largest_plane_coordinate.
    KineticOrder(std::span<const PlanePoint> points, std::int32_t first_z, std::int32_t last_z);

    /// The next crossing: nothing where there is none up to last_z.
    std::optional<Crossing> next() const;

    /// Lets the plane pass next(), which there is.
    void pass();

    /// The ray crosses no others any more. It keeps its place, which is no ray's from now on.
    void remove(std::uint32_t ray);

    /// A ray's place, from 0 to m - 1; a removed ray's last one.
    std::uint32_t place(std::uint32_t ray) const { return place_[ray]; }

    /// The ray at a place; none where it was removed.
    std::uint32_t at(std::uint32_t place) const { return at_[place]; }

    std::size_t size() const { return at_.size(); }

    /// Crossings that were passed.
    std::uint64_t passed() const { return passed_; }

    /// What m rays take of memory, in bytes, at most.
    static double bytes_forecast(std::size_t rays);

private:
    /// A crossing of the ray that was a certain ray's right neighbour when it had that version.
    struct Event {
        CrossingZ z;
        std::uint32_t left = 0;
        std::uint32_t version = 0;
    };

    static bool comes_later(const Event& a, const Event& b);

    bool is_current(const Event& event) const;
    std::uint32_t right_of(std::uint32_t ray) const;
    void link(std::uint32_t left_place, std::uint32_t right_place);
    void schedule(std::uint32_t left_place);
    void drop_old_events();

    std::span<const PlanePoint> points_;
    std::int32_t last_z_ = 0;
    std::vector<std::uint32_t> at_;
    std::vector<std::uint32_t> place_;
    std::vector<std::uint32_t>
        before_; ///< each place's neighbours that are rays'; none at the ends
    std::vector<std::uint32_t> after_;
    std::vector<std::uint32_t> version_; ///< of each ray, counts its right neighbours
    std::vector<Event> events_;          ///< a heap, of which the first one is current
    std::uint64_t passed_ = 0;
};

} // namespace vera
