// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/window_tree.h"

#include "vera/base/check.h"
#include "vera/theory/stabbing_tree.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>

namespace vera {

namespace {

constexpr std::int32_t before_all = std::numeric_limits<std::int32_t>::min();

/// What comes in an order of segments before all that lie at the number.
WindowSegment first_at(std::int32_t across) {
    return {across, {before_all, before_all}};
}

} // namespace

WindowCounts& WindowCounts::operator+=(const WindowCounts& more) {
    nodes += more.nodes;
    comparisons += more.comparisons;
    found += more.found;
    return *this;
}

bool WindowTree::ByPlace::operator()(const Entry& a, const Entry& b) const {
    ++counts->comparisons;
    if (a.node != b.node)
        return a.node < b.node;
    if (a.segment.across != b.segment.across)
        return a.segment.across < b.segment.across;
    return a.segment.along.begin < b.segment.along.begin;
}

WindowTree::WindowTree(std::int32_t places, WindowCounts& counts)
    : leaves_(std::bit_ceil(static_cast<std::size_t>(std::max(places, 1))))
    , counts_(counts)
    , over_(ByPlace{&counts})
    , beginning_(ByPlace{&counts}) {}

/// Calls visit(entries, entry) for all that the segment has.
template <typename Visit>
void WindowTree::for_each_entry_of(const WindowSegment& segment, const Visit& visit) {
    VERA_CHECK(0 <= segment.along.begin && segment.along.begin < segment.along.end);
    const auto first = static_cast<std::size_t>(segment.along.begin);
    const auto last = static_cast<std::size_t>(segment.along.end) - 1;
    VERA_CHECK(last < leaves_);
    const auto visit_in = [&](Entries& entries, std::size_t node) {
        ++counts_.nodes;
        visit(entries, Entry{static_cast<std::uint32_t>(node), segment});
    };
    for_each_canonical_node(leaves_, first, last, [&](std::size_t node) { visit_in(over_, node); });
    for (std::size_t node = first + leaves_; node > 0; node /= 2)
        visit_in(beginning_, node);
}

void WindowTree::insert(const WindowSegment& segment) {
    for_each_entry_of(segment, [](Entries& entries, const Entry& entry) {
        VERA_CHECK(entries.insert(entry).second);
    });
}

void WindowTree::remove(const WindowSegment& segment) {
    for_each_entry_of(segment, [](Entries& entries, const Entry& entry) {
        VERA_CHECK(entries.erase(entry) == 1);
    });
}

void WindowTree::append_of_node(
    const Entries& entries,
    std::size_t node,
    PlaceRange across,
    std::vector<WindowSegment>& found) const {
    ++counts_.nodes;
    const auto number = static_cast<std::uint32_t>(node);
    for (auto at = entries.lower_bound({number, first_at(across.begin)});
         at != entries.end() && at->node == number && at->segment.across < across.end;
         ++at) {
        ++counts_.found;
        found.push_back(at->segment);
    }
}

std::vector<WindowSegment> WindowTree::in_window(PlaceRange along, PlaceRange across) const {
    std::vector<WindowSegment> found;
    const auto first = static_cast<std::size_t>(along.begin);
    const auto last = static_cast<std::size_t>(along.end) - 1;
    // Of the nodes with a place, at most one has the same segment.
    for (std::size_t node = first + leaves_; node > 0; node /= 2)
        append_of_node(over_, node, across, found);
    if (first < last)
        for_each_canonical_node(leaves_, first + 1, last, [&](std::size_t node) {
            append_of_node(beginning_, node, across, found);
        });
    std::sort(found.begin(), found.end(), [&](const WindowSegment& a, const WindowSegment& b) {
        ++counts_.comparisons;
        return a.across != b.across ? a.across < b.across : a.along.begin < b.along.begin;
    });
    return found;
}

std::optional<WindowSegment>
WindowTree::last_before(std::int32_t place, std::int32_t across) const {
    std::optional<WindowSegment> last;
    for (std::size_t node = static_cast<std::size_t>(place) + leaves_; node > 0; node /= 2) {
        ++counts_.nodes;
        const auto number = static_cast<std::uint32_t>(node);
        const auto behind = over_.lower_bound({number, first_at(across)});
        if (behind == over_.begin())
            continue;
        const Entry& entry = *std::prev(behind);
        if (entry.node == number && (!last || last->across < entry.segment.across))
            last = entry.segment;
    }
    return last;
}

} // namespace vera
