// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/nested_trees.h"

#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"
#include "vera/theory/conjugation_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace vera {

namespace {

constexpr std::size_t last_condition = side_condition_count - 1;

using Numbers = std::vector<std::uint32_t>;

std::array<SideCondition, side_condition_count> conditions_in(ConditionOrder order) {
    using enum SideCondition;
    if (order == ConditionOrder::y_first)
        return {below_upper_y, above_lower_y, below_upper_x, above_lower_x};
    return {below_upper_x, above_lower_x, below_upper_y, above_lower_y};
}

} // namespace

class NestedTreesBuilder {
public:
    NestedTreesBuilder(NestedTrees& trees, const Progress& progress, const CancelFlag* cancel)
        : trees_(trees)
        , progress_(progress)
        , cancel_(cancel) {}

    void build() {
        Numbers all(trees_.rectangles_.size());
        std::iota(all.begin(), all.end(), std::uint32_t{0});
        trees_.outermost_ = level(0, std::move(all));
        if (progress_)
            progress_(1);
    }

private:
    using Level = NestedTrees::Level;

    std::unique_ptr<Level> level(std::size_t condition, Numbers numbers) {
        auto made = std::make_unique<Level>();
        made->tree = partition_tree(
            trees_.kind_,
            trees_.points_.at(condition),
            std::move(numbers),
            trees_.few_,
            {},
            cancel_,
            EqualPoints::together);
        const std::span<const PartitionNode> nodes = made->tree.nodes();
        made->nearness.reserve(nodes.size());
        for (const PartitionNode& node : nodes)
            made->nearness.push_back(nearness_of(trees_.rectangles_, made->tree.numbers_of(node)));
        if (condition < last_condition)
            add_inner(*made, condition);
        else if (!nodes.empty())
            add_all_sorted(*made);
        return made;
    }

    void add_inner(Level& level, std::size_t condition) {
        const std::span<const PartitionNode> nodes = level.tree.nodes();
        level.inner.resize(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes[i].size() <= trees_.few_)
                continue;
            const auto numbers = level.tree.numbers_of(nodes[i]);
            level.inner[i] = this->level(condition + 1, Numbers(numbers.begin(), numbers.end()));
            if (condition == 0 && progress_)
                progress_(static_cast<double>(i) / static_cast<double>(nodes.size()));
        }
    }

    void add_all_sorted(Level& level) {
        level.by_z.assign(depths_of_many(level, 0), Numbers(level.tree.numbers().size()));
        add_sorted(level, 0, 0);
    }

    /// Of nodes of more than few, from that node on downwards.
    std::size_t depths_of_many(const Level& level, std::uint32_t number) const {
        const PartitionNode& node = level.tree.nodes()[number];
        if (node.size() <= trees_.few_)
            return 0;
        if (node.is_leaf())
            return 1;
        return 1
            + std::max(depths_of_many(level, number + 1), depths_of_many(level, node.children));
    }

    void add_sorted(Level& level, std::uint32_t number, std::size_t depth) {
        const PartitionNode& node = level.tree.nodes()[number];
        if (node.size() <= trees_.few_)
            return;
        const auto numbers = level.tree.numbers_of(node);
        const auto first = level.by_z[depth].begin() + static_cast<std::ptrdiff_t>(node.first);
        const auto last = std::copy(numbers.begin(), numbers.end(), first);
        std::sort(first, last, [&](std::uint32_t a, std::uint32_t b) {
            const std::int32_t z_of_a = trees_.rectangles_[a].z;
            const std::int32_t z_of_b = trees_.rectangles_[b].z;
            return z_of_a != z_of_b ? z_of_a < z_of_b : a < b;
        });
        if (node.is_leaf())
            return;
        add_sorted(level, number + 1, depth + 1);
        add_sorted(level, node.children, depth + 1);
    }

    NestedTrees& trees_;
    const Progress& progress_;
    const CancelFlag* cancel_;
};

/// One ray's way through the trees.
class RectangleSearch {
public:
    RectangleSearch(const NestedTrees& trees, const WholeRay& ray, StepCounts& counts)
        : trees_(trees)
        , ray_(ray)
        , counts_(counts)
        , first_(trees.rectangles_, ray) {
        const auto half_planes = condition_half_planes(ray);
        for (std::size_t i = 0; i < side_condition_count; ++i)
            half_planes_.at(i) = half_planes.at(static_cast<std::size_t>(trees.conditions_.at(i)));
    }

    std::optional<std::uint32_t> first() {
        search(*trees_.outermost_, 0, 0, 0);
        return first_.number();
    }

private:
    using Level = NestedTrees::Level;

    /// What of the node's rectangles meets the conditions from that one on; they meet those before.
    void
    search(const Level& level, std::size_t condition, std::uint32_t number, std::size_t depth) {
        if (level.tree.nodes().empty() || !first_.may_be_in(level.nearness[number]))
            return;
        const PartitionNode& node = level.tree.nodes()[number];
        switch (level.tree.inclusion(node, half_planes_.at(condition), counts_)) {
        case Inclusion::none:
            return;
        case Inclusion::all:
            if (node.size() <= trees_.few_)
                look_at_each(level.tree.numbers_of(node), condition + 1);
            else if (condition == last_condition)
                take_first_of(std::span(level.by_z[depth]).subspan(node.first, node.size()));
            else
                search(*level.inner[number], condition + 1, 0, 0);
            return;
        case Inclusion::some:
            if (node.is_leaf())
                look_at_each(level.tree.numbers_of(node), condition);
            else
                search_children(level, condition, number, depth);
        }
    }

