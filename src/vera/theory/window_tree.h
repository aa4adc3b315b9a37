// SPDX-License-Identifier: Apache-2.0
// Windowing queries: of parallel segments that come and go, those that reach into a window. A
// segment does so where it lies over the place at which the window begins, or begins behind that
// within the window. The first are found by a segment tree, the second by a range tree; both have a
// node for each range of places that halving leads to, with its segments in their order across (de
// Berg, Cheong, van Kreveld and Overmars, Computational Geometry, 2008, chapter 10). A segment is
// an entry of O(log n) nodes, and a window of O(log n) nodes finds its first by O(log n)
// comparisons in each: O(log^2 n) for a change, and O(log^2 n + found) for a query.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

namespace vera {

/// Places along an axis, from `begin` on and before `end`.
struct PlaceRange {
    std::int32_t begin = 0;
    std::int32_t end = 0;

    bool contains(std::int32_t place) const { return begin <= place && place < end; }

    friend constexpr bool operator==(PlaceRange, PlaceRange) = default;
};

/// A segment over those places, which are some, across at a whole number.
struct WindowSegment {
    std::int32_t across = 0;
    PlaceRange along;

    friend constexpr bool operator==(const WindowSegment&, const WindowSegment&) = default;
};

/// The steps of window trees. They add up.
struct WindowCounts {
    std::uint64_t nodes = 0;       ///< of trees, that were come to
    std::uint64_t comparisons = 0; ///< of entries, in the nodes' orders
    std::uint64_t found = 0;       ///< segments, in windows

    WindowCounts& operator+=(const WindowCounts& more);

    std::uint64_t steps() const { return nodes + comparisons + found; }
};

class WindowTree {
public:
    /// For segments over places from 0 on and before `places`. The counts must outlive the tree.
    WindowTree(std::int32_t places, WindowCounts& counts);
    WindowTree(const WindowTree&) = delete;
    WindowTree& operator=(const WindowTree&) = delete;

    /// No other segment may be at one of its places at the same number across.
    void insert(const WindowSegment& segment);

    /// It must be there.
    void remove(const WindowSegment& segment);

    /// Those with some place in common with `along`, which lie at a number of `across`: by that
    /// number, then by where they begin.
    std::vector<WindowSegment> in_window(PlaceRange along, PlaceRange across) const;

    /// Over the place the last one before that number across.
    std::optional<WindowSegment> last_before(std::int32_t place, std::int32_t across) const;

    /// Of all nodes together.
    std::size_t entry_count() const { return entry_count_; }

    /// That a segment may become.
    std::size_t most_entries_of_segment() const;

    /// Of memory, for an entry: about.
    static constexpr std::size_t bytes_of_entry = 48;

    /// Of memory, without any segment.
    static double bytes_without_segments(std::int32_t places);

private:
    /// Across, then along.
    struct InOrder {
        bool operator()(const WindowSegment& a, const WindowSegment& b) const;

        WindowCounts* counts;
    };

    using Node = std::set<WindowSegment, InOrder>;

    template <typename Visit>
    void for_each_node_of(const WindowSegment& segment, const Visit& visit);
    void
    append_of_node(const Node& node, PlaceRange across, std::vector<WindowSegment>& found) const;

    std::size_t leaves_ = 1; ///< a power of 2; the root is 1, the children of i are 2 i and 2 i + 1
    std::size_t entry_count_ = 0;
    WindowCounts& counts_;
    std::vector<Node> over_;      ///< segments are in the nodes that together are their places
    std::vector<Node> beginning_; ///< and in those with the place at which they begin
};

} // namespace vera
