// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/conjugation_tree.h"

#include "vera/base/available_memory.h"
#include "vera/base/check.h"
#include "vera/base/long_loop.h"
#include "vera/theory/ham_sandwich.h"
#include "vera/theory/plane_hull.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

Numbers all_numbers(std::size_t count) {
    Numbers numbers(count);
    std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
    return numbers;
}

} // namespace

class ConjugationTreeBuilder {
public:
    ConjugationTreeBuilder(
        ConjugationTree& tree,
        std::size_t leaf_size,
        const Progress& progress,
        const CancelFlag* cancel)
        : tree_(tree)
        , leaf_size_(std::max<std::size_t>(leaf_size, 1))
        , progress_(progress)
        , cancel_(cancel) {}

    void build() {
        const auto count = static_cast<std::uint32_t>(tree_.numbers_.size());
        if (count > 0)
            add_node(0, count, {1, 0});
        tree_.nodes_.shrink_to_fit();
        tree_.hulls_.shrink_to_fit();
    }

private:
    using Hull = PlaneHull;

    /// A node of the points from first to last, and all below it. Halves them along the direction.
    Hull add_node(std::uint32_t first, std::uint32_t last, PlaneDirection direction) {
        stop_if_raised(cancel_);
        const std::size_t number = tree_.nodes_.size();
        tree_.nodes_.push_back({first, last});
        Hull hull;
        if (last - first <= leaf_size_ || are_equal(first, last)) {
            hull = hull_of(tree_.points_, tree_.numbers_of(tree_.nodes_[number]));
            tell(last);
        } else {
            const std::uint32_t middle = first + (last - first) / 2;
            halve(first, middle, last, direction);
            const PlaneDirection next = conjugate(first, middle, last, direction);
            const Hull left = add_node(first, middle, next);
            tree_.nodes_[number].children = static_cast<std::uint32_t>(tree_.nodes_.size());
            const Hull right = add_node(middle, last, next);
            hull = hull_of(tree_.points_, left, right);
        }
        keep(tree_.nodes_[number], hull);
        return hull;
    }

    bool are_equal(std::uint32_t first, std::uint32_t last) const {
        const PlanePoint point = at(first);
        for (std::uint32_t i = first + 1; i < last; ++i)
            if (at(i) != point)
                return false;
        return true;
    }

    void
    halve(std::uint32_t first, std::uint32_t middle, std::uint32_t last, PlaneDirection direction) {
        const auto place = [&](std::uint32_t i) {
            return tree_.numbers_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(
            place(first),
            place(middle),
            place(last),
            [&, before = TurnedOrder{direction}](std::uint32_t a, std::uint32_t b) {
                return before(tree_.points_[a], tree_.points_[b]);
            });
    }

    /// The direction that halves both halves; any one where neither is divided.
    PlaneDirection conjugate(
        std::uint32_t first,
        std::uint32_t middle,
        std::uint32_t last,
        PlaneDirection direction) const {
        if (last - middle <= leaf_size_)
            return direction;
        std::vector<PlanePoint> points(last - first);
        for (std::uint32_t i = first; i < last; ++i)
            points[i - first] = at(i);
        const auto halves = std::span<const PlanePoint>(points);
        return conjugate_direction(
            halves.first(middle - first), halves.subspan(middle - first), direction, first);
    }

    void keep(ConjugationNode& node, const Hull& hull) {
        std::vector<std::uint32_t>& hulls = tree_.hulls_;
        node.below = static_cast<std::uint32_t>(hulls.size());
        hulls.insert(hulls.end(), hull.below.begin(), hull.below.end());
        node.above = static_cast<std::uint32_t>(hulls.size());
        hulls.insert(hulls.end(), hull.above.begin(), hull.above.end());
        VERA_CHECK(hulls.size() <= std::numeric_limits<std::uint32_t>::max());
        node.hull_end = static_cast<std::uint32_t>(hulls.size());
    }

    void tell(std::uint32_t done) const {
        if (progress_)
            progress_(static_cast<double>(done) / static_cast<double>(tree_.numbers_.size()));
    }

    PlanePoint at(std::uint32_t place) const { return tree_.points_[tree_.numbers_[place]]; }

    ConjugationTree& tree_;
    std::size_t leaf_size_;
    const Progress& progress_;
    const CancelFlag* cancel_;
};

ConjugationTree::ConjugationTree(
    std::span<const PlanePoint> points,
    std::vector<std::uint32_t> numbers,
    std::size_t leaf_size,
    const Progress& progress,
    const CancelFlag* cancel)
    : points_(points)
    , numbers_(std::move(numbers)) {
    ConjugationTreeBuilder(*this, leaf_size, progress, cancel).build();
}

ConjugationTree::ConjugationTree(
    std::span<const PlanePoint> points,
    std::size_t leaf_size,
    const Progress& progress,
    const CancelFlag* cancel)
    : points_(points)
    , numbers_(all_numbers(points.size())) {
    require_plane_points(points);
    require_memory(
        bytes_forecast(points.size(), leaf_size)
            + static_cast<double>(points.size() * building_bytes_per_point),
        "a conjugation tree of " + std::to_string(points.size()) + " points",
        "fewer points, and leaves of more than " + std::to_string(leaf_size)
            + " points, take less");
    ConjugationTreeBuilder(*this, leaf_size, progress, cancel).build();
}

Inclusion ConjugationTree::inclusion(
    const ConjugationNode& node, const PlaneStrip& strip, QueryCounts& counts) const {
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
void ConjugationTree::search(
    const PlaneStrip& strip, QueryCounts& counts, const Whole& whole, const Single& single) const {
    require_plane_strip(strip);
    std::vector<std::uint32_t> waiting;
    if (!nodes_.empty())
        waiting.push_back(0);
    while (!waiting.empty()) {
        const std::uint32_t number = waiting.back();
        waiting.pop_back();
        const ConjugationNode& node = nodes_[number];
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

std::size_t ConjugationTree::count(const PlaneStrip& strip, QueryCounts* counts) const {
    QueryCounts steps;
    std::size_t found = 0;
    search(
        strip,
        counts != nullptr ? *counts : steps,
        [&](const ConjugationNode& node) { found += node.size(); },
        [&](std::uint32_t) { ++found; });
    return found;
}

std::vector<std::uint32_t>
ConjugationTree::numbers_in(const PlaneStrip& strip, QueryCounts* counts) const {
    QueryCounts steps;
    Numbers found;
    search(
        strip,
        counts != nullptr ? *counts : steps,
        [&](const ConjugationNode& node) {
            const auto numbers = numbers_of(node);
            found.insert(found.end(), numbers.begin(), numbers.end());
        },
        [&](std::uint32_t number) { found.push_back(number); });
    std::sort(found.begin(), found.end());
    return found;
}

std::size_t ConjugationTree::bytes() const {
    return nodes_.capacity() * sizeof(ConjugationNode)
        + (numbers_.capacity() + hulls_.capacity()) * sizeof(std::uint32_t);
}

double ConjugationTree::bytes_forecast(std::size_t count, std::size_t leaf_size) {
    auto bytes = static_cast<double>(count * sizeof(std::uint32_t));
    std::size_t size = count;
    for (double nodes = 1; size > 0; nodes *= 2) {
        // All points are vertices at worst, and the ends of the chains are there twice.
        bytes += nodes
            * static_cast<double>(sizeof(ConjugationNode) + (size + 2) * sizeof(std::uint32_t));
        if (size <= std::max<std::size_t>(leaf_size, 1))
            break;
        size = (size + 1) / 2;
    }
    return bytes;
}

} // namespace vera
