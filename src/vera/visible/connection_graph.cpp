// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/connection_graph.h"

#include "vera/base/check.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <queue>
#include <set>
#include <stdexcept>

namespace vera {

namespace {

/// A place in the status of the sweep, and the segment that is there now.
struct Rung {
    mutable std::uint32_t segment = 0;
};

/// The status keeps its order by where rungs are inserted: the segments' order, which is true at
/// the line of the sweep alone, serves to find a point among them.
struct RungOrder {
    using is_transparent = void; // NOLINT(readability-identifier-naming): the library's name
    const SweepPredicates* predicates;

    bool operator()(const Rung&, const Rung&) const { return false; }

    bool operator()(const Rung& rung, const SweepPoint& point) const {
        return predicates->side(rung.segment, point) > 0;
    }

    bool operator()(const SweepPoint& point, const Rung& rung) const {
        return predicates->side(rung.segment, point) < 0;
    }
};

using Status = std::multiset<Rung, RungOrder>;

/// For the queue, whose first is the greatest.
struct LaterPoint {
    const SweepPredicates* predicates;

    bool operator()(const SweepPoint& a, const SweepPoint& b) const {
        return predicates->order(a, b) > 0;
    }
};

class Sweep {
public:
    Sweep(
        std::span<const SweepSegments::Segment> segments,
        std::size_t expected,
        PlaneSweepCounts& counts);

    ConnectionGraph run(const Progress& progress, const CancelFlag* cancel);

private:
    bool take_point(SweepPoint& point);
    void stop_at(const SweepPoint& point);
    Status::iterator find_through(const SweepPoint& point);
    void end_edges(ConnectionGraph::Vertex& vertex, std::uint32_t number, Status::iterator first);
    void find_outgoing(const SweepPoint& point);
    Status::iterator place_outgoing(Status::iterator first);
    void begin_edges(Status::iterator first);
    void expect_crossing(Status::iterator below, Status::iterator above);

    bool leads_beyond(std::uint32_t segment, const SweepPoint& point) const {
        return point.is_crossing() || at_end(segments_[segment].end).x != point.x
            || at_end(segments_[segment].end).y != point.y;
    }

    bool is_steeper(std::uint32_t a, std::uint32_t b) const {
        return cross(
                   step(segments_[b].begin, segments_[b].end),
                   step(segments_[a].begin, segments_[a].end))
            > 0;
    }

    std::uint32_t& gap_above(Status::iterator rung) {
        return rung == status_.end() ? lowest_gap_ : gap_above_[rung->segment];
    }

    Status::iterator before(Status::iterator rung) const {
        return rung == status_.begin() ? status_.end() : std::prev(rung);
    }

