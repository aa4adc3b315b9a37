// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/profile.h"

#include <optional>

namespace vera {

namespace {

/// Of places in one stretch of which the other begins, which are copies of each other.
bool are_one(const SweepPoint& a, const SweepPoint& b) {
    return a.x == b.x && a.first == b.first && a.second == b.second;
}

} // namespace

/// Goes on with the part before where that follows the same segment.
void ProfileMerge::append(Profile& profile, const ProfilePart& part) {
    if (!profile.empty() && profile.back().segment == part.segment
        && are_one(profile.back().to, part.from))
        profile.back().to = part.to;
    else
        profile.push_back(part);
}

/// To the part that is at that x or begins behind it.
void ProfileMerge::advance(Cursor& cursor, const SweepPoint& at) const {
    while (!cursor.is_done() && predicates_.order_of_x(cursor.part->to, at) <= 0)
        ++cursor.part;
    cursor.is_here = !cursor.is_done() && predicates_.order_of_x(cursor.part->from, at) <= 0;
}

/// Of two at one x, that which is an end: there profiles may jump.
const SweepPoint& ProfileMerge::first_stop(const Cursor& a, const Cursor& b) const {
    if (a.is_done() || b.is_done())
        return a.is_done() ? b.stop() : a.stop();
    const SweepPoint& one = a.stop();
    const SweepPoint& other = b.stop();
    const int order = predicates_.order_of_x(one, other);
    if (order == 0)
        return one.is_crossing() ? other : one;
    return order < 0 ? one : other;
}

/// Nothing where either is none.
std::optional<SweepPoint>
ProfileMerge::crossing(std::uint32_t a, std::uint32_t b, int& order_before) const {
    if (a == b || a >= absent || b >= absent)
        return std::nullopt;
    if (const auto point = predicates_.crossing(a, b)) {
        order_before = -sign_;
        return point;
    }
    order_before = sign_;
    return predicates_.crossing(b, a);
}

/// Of two that do not cross, at whatever x both are.
int ProfileMerge::order(std::uint32_t a, std::uint32_t b) const {
    if (a == b)
        return 0;
    if (a >= absent || b >= absent) {
        if (a >= absent && b >= absent)
            return a == absent ? -1 : 1;
        return a >= absent ? -1 : 1;
    }
    const auto& one = segments_[a];
    const auto& other = segments_[b];
    // Each pair of places is where one of them ends and both are.
    const int at_begin = one.begin.x >= other.begin.x ? predicates_.side(b, at_end(one.begin))
                                                      : -predicates_.side(a, at_end(other.begin));
    if (at_begin != 0)
        return sign_ * at_begin;
    return sign_
        * (one.end.x <= other.end.x ? predicates_.side(b, at_end(one.end))
                                    : -predicates_.side(a, at_end(other.end)));
}

Profile ProfileMerge::higher(const Profile& a, const Profile& b) {
    Profile result;
    compare(a, b, [&](const ProfilePart& part, std::uint32_t one, std::uint32_t other, int order) {
        append(result, {part.from, part.to, order >= 0 ? one : other});
    });
    return result;
}

Profile ProfileMerge::lower(const Profile& a, const Profile& b) {
    Profile result;
    compare(a, b, [&](const ProfilePart& part, std::uint32_t one, std::uint32_t other, int order) {
        const bool takes_first = other == absent || (one != absent && order <= 0);
        append(result, {part.from, part.to, takes_first ? one : other});
    });
    return result;
}

Profile ProfileMerge::below(const Profile& a, const Profile& b) {
    Profile result;
    compare(a, b, [&](const ProfilePart& part, std::uint32_t one, std::uint32_t other, int order) {
        if (one != absent && other != absent && order > 0)
            append(result, {part.from, part.to, other});
    });
    return result;
}

Profile ProfileMerge::raised(const Profile& a, const Profile& b) {
    Profile result;
    compare(a, b, [&](const ProfilePart& part, std::uint32_t one, std::uint32_t other, int order) {
        if (other != absent)
            append(result, {part.from, part.to, order > 0 ? one : other});
    });
    return result;
}

} // namespace vera
