// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/stabbing_tree.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <queue>
#include <utility>

namespace vera {

namespace {

/// Lists of nodes one behind the other, each in the order in which its members are given.
template <typename Member>
struct NodeLists {
    std::vector<std::uint32_t> starts; ///< of each node, and the end
    std::vector<Member> members;
};

/// for_each(add) calls add(node, member) for each, the same ones each time.
template <typename Member, typename ForEach>
NodeLists<Member> node_lists(std::size_t nodes, const ForEach& for_each) {
    NodeLists<Member> lists;
    lists.starts.assign(nodes + 1, 0);
    for_each([&](std::size_t node, const Member&) { ++lists.starts[node + 1]; });
    for (std::size_t i = 1; i < lists.starts.size(); ++i)
        lists.starts[i] += lists.starts[i - 1];
    lists.members.resize(lists.starts.back());
    std::vector<std::uint32_t> next(lists.starts.begin(), lists.starts.end() - 1);
    for_each([&](std::size_t node, const Member& member) { lists.members[next[node]++] = member; });
    return lists;
}

} // namespace

StabbingTree::StabbingTree(
    Stabbing kind,
    std::span<const PivotRange> across,
    std::size_t places_across,
    std::span<const PivotRange> along)
    : kind_(kind)
    , leaves_(std::bit_ceil(places_across)) {
    NodeLists<Entry> lists = node_lists<Entry>(2 * leaves_, [&](const auto& add) {
        for (std::size_t i = 0; i < across.size(); ++i)
            if (!across[i].is_empty() && !along[i].is_empty())
                for_each_canonical_node(
                    leaves_, across[i].first, across[i].last, [&](std::size_t node) {
                        add(node, Entry{along[i], static_cast<RectangleRank>(i)});
                    });
    });
    starts_ = std::move(lists.starts);
    entries_ = std::move(lists.members);
    inner_of_.assign(2 * leaves_, 0);
    for (std::size_t node = 1; node < 2 * leaves_; ++node)
        if (entries_of(node).size() > few) {
            inner_.push_back(inner_of(entries_of(node)));
            inner_of_[node] = static_cast<std::uint32_t>(inner_.size());
        }
    inner_.shrink_to_fit();
}

std::span<const StabbingTree::Entry> StabbingTree::entries_of(std::size_t node) const {
    return std::span(entries_).subspan(starts_[node], starts_[node + 1] - starts_[node]);
}

StabbingTree::Inner StabbingTree::inner_of(std::span<const Entry> entries) const {
    Inner inner;
    inner.borders.reserve(2 * entries.size());
    for (const Entry& entry : entries) {
        inner.borders.push_back(entry.along.first);
        inner.borders.push_back(static_cast<PivotPlace>(entry.along.last + 1));
    }
    std::sort(inner.borders.begin(), inner.borders.end());
    inner.borders.erase(
        std::unique(inner.borders.begin(), inner.borders.end()), inner.borders.end());
    inner.borders.shrink_to_fit();
    return kind_ == Stabbing::first_of_all ? first_ranks(entries, std::move(inner))
                                           : sorted_ranks(entries, std::move(inner));
}

std::size_t StabbingTree::Inner::part_of(PivotPlace along, DualCounts& counts) const {
    const auto behind = std::partition_point(borders.begin(), borders.end(), [&](PivotPlace at) {
        ++counts.comparisons;
        return at <= along;
    });
    return static_cast<std::size_t>(behind - borders.begin());
}

StabbingTree::Inner StabbingTree::first_ranks(std::span<const Entry> entries, Inner inner) {
    inner.ranks.assign(inner.borders.size() + 1, none);
    // Entries ascend by rank: what a part has first stays.
    std::vector<Entry> by_first(entries.begin(), entries.end());
    std::sort(by_first.begin(), by_first.end(), [](const Entry& a, const Entry& b) {
        return a.along.first < b.along.first;
    });
    using Open = std::pair<RectangleRank, PivotPlace>; // rank, last place
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    std::size_t next = 0;
    for (std::size_t part = 1; part <= inner.borders.size(); ++part) {
        const PivotPlace begin = inner.borders[part - 1];
        for (; next < by_first.size() && by_first[next].along.first <= begin; ++next)
            open.push({by_first[next].rank, by_first[next].along.last});
        while (!open.empty() && open.top().second < begin)
            open.pop();
        if (!open.empty())
            inner.ranks[part] = open.top().first;
    }
    return inner;
}

StabbingTree::Inner StabbingTree::sorted_ranks(std::span<const Entry> entries, Inner inner) {
    const std::size_t leaves = std::bit_ceil(inner.borders.size() + 1);
    DualCounts of_building;
    NodeLists<RectangleRank> lists = node_lists<RectangleRank>(2 * leaves, [&](const auto& add) {
        for (const Entry& entry : entries)
            for_each_canonical_node(
                leaves,
                inner.part_of(entry.along.first, of_building),
                inner.part_of(entry.along.last, of_building),
                [&](std::size_t node) { add(node, entry.rank); });
    });
    inner.starts = std::move(lists.starts);
    inner.ranks = std::move(lists.members);
    return inner;
}

/// Calls of_entry(rank) for ranks that hold the place one by one, and of_inner(list) for sorted
/// lists of ranks that do.
template <typename OfEntry, typename OfInner>
void StabbingTree::visit(
    PivotPlace across,
    PivotPlace along,
    DualCounts& counts,
    const OfEntry& of_entry,
    const OfInner& of_inner) const {
    for (std::size_t node = across + leaves_; node > 0; node /= 2) {
        ++counts.nodes;
        if (inner_of_[node] == 0) {
            for (const Entry& entry : entries_of(node)) {
                ++counts.rectangles;
                if (entry.along.contains(along))
                    of_entry(entry.rank);
            }
            continue;
        }
        const Inner& inner = inner_[inner_of_[node] - 1];
        const std::size_t part = inner.part_of(along, counts);
        if (kind_ == Stabbing::first_of_all) {
            of_inner(std::span(inner.ranks).subspan(part, 1));
            continue;
        }
        const std::size_t leaves = (inner.starts.size() - 1) / 2;
        for (std::size_t i = part + leaves; i > 0; i /= 2) {
            ++counts.nodes;
            of_inner(std::span(inner.ranks)
                         .subspan(inner.starts[i], inner.starts[i + 1] - inner.starts[i]));
        }
    }
}

std::optional<RectangleRank>
StabbingTree::first(PivotPlace across, PivotPlace along, DualCounts& counts) const {
    RectangleRank best = none;
    const auto take = [&](RectangleRank rank) { best = std::min(best, rank); };
    visit(across, along, counts, take, [&](std::span<const RectangleRank> ranks) {
        if (!ranks.empty())
            take(ranks.front());
    });
    return best == none ? std::nullopt : std::optional(best);
}

std::optional<RectangleRank> StabbingTree::first_from(
    PivotPlace across, PivotPlace along, std::uint32_t least, DualCounts& counts) const {
    RectangleRank best = none;
    const auto take = [&](RectangleRank rank) {
        if (rank >= least)
            best = std::min(best, rank);
    };
    visit(across, along, counts, take, [&](std::span<const RectangleRank> ranks) {
        const auto found = std::partition_point(ranks.begin(), ranks.end(), [&](RectangleRank at) {
            ++counts.comparisons;
            return at < least;
        });
        if (found != ranks.end())
            take(*found);
    });
    return best == none ? std::nullopt : std::optional(best);
}

std::optional<RectangleRank> StabbingTree::last_before(
    PivotPlace across, PivotPlace along, std::uint32_t end, DualCounts& counts) const {
    std::optional<RectangleRank> best;
    const auto take = [&](RectangleRank rank) {
        if (rank < end && (!best || rank > *best))
            best = rank;
    };
    visit(across, along, counts, take, [&](std::span<const RectangleRank> ranks) {
        const auto found = std::partition_point(ranks.begin(), ranks.end(), [&](RectangleRank at) {
            ++counts.comparisons;
            return at < end;
        });
        if (found != ranks.begin())
            take(*(found - 1));
    });
    return best;
}

std::size_t StabbingTree::bytes() const {
    std::size_t bytes = sizeof(StabbingTree) + starts_.capacity() * sizeof(std::uint32_t)
        + entries_.capacity() * sizeof(Entry) + inner_of_.capacity() * sizeof(std::uint32_t)
        + inner_.capacity() * sizeof(Inner);
    for (const Inner& inner : inner_)
        bytes += inner.borders.capacity() * sizeof(PivotPlace)
            + inner.ranks.capacity() * sizeof(RectangleRank)
            + inner.starts.capacity() * sizeof(std::uint32_t);
    return bytes;
}

double StabbingTree::bytes_forecast(Stabbing kind, std::size_t rectangles) {
    const std::size_t leaves = std::bit_ceil(4 * rectangles + 1);
    const auto levels = static_cast<double>(std::bit_width(leaves) - 1);
    // A range is held by two nodes of each level at most.
    const double entries = static_cast<double>(rectangles) * 2 * std::max(levels, 1.0);
    double bytes = sizeof(StabbingTree)
        + 2 * static_cast<double>(leaves + 1) * 2 * sizeof(std::uint32_t) + entries * sizeof(Entry);
    const double inner_entries = rectangles > few ? entries : 0;
    // Borders, and an Inner of few + 1 at least.
    double each = 2 * sizeof(PivotPlace) + static_cast<double>(sizeof(Inner)) / (few + 1);
    if (kind == Stabbing::first_of_all)
        each += 3 * sizeof(RectangleRank);
    else
        each += 2 * static_cast<double>(std::bit_width(2 * rectangles)) * sizeof(RectangleRank)
            + 9 * sizeof(std::uint32_t);
    return bytes + inner_entries * each;
}

} // namespace vera
