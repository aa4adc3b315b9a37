// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/map_triangulation.h"

#include "vera/base/long_loop.h"

#include <algorithm>
#include <set>

namespace vera {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

class Sweep {
public:
    Sweep(const MapSegments& map, MapTriangulation& result);

    void run(const CancelFlag* cancel);

private:
    /// Between a border and the next one above: the points, from below to above, from which
    /// something in the gap on their right is not in a triangle yet. The ways between them turn
    /// away from the gap but where they come to the last point of all.
    struct Gap {
        std::uint32_t lowest = none; ///< in links_
        std::uint32_t highest = none;
        std::uint32_t last = none; ///< that the sweep came to
        std::uint32_t region = no_region;
    };

    struct Link {
        std::uint32_t point = 0;
        std::uint32_t lower = none;
        std::uint32_t higher = none;
    };

    /// From below to above.
    struct Below {
        using is_transparent = void; // NOLINT(readability-identifier-naming): std::set asks for it
        const MapSegments& map;
        std::uint64_t& steps;

        bool operator()(std::uint32_t a, std::uint32_t b) const {
            ++steps;
            return a != b && map.is_above(b, a);
        }

        bool operator()(std::uint32_t segment, const MapPoint& point) const {
            ++steps;
            return map.side(segment, point) > 0;
        }

        bool operator()(const MapPoint& point, std::uint32_t segment) const {
            ++steps;
            return map.side(segment, point) < 0;
        }
    };

    using Status = std::set<std::uint32_t, Below>;

    void take_point(std::uint32_t point);
    void begin_gaps(
        std::uint32_t point,
        std::uint32_t bottom,
        std::uint32_t lower,
        std::uint32_t higher,
        std::uint32_t highest);
    std::uint32_t seen_down(std::uint32_t point, std::uint32_t from);
    std::uint32_t seen_up(std::uint32_t point, std::uint32_t from);
    bool join(std::uint32_t point, std::uint32_t lower, std::uint32_t higher);
    void close(std::uint32_t point, const Gap& gap);
    std::uint32_t add_link(std::uint32_t point);
    void connect(std::uint32_t lower, std::uint32_t higher);