    std::span<const SweepSegments::Segment> segments_;
    PlaneSweepCounts& counts_;
    SweepPredicates predicates_;
    Status status_;
    std::priority_queue<SweepPoint, std::vector<SweepPoint>, LaterPoint> crossings_;
    std::vector<ScreenPoint> corners_; ///< in their order
    std::size_t next_corner_ = 0;
    std::vector<std::uint32_t> by_begin_; ///< segments
    std::size_t next_begin_ = 0;
    // Of each segment in the status:
    std::vector<Status::iterator> rungs_;
    std::vector<std::uint32_t> open_edges_;
    std::vector<std::uint32_t> gap_above_;
    std::uint32_t lowest_gap_ = 0; ///< below all segments
    // At the present point, from the lowest to the highest:
    std::vector<std::uint32_t> through_;  ///< segments that come from the left
    std::vector<std::uint32_t> outgoing_; ///< that lead on to the right
    ConnectionGraph graph_;
};

Sweep::Sweep(
    std::span<const SweepSegments::Segment> segments,
    std::size_t expected,
    PlaneSweepCounts& counts)
    : segments_(segments)
    , counts_(counts)
    , predicates_(segments, counts)
    , status_(RungOrder{&predicates_})
    , crossings_(LaterPoint{&predicates_})
    , by_begin_(segments.size())
    , rungs_(segments.size())
    , open_edges_(segments.size())
    , gap_above_(segments.size()) {
    corners_.reserve(2 * segments.size());
    for (const auto& [begin, end] : segments) {
        corners_.push_back(begin);
        corners_.push_back(end);
    }
    std::sort(corners_.begin(), corners_.end());
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
    std::iota(by_begin_.begin(), by_begin_.end(), 0U);
    std::sort(by_begin_.begin(), by_begin_.end(), [&](std::uint32_t a, std::uint32_t b) {
        if (segments_[a].begin != segments_[b].begin)
            return segments_[a].begin < segments_[b].begin;
        return is_steeper(b, a);
    });
    graph_.vertices.reserve(corners_.size() + expected + 1);
    graph_.edges.reserve(segments.size() + 2 * expected);
    graph_.gaps.reserve(graph_.vertices.capacity() + graph_.edges.capacity());
    counts_.segments = segments.size();
    counts_.corners = corners_.size();
}

/// The next point to stop at; false where there is none.
bool Sweep::take_point(SweepPoint& point) {
    if (next_corner_ == corners_.size()) {
        if (crossings_.empty())
            return false;
        point = crossings_.top();
    } else {
        point = at_end(corners_[next_corner_]);
        if (!crossings_.empty() && predicates_.order(crossings_.top(), point) < 0)
            point = crossings_.top();
        else
            ++next_corner_;
    }
    while (!crossings_.empty() && predicates_.order(crossings_.top(), point) == 0)
        crossings_.pop();
    return true;
}

/// Gathers the segments through the point that come from the left; returns the lowest, or the one
/// above the point.
Status::iterator Sweep::find_through(const SweepPoint& point) {
    auto first = point.is_crossing() ? rungs_[point.first] : status_.lower_bound(point);
    if (point.is_crossing())
        while (first != status_.begin() && predicates_.side(std::prev(first)->segment, point) == 0)
            --first;
    through_.clear();
    for (auto rung = first; rung != status_.end() && predicates_.side(rung->segment, point) == 0;
         ++rung)
        through_.push_back(rung->segment);
    return first;
}

/// At the vertex, of what comes from the left; or where nothing does, begins its drain.
void Sweep::end_edges(
    ConnectionGraph::Vertex& vertex, std::uint32_t number, Status::iterator first) {
    for (const std::uint32_t segment : through_)
        graph_.edges[open_edges_[segment]].end = number;
    if (!through_.empty()) {
        // The lowest from the left is the steepest.
        vertex.drain = open_edges_[through_.front()];
    } else if (number != 0) {
        graph_.gaps[gap_above(before(first))] = number;
        ++counts_.drains;
    }
}

void Sweep::find_outgoing(const SweepPoint& point) {
    outgoing_.clear();
    // What goes through the point lies the other way round behind it.
    std::copy_if(
        through_.rbegin(),
        through_.rend(),
        std::back_inserter(outgoing_),
        [&](std::uint32_t segment) { return leads_beyond(segment, point); });
    if (point.is_crossing())
        return;
    const auto middle = static_cast<std::ptrdiff_t>(outgoing_.size());
    for (; next_begin_ < by_begin_.size(); ++next_begin_) {
        const std::uint32_t segment = by_begin_[next_begin_];
        if (segments_[segment].begin != corners_[next_corner_ - 1])
            break;
        outgoing_.push_back(segment);
    }
    std::inplace_merge(
        outgoing_.begin(),
        outgoing_.begin() + middle,
        outgoing_.end(),
        [&](std::uint32_t a, std::uint32_t b) { return is_steeper(b, a); });
}

/// Puts what leads on in the place of what came; returns the lowest of it, or what lies above.
Status::iterator Sweep::place_outgoing(Status::iterator first) {
    auto rung = first;
    for (std::size_t i = 0; i < outgoing_.size(); ++i) {
        const auto here = i < through_.size() ? rung++ : status_.insert(rung, Rung{});
        here->segment = outgoing_[i];
        rungs_[outgoing_[i]] = here;
    }
    for (std::size_t i = outgoing_.size(); i < through_.size(); ++i)
        rung = status_.erase(rung);
    return outgoing_.empty() ? rung : rungs_[outgoing_.front()];
}

/// Of the last vertex, to the right; first is the lowest of what leads on, or what lies above.
void Sweep::begin_edges(Status::iterator first) {
    gap_above(before(first)) = static_cast<std::uint32_t>(graph_.gaps.size());
    graph_.gaps.push_back(ConnectionGraph::none);
    for (const std::uint32_t segment : outgoing_) {
        open_edges_[segment] = static_cast<std::uint32_t>(graph_.edges.size());
        graph_.edges.push_back({segment});
        gap_above_[segment] = static_cast<std::uint32_t>(graph_.gaps.size());
        graph_.gaps.push_back(ConnectionGraph::none);
    }
}

void Sweep::expect_crossing(Status::iterator below, Status::iterator above) {
    if (below == status_.end() || above == status_.end())
        return;
    if (const auto crossing = predicates_.crossing(below->segment, above->segment)) {
        crossings_.push(*crossing);
        ++counts_.queued;
    }
}

void Sweep::stop_at(const SweepPoint& point) {
    constexpr std::size_t most = ConnectionGraph::none - 1;
    auto first = find_through(point);
    const auto number = static_cast<std::uint32_t>(graph_.vertices.size());
    ConnectionGraph::Vertex vertex = {point, static_cast<std::uint32_t>(graph_.edges.size())};
    end_edges(vertex, number, first);
    find_outgoing(point);
    first = place_outgoing(first);
    if (graph_.gaps.size() + outgoing_.size() >= most)
        throw std::length_error("a plane sweep has more than 2^32 parts of edges");
    graph_.vertices.push_back(vertex);
    begin_edges(first);
    counts_.crossings += point.is_crossing() ? 1 : 0;
    expect_crossing(before(first), first);
    if (outgoing_.empty())
        return;
    const auto last = rungs_[outgoing_.back()];
    expect_crossing(last, std::next(last));
}

ConnectionGraph Sweep::run(const Progress& progress, const CancelFlag* cancel) {
    SweepPoint point;
    while (take_point(point)) {
        stop_at(point);
        if (graph_.vertices.size() % 1024 != 0)
            continue;
        if (cancel != nullptr)
            cancel->throw_if_raised();
        if (progress)
            progress(static_cast<double>(next_corner_) / static_cast<double>(corners_.size()));
    }
    VERA_CHECK(status_.empty());
    if (!graph_.vertices.empty())
        graph_.vertices.push_back({{}, static_cast<std::uint32_t>(graph_.edges.size())});
    counts_.edges = graph_.edges.size();
    return std::move(graph_);
}

} // namespace

ConnectionGraph connection_graph(
    std::span<const SweepSegments::Segment> segments,
    std::size_t expected,
    PlaneSweepCounts& counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    return Sweep(segments, expected, counts).run(progress, cancel);
}

} // namespace vera
