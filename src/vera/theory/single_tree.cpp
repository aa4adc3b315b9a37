// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/single_tree.h"

#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/theory/ham_sandwich.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace vera {

namespace {

using ConditionPoints = std::array<std::vector<PlanePoint>, side_condition_count>;

/// What dividing takes of memory, for a while, beside the tree.
constexpr std::size_t building_bytes_per_rectangle = 64;

class AlternateCuts {
public:
    AlternateCuts(const ConditionPoints& points, std::size_t leaf_size, const CancelFlag* cancel)
        : points_(points)
        , leaf_size_(std::max<std::size_t>(leaf_size, 1))
        , cancel_(cancel) {}

    TreeShape shape() {
        const std::size_t count = points_[0].size();
        shape_.numbers.resize(count);
        std::iota(shape_.numbers.begin(), shape_.numbers.end(), std::uint32_t{0});
        Directions directions;
        directions.fill({1, 0});
        if (count > 0)
            add_node(0, static_cast<std::uint32_t>(count), 0, directions);
        return std::move(shape_);
    }

private:
    /// Along which each condition's points are halved next.
    using Directions = std::array<PlaneDirection, side_condition_count>;

    void add_node(
        std::uint32_t first, std::uint32_t last, std::size_t condition, Directions directions) {
        stop_if_raised(cancel_);
        const std::size_t number = shape_.nodes.size();
        shape_.nodes.push_back({first, last});
        if (last - first <= leaf_size_)
            return;
        const std::vector<PlanePoint>& points = points_.at(condition);
        PlaneDirection& direction = directions.at(condition);
        const std::uint32_t middle = first + (last - first) / 2;
        const auto place = [&](std::uint32_t i) {
            return shape_.numbers.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(
            place(first),
            place(middle),
            place(last),
            [&, before = TurnedOrder{direction}](std::uint32_t a, std::uint32_t b) {
                return before(points[a], points[b]);
            });
        std::vector<PlanePoint> halves;
        halves.reserve(last - first);
        for (std::uint32_t i = first; i < last; ++i)
            halves.push_back(points[shape_.numbers[i]]);
        const auto all = std::span<const PlanePoint>(halves);
        direction = conjugate_direction(
            all.first(middle - first), all.subspan(middle - first), direction, first);
        const std::size_t next = (condition + 1) % side_condition_count;
        add_node(first, middle, next, directions);
        shape_.nodes[number].children = static_cast<std::uint32_t>(shape_.nodes.size());
        add_node(middle, last, next, directions);
    }

    const ConditionPoints& points_;
    std::size_t leaf_size_;
    const CancelFlag* cancel_;
    TreeShape shape_;
};

} // namespace

/// One ray's way through the tree.
class SingleTreeSearch {
public:
    SingleTreeSearch(const SingleTree& tree, const WholeRay& ray, StepCounts& counts)
        : tree_(tree)
        , ray_(ray)
        , half_planes_(condition_half_planes(ray))
        , counts_(counts)
        , first_(tree.rectangles_, ray) {}

    std::optional<std::uint32_t> first() {
        if (!tree_.nearness_.empty())
            search(0, {});
        return first_.number();
    }

private:
    /// Which conditions all rectangles of a node are known to meet.
    using Met = std::array<bool, side_condition_count>;

    void search(std::uint32_t number, Met met) {
        if (!first_.may_be_in(tree_.nearness_[number]))
            return;
        for (std::size_t i = 0; i < side_condition_count; ++i) {
            if (met.at(i))
                continue;
            const PartitionTree& tree = tree_.trees_.at(i);
            const Inclusion included =
                tree.inclusion(tree.nodes()[number], half_planes_.at(i), counts_);
            if (included == Inclusion::none)
                return;
            met.at(i) = included == Inclusion::all;
        }
        const PartitionNode& node = tree_.trees_[0].nodes()[number];
        if (node.is_leaf())
            look_at_each(tree_.trees_[0].numbers_of(node), met);
        else
            search_children(number, node.children, met);
    }

