// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/window_tree.h"

#include "vera/base/check.h"
#include "vera/theory/stabbing_tree.h"

#include <algorithm>
#include <bit>
#include <iterator>

namespace vera {

namespace {

/// What comes in an order of segments before all that lie at the number.
WindowSegment first_at(std::int32_t across) {
    return {across, {-1, -1}};
}

/// A power of 2.
std::size_t leaves_over(std::int32_t places) {
    return std::bit_ceil(static_cast<std::size_t>(std::max(places, 1)));
}

} // namespace

WindowCounts& WindowCounts::operator+=(const WindowCounts& more) {
    nodes += more.nodes;
    comparisons += more.comparisons;
    found += more.found;
    return *this;
}

bool WindowTree::InOrder::operator()(const WindowSegment& a, const WindowSegment& b) const {
    ++counts->comparisons;
    return a.across != b.across ? a.across < b.across : a.along.begin < b.along.begin;
}

WindowTree::WindowTree(std::int32_t places, WindowCounts& counts)
    : leaves_(leaves_over(places))
    , counts_(counts)
    , over_(2 * leaves_, Node(InOrder{&counts}))
    , beginning_(over_) {}

double WindowTree::bytes_without_segments(std::int32_t places) {
    return 4 * static_cast<double>(leaves_over(places)) * sizeof(Node);
}

/// A range is at most two nodes of each level below the root's children, or one node, and where it
/// begins is in one node of each level.
std::size_t WindowTree::most_entries_of_segment() const {
    const auto levels = static_cast<std::size_t>(std::bit_width(leaves_)); // with the leaves'
    return std::max<std::size_t>(2 * levels, 5) - 4 + levels;
}

/// Calls visit(node) for all that have the segment.
template <typename Visit>
void WindowTree::for_each_node_of(const WindowSegment& segment, const Visit& visit) {
    VERA_CHECK(0 <= segment.along.begin && segment.along.begin < segment.along.end);
    const auto first = static_cast<std::size_t>(segment.along.begin);
    const auto last = static_cast<std::size_t>(segment.along.end) - 1;
    VERA_CHECK(last < leaves_);
    const auto visit_in = [&](std::vector<Node>& nodes, std::size_t number) {
        ++counts_.nodes;
        visit(nodes[number]);
    };
    for_each_canonical_node(
        leaves_, first, last, [&](std::size_t number) { visit_in(over_, number); });
    for (std::size_t number = first + leaves_; number > 0; number /= 2)
        visit_in(beginning_, number);
}

void WindowTree::insert(const WindowSegment& segment) {
    for_each_node_of(segment, [&](Node& node) {
        VERA_CHECK(node.insert(segment).second);
        ++entry_count_;
    });
}

void WindowTree::remove(const WindowSegment& segment) {
    for_each_node_of(segment, [&](Node& node) {
        VERA_CHECK(node.erase(segment) == 1);
        --entry_count_;
    });
}

void WindowTree::append_of_node(
    const Node& node, PlaceRange across, std::vector<WindowSegment>& found) const {
    ++counts_.nodes;
    for (auto at = node.lower_bound(first_at(across.begin));
         at != node.end() && at->across < across.end;
         ++at) {
        ++counts_.found;
        found.push_back(*at);
    }
}

std::vector<WindowSegment> WindowTree::in_window(PlaceRange along, PlaceRange across) const {
    std::vector<WindowSegment> found;
    const auto first = static_cast<std::size_t>(along.begin);
    const auto last = static_cast<std::size_t>(along.end) - 1;
    // Of the nodes with a place, at most one has the same segment.
    for (std::size_t number = first + leaves_; number > 0; number /= 2)
        append_of_node(over_[number], across, found);
    if (first < last)
        for_each_canonical_node(leaves_, first + 1, last, [&](std::size_t number) {
            append_of_node(beginning_[number], across, found);
        });
    std::sort(found.begin(), found.end(), InOrder{&counts_});
    return found;
}

std::optional<WindowSegment>
WindowTree::last_before(std::int32_t place, std::int32_t across) const {
    std::optional<WindowSegment> last;
    for (std::size_t number = static_cast<std::size_t>(place) + leaves_; number > 0; number /= 2) {
        ++counts_.nodes;
        const Node& node = over_[number];
        const auto behind = node.lower_bound(first_at(across));
        if (behind != node.begin() && (!last || last->across < std::prev(behind)->across))
            last = *std::prev(behind);
    }
    return last;
}

} // namespace vera