    MapSegments map_; ///< with the frame; of segments that a point touches, the parts
    MapTriangulation& result_;
    std::vector<std::vector<std::uint32_t>> beginning_; ///< of each point
    std::vector<std::uint32_t> to_end_;                 ///< how many segments end at each point
    std::vector<Gap> gaps_;                             ///< above each segment
    std::vector<Link> links_;
    Status status_;
    std::uint32_t region_ = no_region; ///< of the gap at hand
};

Sweep::Sweep(const MapSegments& map, MapTriangulation& result)
    : result_(result)
    , status_(Below{map_, result.steps}) {
    const auto corner = [&](std::int32_t x, std::int32_t y) {
        map_.points.push_back(map_point(RationalPoint{{x, y}}));
    };
    map_.points.reserve(map.points.size() + 4);
    corner(-1, -1);
    corner(-1, screen_size + 1);
    map_.points.insert(map_.points.end(), map.points.begin(), map.points.end());
    corner(screen_size + 1, -1);
    corner(screen_size + 1, screen_size + 1);
    const auto last = static_cast<std::uint32_t>(map_.points.size() - 1);
    map_.segments = {{0, last - 1, no_region, no_region}, {1, last, no_region, no_region}};
    beginning_.resize(map_.points.size());
    to_end_.resize(map_.points.size());
    for (const MapSegment& segment : map.segments) {
        beginning_[segment.begin + 2].push_back(static_cast<std::uint32_t>(map_.segments.size()));
        ++to_end_[segment.end + 2];
        map_.segments.push_back({segment.begin + 2, segment.end + 2, segment.above, segment.below});
    }
    gaps_.resize(map_.segments.size());
}

std::uint32_t Sweep::add_link(std::uint32_t point) {
    links_.push_back({point});
    return static_cast<std::uint32_t>(links_.size() - 1);
}

void Sweep::connect(std::uint32_t lower, std::uint32_t higher) {
    if (lower != none)
        links_[lower].higher = higher;
    if (higher != none)
        links_[higher].lower = lower;
}

/// Whether the point sees the way between two links; adds the triangle then.
bool Sweep::join(std::uint32_t point, std::uint32_t lower, std::uint32_t higher) {
    const std::uint32_t a = links_[lower].point;
    const std::uint32_t b = links_[higher].point;
    ++result_.steps;
    if (side(map_.points[a], map_.points[point], map_.points[b]) <= 0)
        return false;
    result_.triangles.push_back({a, point, b});
    result_.regions.push_back(region_);
    return true;
}

/// The last link, from the given one downward, that the point sees; joins the point with all.
std::uint32_t Sweep::seen_down(std::uint32_t point, std::uint32_t from) {
    while (links_[from].lower != none && join(point, links_[from].lower, from))
        from = links_[from].lower;
    return from;
}

std::uint32_t Sweep::seen_up(std::uint32_t point, std::uint32_t from) {
    while (links_[from].higher != none && join(point, from, links_[from].higher))
        from = links_[from].higher;
    return from;
}

/// A gap of which both borders end in the point.
void Sweep::close(std::uint32_t point, const Gap& gap) {
    region_ = gap.region;
    if (seen_up(point, gap.lowest) != gap.highest)
        throw CrossingBorders();
}

/// What begins at the point, after the last links that it sees below and above it in the gap of the
/// segment `bottom` and in the gap that ends with the link `highest`.
void Sweep::begin_gaps(
    std::uint32_t point,
    std::uint32_t bottom,
    std::uint32_t lower,
    std::uint32_t higher,
    std::uint32_t highest) {
    std::vector<std::uint32_t>& beginning = beginning_[point];
    std::sort(beginning.begin(), beginning.end(), [&](std::uint32_t a, std::uint32_t b) {
        return a != b && map_.is_above(b, a);
    });
    std::uint32_t link = add_link(point);
    connect(lower, link);
    gaps_[bottom].last = link;
    std::uint32_t below = bottom;
    for (const std::uint32_t segment : beginning) {
        gaps_[below].highest = link;
        link = add_link(point);
        gaps_[segment] = {link, link, link, map_.segments[segment].above};
        status_.insert(segment);
        below = segment;
    }
    connect(link, higher);
    gaps_[below].highest = highest;
    beginning.clear();
    beginning.shrink_to_fit();
}

void Sweep::take_point(std::uint32_t point) {
    const MapPoint& at = map_.points[point];
    const auto [first, behind] = status_.equal_range(at);
    if (first == status_.begin() || behind == status_.end())
        throw CrossingBorders();
    const std::uint32_t bottom = *std::prev(first);
    std::uint32_t lower = none;
    std::uint32_t higher = none;
    std::uint32_t highest = gaps_[bottom].highest;
    region_ = gaps_[bottom].region;
    if (first == behind) {
        lower = seen_down(point, gaps_[bottom].last);
        higher = seen_up(point, gaps_[bottom].last);
        if (lower == higher) {
            // It stays in the gap below the point, and in the one above.
            higher = add_link(links_[lower].point);
            connect(higher, links_[lower].higher);
            if (highest == lower)
                highest = higher;
        }
    } else {
        lower = seen_down(point, highest);
        for (auto segment = first; segment != behind; ++segment) {
            const Gap gap = gaps_[*segment];
            if (std::next(segment) != behind) {
                close(point, gap);
            } else {
                region_ = gap.region;
                higher = seen_up(point, gap.lowest);
                highest = gap.highest;
            }
            const MapSegment whole = map_.segments[*segment];
            if (whole.end == point) {
                --to_end_[point];
                continue;
            }
            // The point touches it: its other part begins here.
            beginning_[point].push_back(static_cast<std::uint32_t>(map_.segments.size()));
            map_.segments.push_back({point, whole.end, whole.above, whole.below});
            gaps_.emplace_back();
        }
        status_.erase(first, behind);
    }
    if (to_end_[point] != 0)
        throw CrossingBorders();
    begin_gaps(point, bottom, lower, higher, highest);
}

void Sweep::run(const CancelFlag* cancel) {
    const std::uint32_t lower = add_link(0);
    const std::uint32_t higher = add_link(1);
    connect(lower, higher);
    gaps_[0] = {lower, higher, higher, no_region};
    status_.insert(0);
    status_.insert(1);
    const auto count = static_cast<std::uint32_t>(map_.points.size());
    const LongLoop loop(count, {}, cancel);
    for (std::uint32_t point = 2; point < count - 2; ++point) {
        loop.turn(point);
        take_point(point);
    }
    // The corners on the right.
    region_ = no_region;
    Gap& gap = gaps_[0];
    const std::uint32_t seen = seen_up(count - 2, gap.lowest);
    const std::uint32_t link = add_link(count - 2);
    connect(link, seen);
    close(count - 1, {link, gap.highest, link, no_region});
    result_.points = std::move(map_.points);
}

} // namespace

MapTriangulation triangulation(const MapSegments& segments, const CancelFlag* cancel) {
    MapTriangulation result;
    Sweep(segments, result).run(cancel);
    return result;
}

} // namespace vera