    void search_children(std::uint32_t number, std::uint32_t second, const Met& met) {
        std::uint32_t nearer = number + 1;
        std::uint32_t farther = second;
        if (first_.is_nearer_in(tree_.nearness_[farther], tree_.nearness_[nearer]))
            std::swap(nearer, farther);
        search(nearer, met);
        search(farther, met);
    }

    void look_at_each(std::span<const std::uint32_t> numbers, const Met& met) {
        counts_.points += numbers.size();
        for (const std::uint32_t number : numbers) {
            bool is_met = is_ahead(ray_, tree_.rectangles_[number].z);
            for (std::size_t i = 0; is_met && i < side_condition_count; ++i)
                is_met = met.at(i) || contains(half_planes_.at(i), tree_.points_.at(i)[number]);
            if (is_met)
                first_.take(number);
        }
    }

    const SingleTree& tree_;
    const WholeRay& ray_;
    std::array<PlaneStrip, side_condition_count> half_planes_;
    StepCounts& counts_;
    NearestRectangle first_;
};

SingleTree::SingleTree(
    std::span<const IsoRectangle> rectangles,
    std::size_t leaf_size,
    const Progress& progress,
    const CancelFlag* cancel) {
    require_rectangles(rectangles);
    require_memory(
        bytes_forecast(rectangles.size(), leaf_size),
        "a tree of " + std::to_string(rectangles.size()) + " rectangles with four hulls a node",
        "fewer rectangles, and leaves of more than " + std::to_string(leaf_size)
            + " of them, take less");
    rectangles_.assign(rectangles.begin(), rectangles.end());
    for (std::size_t i = 0; i < side_condition_count; ++i) {
        points_.at(i).reserve(rectangles.size());
        for (const IsoRectangle& rectangle : rectangles)
            points_.at(i).push_back(condition_point(rectangle, static_cast<SideCondition>(i)));
    }
    const TreeShape shape = AlternateCuts(points_, leaf_size, cancel).shape();
    nearness_.reserve(shape.nodes.size());
    for (const PartitionNode& node : shape.nodes)
        nearness_.push_back(
            nearness_of(rectangles_, std::span(shape.numbers).subspan(node.first, node.size())));
    StageProgress stages(progress, side_condition_count + 1);
    stages.next(1);
    for (std::size_t i = 0; i < side_condition_count; ++i)
        trees_.at(i) = PartitionTree(points_.at(i), shape, stages.next(1), cancel);
}

std::optional<std::uint32_t>
SingleTree::first_rectangle(const WholeRay& ray, StepCounts* counts) const {
    StepCounts steps;
    return SingleTreeSearch(*this, ray, counts != nullptr ? *counts : steps).first();
}

std::size_t SingleTree::bytes() const {
    std::size_t bytes = rectangles_.capacity() * sizeof(IsoRectangle)
        + nearness_.capacity() * sizeof(NearnessOfNode);
    for (std::size_t i = 0; i < side_condition_count; ++i)
        bytes += points_.at(i).capacity() * sizeof(PlanePoint) + trees_.at(i).bytes();
    return bytes;
}

double SingleTree::bytes_forecast(std::size_t rectangles, std::size_t leaf_size) {
    leaf_size = std::max<std::size_t>(leaf_size, 1);
    double nodes = 1;
    for (std::size_t size = rectangles; size > leaf_size; size = (size + 1) / 2)
        nodes *= 2;
    constexpr std::size_t each = sizeof(IsoRectangle) + side_condition_count * sizeof(PlanePoint)
        + building_bytes_per_rectangle;
    // The shape is there five times while trees are made.
    return static_cast<double>(rectangles * each)
        + 2 * nodes * (sizeof(NearnessOfNode) + sizeof(PartitionNode))
        + side_condition_count * halved_bytes_forecast(rectangles, leaf_size);
}

} // namespace vera