    void search_children(
        const Level& level, std::size_t condition, std::uint32_t number, std::size_t depth) {
        std::uint32_t nearer = number + 1;
        std::uint32_t farther = level.tree.nodes()[number].children;
        if (first_.is_nearer_in(level.nearness[farther], level.nearness[nearer]))
            std::swap(nearer, farther);
        search(level, condition, nearer, depth + 1);
        search(level, condition, farther, depth + 1);
    }

    void look_at_each(std::span<const std::uint32_t> numbers, std::size_t condition) {
        counts_.points += numbers.size();
        for (const std::uint32_t number : numbers) {
            bool is_met = is_ahead(ray_, trees_.rectangles_[number].z);
            for (std::size_t i = condition; is_met && i < side_condition_count; ++i)
                is_met = contains(half_planes_.at(i), trees_.points_.at(i)[number]);
            if (is_met)
                first_.take(number);
        }
    }

    /// Of rectangles sorted by z that the ray's line meets.
    void take_first_of(std::span<const std::uint32_t> by_z) {
        ++counts_.searches;
        const auto z_below = [&](std::uint32_t number, std::int32_t z) {
            return trees_.rectangles_[number].z < z;
        };
        const auto z_above = [&](std::int32_t z, std::uint32_t number) {
            return z < trees_.rectangles_[number].z;
        };
        const std::int32_t start = ray_.origin[2];
        if (ray_.direction[2] > 0) {
            const auto found = std::lower_bound(by_z.begin(), by_z.end(), start, z_below);
            if (found != by_z.end())
                first_.take(*found);
            return;
        }
        const auto behind = std::upper_bound(by_z.begin(), by_z.end(), start, z_above);
        if (behind != by_z.begin())
            // Of those in its plane the one of the smallest number.
            first_.take(*std::lower_bound(
                by_z.begin(), behind, trees_.rectangles_[*(behind - 1)].z, z_below));
    }

    const NestedTrees& trees_;
    const WholeRay& ray_;
    std::array<PlaneStrip, side_condition_count> half_planes_;
    StepCounts& counts_;
    NearestRectangle first_;
};

std::size_t NestedTrees::usual_few(std::size_t rectangles) {
    return rectangles < 100'000 ? 32 : 256;
}

NestedTrees::NestedTrees(
    std::span<const IsoRectangle> rectangles,
    std::optional<std::size_t> few,
    const Progress& progress,
    const CancelFlag* cancel,
    TreeKind kind,
    ConditionOrder order)
    : conditions_(conditions_in(order))
    , few_(std::max<std::size_t>(few.value_or(usual_few(rectangles.size())), 1))
    , kind_(kind) {
    require_rectangles(rectangles);
    require_memory(
        bytes_forecast(rectangles.size(), few_, kind),
        "nesting trees of " + std::to_string(rectangles.size()) + " rectangles down to "
            + std::to_string(few_),
        "trees that end at more rectangles, as at " + std::to_string(8 * few_)
            + ", and trees of fewer rectangles take less");
    rectangles_.assign(rectangles.begin(), rectangles.end());
    for (std::size_t i = 0; i < side_condition_count; ++i) {
        points_.at(i).reserve(rectangles.size());
        for (const IsoRectangle& rectangle : rectangles)
            points_.at(i).push_back(condition_point(rectangle, conditions_.at(i)));
    }
    NestedTreesBuilder(*this, progress, cancel).build();
}

std::optional<std::uint32_t>
NestedTrees::first_rectangle(const WholeRay& ray, StepCounts* counts) const {
    StepCounts steps;
    return RectangleSearch(*this, ray, counts != nullptr ? *counts : steps).first();
}

std::size_t NestedTrees::bytes_of(const Level& level) {
    std::size_t bytes = sizeof(Level) + level.tree.bytes()
        + level.nearness.capacity() * sizeof(NearnessOfNode)
        + level.inner.capacity() * sizeof(std::unique_ptr<Level>)
        + level.by_z.capacity() * sizeof(Numbers);
    for (const Numbers& numbers : level.by_z)
        bytes += numbers.capacity() * sizeof(std::uint32_t);
    for (const std::unique_ptr<Level>& inner : level.inner)
        bytes += inner ? bytes_of(*inner) : 0;
    return bytes;
}

std::size_t NestedTrees::bytes() const {
    std::size_t bytes = rectangles_.capacity() * sizeof(IsoRectangle) + bytes_of(*outermost_);
    for (const std::vector<PlanePoint>& points : points_)
        bytes += points.capacity() * sizeof(PlanePoint);
    return bytes;
}

double
NestedTrees::level_bytes_forecast(std::size_t condition, std::size_t count, std::size_t few) {
    double bytes = sizeof(Level) + halved_bytes_forecast(count, few);
    double nodes = 1;
    for (std::size_t size = count; size > 0; size = (size + 1) / 2, nodes *= 2) {
        bytes += nodes * (sizeof(NearnessOfNode) + sizeof(std::unique_ptr<Level>));
        if (size <= few)
            break;
        if (condition < last_condition)
            bytes += nodes * level_bytes_forecast(condition + 1, size, few);
        else
            bytes += sizeof(Numbers) + static_cast<double>(count * sizeof(std::uint32_t));
    }
    return bytes;
}

double NestedTrees::bytes_forecast(std::size_t rectangles, std::size_t few, TreeKind kind) {
    constexpr std::size_t each = sizeof(IsoRectangle) + side_condition_count * sizeof(PlanePoint)
        + ConjugationTree::building_bytes_per_point;
    return static_cast<double>(rectangles * each)
        + level_bytes_forecast(0, rectangles, std::max<std::size_t>(few, 1))
        * std::pow(depth_factor(kind), side_condition_count);
}

} // namespace vera
