// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/partition_tree.h"

#include "vera/base/available_memory.h"
#include "vera/base/check.h"
#include "vera/base/long_loop.h"
#include "vera/theory/plane_hull.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace vera {

namespace {

PlaneHull taken_last(std::vector<PlaneHull>& hulls) {
    PlaneHull last = std::move(hulls.back());
    hulls.pop_back();
    return last;
}

void append(const PlaneHull& hull, PartitionNode& node, std::vector<std::uint32_t>& vertices) {
    node.below = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), hull.below.begin(), hull.below.end());
    node.above = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), hull.above.begin(), hull.above.end());
    VERA_CHECK(vertices.size() <= std::numeric_limits<std::uint32_t>::max());
    node.hull_end = static_cast<std::uint32_t>(vertices.size());
}

} // namespace

std::vector<std::uint32_t> all_numbers(std::size_t count) {
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
    return numbers;
}

void require_tree(
    const std::string& kind,
    std::span<const PlanePoint> points,
    std::size_t leaf_size,
    double bytes) {
    require_plane_points(points);
    require_memory(
        bytes,
        kind + " of " + std::to_string(points.size()) + " points",
        "fewer points, and leaves of more than " + std::to_string(leaf_size)
            + " points, take less");
}

StepCounts& StepCounts::operator+=(const StepCounts& more) {
    nodes += more.nodes;
    vertices += more.vertices;
    points += more.points;
    searches += more.searches;
    counters += more.counters;
    reports += more.reports;
    return *this;
}

PartitionTree::PartitionTree(
    std::span<const PlanePoint> points,
    TreeShape shape,
    const Progress& progress,
    const CancelFlag* cancel)
    : points_(points)
    , numbers_(std::move(shape.numbers))
    , nodes_(std::move(shape.nodes)) {
    add_hulls(progress, cancel);
    nodes_.shrink_to_fit();
    hulls_.shrink_to_fit();
}

void PartitionTree::add_hulls(const Progress& progress, const CancelFlag* cancel) {
    // From the last node to the root: the hulls of children are there before their parent's, that
    // of the first child on top.
    std::vector<PlaneHull> waiting;
    const LongLoop loop(nodes_.size(), progress, cancel, 64);
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        loop.turn(nodes_.size() - 1 - i);
        PartitionNode& node = nodes_[i];
        PlaneHull hull;
        if (node.is_leaf()) {
            hull = hull_of(points_, numbers_of(node));
        } else {
            const PlaneHull first = taken_last(waiting);
            hull = hull_of(points_, first, taken_last(waiting));
        }
        append(hull, node, hulls_);
        waiting.push_back(std::move(hull));
    }
    if (progress)
        progress(1);
}

Inclusion PartitionTree::inclusion(
    const PartitionNode& node, const PlaneStrip& strip, StepCounts& counts) const {
    const auto hulls = std::span<const std::uint32_t>(hulls_);
    const HullExtent extent = extent_along(
        strip.normal,
        points_,
        hulls.subspan(node.below, node.above - node.below),
        hulls.subspan(node.above, node.hull_end - node.above));
    ++counts.nodes;
    counts.vertices += extent.vertices;
    if (extent.highest < strip.lowest || strip.highest < extent.lowest)
        return Inclusion::none;
    return strip.lowest <= extent.lowest && extent.highest <= strip.highest ? Inclusion::all
                                                                            : Inclusion::some;
}

template <typename Whole, typename Single>
void PartitionTree::search(
    const PlaneStrip& strip, StepCounts& counts, const Whole& whole, const Single& single) const {
    require_plane_strip(strip);
    std::vector<std::uint32_t> waiting;
    if (!nodes_.empty())
        waiting.push_back(0);
    while (!waiting.empty()) {
        const std::uint32_t number = waiting.back();
        waiting.pop_back();
        const PartitionNode& node = nodes_[number];
        const Inclusion included = inclusion(node, strip, counts);
        if (included == Inclusion::all) {
            whole(node);
        } else if (included == Inclusion::some && node.is_leaf()) {
            counts.points += node.size();
            for (const std::uint32_t point : numbers_of(node))
                if (contains(strip, points_[point]))
                    single(point);
        } else if (included == Inclusion::some) {
            waiting.push_back(node.children);
            waiting.push_back(number + 1);
        }
    }
}

std::size_t PartitionTree::count(const PlaneStrip& strip, StepCounts* counts) const {
    StepCounts steps;
    std::size_t found = 0;
    search(
        strip,
        counts != nullptr ? *counts : steps,
        [&](const PartitionNode& node) { found += node.size(); },
        [&](std::uint32_t) { ++found; });
    return found;
}

std::vector<std::uint32_t>
PartitionTree::numbers_in(const PlaneStrip& strip, StepCounts* counts) const {
    StepCounts steps;
    std::vector<std::uint32_t> found;
    search(
        strip,
        counts != nullptr ? *counts : steps,
        [&](const PartitionNode& node) {
            const auto numbers = numbers_of(node);
            found.insert(found.end(), numbers.begin(), numbers.end());
        },
        [&](std::uint32_t number) { found.push_back(number); });
    std::sort(found.begin(), found.end());
    return found;
}

std::size_t PartitionTree::bytes() const {
    return nodes_.capacity() * sizeof(PartitionNode)
        + (numbers_.capacity() + hulls_.capacity()) * sizeof(std::uint32_t);
}

double halved_bytes_forecast(std::size_t count, std::size_t leaf_size) {
    auto bytes = static_cast<double>(count * sizeof(std::uint32_t));
    std::size_t size = count;
    for (double nodes = 1; size > 0; nodes *= 2) {
        // All points are vertices at worst, and the ends of the chains are there twice.
        bytes +=
            nodes * static_cast<double>(sizeof(PartitionNode) + (size + 2) * sizeof(std::uint32_t));
        if (size <= std::max<std::size_t>(leaf_size, 1))
            break;
        size = (size + 1) / 2;
    }
    return bytes;
}

} // namespace vera
