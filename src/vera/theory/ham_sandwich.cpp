// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/ham_sandwich.h"

#include "vera/base/check.h"
#include "vera/base/random.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace vera {

namespace {

using Points = std::span<const PlanePoint>;

/// Counts of places, each of which grows by one, and sums of those before a place (Fenwick 1994).
class PrefixCounts {
public:
    explicit PrefixCounts(std::size_t places)
        : sums_(places + 1) {}

    void add_at(std::size_t place) {
        for (std::size_t i = place + 1; i < sums_.size(); i += i & (~i + 1))
            ++sums_[i];
    }

    std::uint64_t before(std::size_t place) const {
        std::uint64_t sum = 0;
        for (std::size_t i = place; i > 0; i &= i - 1)
            sum += sums_[i];
        return sum;
    }

private:
    std::vector<std::uint32_t> sums_;
};

/// The directions between two, from the right one to the left one; neither belongs to it.
struct DirectionInterval {
    PlaneDirection right;
    PlaneDirection left;

    /// Whether the way from one point to the other lies in it: seen along the right end the second
    /// point is the left one, and seen along the left end it is not.
    bool contains_way(PlanePoint from, PlanePoint to) const {
        return offset(right, from) < offset(right, to) && offset(left, from) > offset(left, to);
    }
};

/// Pairs of a lower and an upper point whose way lies in an interval.
class CrossingPairs {
public:
    CrossingPairs(Points lower, Points upper, const DirectionInterval& interval)
        : lower_(lower)
        , upper_(upper)
        , interval_(interval)
        , ends_(upper.size()) {
        count_pairs();
    }

    std::uint64_t count() const { return ends_.back(); }

    /// The way of the pair of that number.
    PlaneDirection way(std::uint64_t number) const {
        const auto end = std::upper_bound(ends_.begin(), ends_.end(), number);
        const PlanePoint to = upper_[static_cast<std::size_t>(end - ends_.begin())];
        std::uint64_t left = *end - number;
        for (const PlanePoint from : lower_)
            if (interval_.contains_way(from, to) && --left == 0)
                return direction_between(from, to);
        VERA_CHECK(false);
    }

private:
    /// Goes through all points from right to left, as seen along the right end, and counts for each
    /// upper point the lower ones before it that lie to the left of it, as seen along the left end.
    void count_pairs() {
        const auto by_right = [](const Seen& a, const Seen& b) { return a.right < b.right; };
        std::vector<Seen> lower = seen(lower_);
        std::vector<Seen> upper = seen(upper_);
        std::vector<std::int64_t> left_ends(lower.size());
        std::transform(lower.begin(), lower.end(), left_ends.begin(), [](const Seen& point) {
            return point.left;
        });
        std::sort(left_ends.begin(), left_ends.end());
        std::sort(lower.begin(), lower.end(), by_right);
        std::sort(upper.begin(), upper.end(), by_right);

        PrefixCounts counts(lower.size());
        std::size_t passed = 0;
        for (const Seen& point : upper) {
            for (; passed < lower.size() && lower[passed].right < point.right; ++passed)
                counts.add_at(static_cast<std::size_t>(
                    std::lower_bound(left_ends.begin(), left_ends.end(), lower[passed].left)
                    - left_ends.begin()));
            const auto not_left = static_cast<std::size_t>(
                std::upper_bound(left_ends.begin(), left_ends.end(), point.left)
                - left_ends.begin());
            ends_[point.number] = passed - counts.before(not_left);
        }
        std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    }

    /// A point across the two ends of the interval.
    struct Seen {
        std::int64_t right = 0;
        std::int64_t left = 0;
        std::size_t number = 0;
    };

    std::vector<Seen> seen(Points points) const {
        std::vector<Seen> all(points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            all[i] = {offset(interval_.right, points[i]), offset(interval_.left, points[i]), i};
        return all;
    }

    Points lower_;
    Points upper_;
    DirectionInterval interval_;
    std::vector<std::uint64_t> ends_; ///< for each upper point, the pairs of it and those before
};

/// The medians of the two sets in some order.
struct Medians {
    PlanePoint lower;
    PlanePoint upper;
};

class CutSearch {
public:
    CutSearch(Points lower, Points upper)
        : lower_(lower)
        , upper_(upper)
        , scratch_(std::max(lower.size(), upper.size())) {}

    PlaneDirection direction(PlaneDirection line, std::uint64_t seed) {
        Medians medians = {median(lower_, TurnedOrder{line}), median(upper_, TurnedOrder{line})};
        if (medians.lower == medians.upper || never_meet(line))
            return line;
        DirectionInterval interval = {line, -line};
        for (std::uint64_t round = 0;; ++round) {
            const PlaneDirection next = next_way(interval, medians, seed, round);
            const auto across = [next](PlanePoint a, PlanePoint b) {
                return offset(next, a) < offset(next, b);
            };
            medians = {median(lower_, across), median(upper_, across)};
            if (offset(next, medians.lower) == offset(next, medians.upper))
                return next;
            (across(medians.lower, medians.upper) ? interval.right : interval.left) = next;
        }
    }

private:
    template <typename Order>
    PlanePoint median(Points points, const Order& order) {
        const auto end = std::copy(points.begin(), points.end(), scratch_.begin());
        const auto middle =
            scratch_.begin() + static_cast<std::ptrdiff_t>(median_rank(points.size()));
        std::nth_element(scratch_.begin(), middle, end, order);
        return *middle;
    }

    /// Whether the medians have not passed each other even when the direction is turned all the way
    /// but for less than anything. They then lie on the line.
    bool never_meet(PlaneDirection line) {
        const auto nearly_against = [back = -line](PlanePoint a, PlanePoint b) {
            const std::int64_t at_a = offset(back, a);
            const std::int64_t at_b = offset(back, b);
            return at_a != at_b ? at_a < at_b : dot(back, a) < dot(back, b);
        };
        return !nearly_against(median(upper_, nearly_against), median(lower_, nearly_against));
    }

    /// Three times the way between the medians last seen, which near the end is often the one and
    /// takes no sorting, and then a random one, which makes the search short for certain.
    PlaneDirection next_way(
        const DirectionInterval& interval,
        const Medians& medians,
        std::uint64_t seed,
        std::uint64_t round) const {
        if (round % 4 != 3 && interval.contains_way(medians.lower, medians.upper))
            return direction_between(medians.lower, medians.upper);
        const CrossingPairs pairs(lower_, upper_, interval);
        VERA_CHECK(pairs.count() > 0);
        return pairs.way(random(seed, round, 0) % pairs.count());
    }

    Points lower_;
    Points upper_;
    std::vector<PlanePoint> scratch_;
};

} // namespace

PlaneDirection conjugate_direction(
    std::span<const PlanePoint> lower,
    std::span<const PlanePoint> upper,
    PlaneDirection line,
    std::uint64_t seed) {
    VERA_CHECK(!lower.empty() && !upper.empty());
    return CutSearch(lower, upper).direction(line, seed);
}

} // namespace vera
