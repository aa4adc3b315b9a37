// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/sweep_points.h"
#include "vera/visible/sweep_segments.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// Which way what is high goes in the picture.
enum class Upward : std::uint8_t {
    with_y,   ///< y grows upward
    against_y ///< y grows downward, as of screen_scene()
};

/// A part of a profile: the segment that it follows from one x to another. The points stand for
/// their x alone; where one is an end of a segment, that x is whole.
struct ProfilePart {
    SweepPoint from;
    SweepPoint to;
    std::uint32_t segment = no_segment; ///< or none: as low as can be
};

/// A height over each x, or nothing: parts from left to right. It may jump where segments end.
using Profile = std::vector<ProfilePart>;

/// The profiles of segments that are not vertical and of which no two have more than one point in
/// common, compared in whole numbers.
class ProfileMerge {
public:
    /// All must outlive this.
    ProfileMerge(
        std::span<const SweepSegments::Segment> segments, Upward upward, PlaneSweepCounts& counts)
        : segments_(segments)
        , predicates_(segments, counts)
        , sign_(upward == Upward::with_y ? 1 : -1) {}

    /// Whichever is higher, at each x at which either is: O(parts of both and of the result).
    Profile higher(const Profile& a, const Profile& b);

    /// Whichever is lower.
    Profile lower(const Profile& a, const Profile& b);

    /// Of b, what lies below a. a is nothing else than a roof: where it is missing, b is left out.
    Profile below(const Profile& a, const Profile& b);

    /// The higher of both where b is: a alone does not count.
    Profile raised(const Profile& a, const Profile& b);

    /// Calls visit(part, segment of a, segment of b, order) from left to right for all x at which
    /// either is: part has no segment; 1 where a is higher, -1 where b is, 0 where both follow one
    /// segment or none. An absent profile is lower than one as low as can be.
    template <typename Visit>
    void compare(const Profile& a, const Profile& b, const Visit& visit);

    /// Stretches of x looked at so far.
    std::uint64_t stretches() const { return stretches_; }

    static constexpr std::uint32_t absent = no_segment - 1;

private:
    /// How far a comparison has come in a profile.
    struct Cursor {
        explicit Cursor(const Profile& profile)
            : part(profile.data())
            , end(profile.data() + profile.size()) {}

        bool is_done() const { return part == end; }

        std::uint32_t segment() const { return is_here ? part->segment : absent; }

        /// Where it next changes; not of one that is done.
        const SweepPoint& stop() const { return is_here ? part->to : part->from; }

        const ProfilePart* part;
        const ProfilePart* end;
        bool is_here = false; ///< the part has begun
    };

    static void append(Profile& profile, const ProfilePart& part);
    void advance(Cursor& cursor, const SweepPoint& at) const;
    const SweepPoint& first_stop(const Cursor& a, const Cursor& b) const;
    std::optional<SweepPoint> crossing(std::uint32_t a, std::uint32_t b, int& order_before) const;
    int order(std::uint32_t a, std::uint32_t b) const;
    template <typename Visit>
    void
    visit_stretch(const ProfilePart& part, std::uint32_t a, std::uint32_t b, const Visit& visit);

    std::span<const SweepSegments::Segment> segments_;
    SweepPredicates predicates_;
    int sign_ = 1;
    std::uint64_t stretches_ = 0;
};

template <typename Visit>
void ProfileMerge::compare(const Profile& a, const Profile& b, const Visit& visit) {
    Cursor one(a);
    Cursor other(b);
    if (one.is_done() && other.is_done())
        return;
    for (SweepPoint at = first_stop(one, other);;) {
        advance(one, at);
        advance(other, at);
        if (one.is_done() && other.is_done())
            return;
        const SweepPoint next = first_stop(one, other);
        if (one.is_here || other.is_here)
            visit_stretch({at, next}, one.segment(), other.segment(), visit);
        at = next;
    }
}

/// In two parts where the segments cross within it.
template <typename Visit>
void ProfileMerge::visit_stretch(
    const ProfilePart& part, std::uint32_t a, std::uint32_t b, const Visit& visit) {
    ++stretches_;
    int before = 0;
    const auto cross = crossing(a, b, before);
    if (!cross) {
        visit(part, a, b, order(a, b));
    } else if (predicates_.order_of_x(*cross, part.from) <= 0) {
        visit(part, a, b, -before);
    } else if (predicates_.order_of_x(*cross, part.to) >= 0) {
        visit(part, a, b, before);
    } else {
        visit(ProfilePart{part.from, *cross}, a, b, before);
        visit(ProfilePart{*cross, part.to}, a, b, -before);
    }
}

} // namespace vera
