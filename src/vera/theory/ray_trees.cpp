// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/ray_trees.h"

#include "vera/base/available_memory.h"
#include "vera/base/check.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/theory/conjugation_tree.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

/// What the outer tree takes of the time, beside those of its nodes.
constexpr double outer_part = 0.1;

} // namespace

class RayTreesBuilder {
public:
    RayTreesBuilder(RayTrees& trees, Progress progress, const CancelFlag* cancel)
        : trees_(trees)
        , progress_(std::move(progress))
        , cancel_(cancel) {}

    void build() {
        RayPointTree& outer = trees_.outer_;
        const std::size_t count = trees_.rays_.size();
        outer.tree = tree_of(
            trees_.x_points_, all_numbers(count), progress_between(progress_, 0, outer_part));
        outer.places.resize(count);
        for (std::uint32_t place = 0; place < count; ++place)
            outer.places[outer.tree.numbers()[place]] = place;
        trees_.node_count_ = outer.tree.nodes().size();
        add_inner(outer);
        VERA_CHECK(trees_.node_count_ <= std::numeric_limits<std::uint32_t>::max());
        if (progress_)
            progress_(1);
    }

private:
    /// Rays that are equal come and go by themselves.
    PartitionTree
    tree_of(std::span<const PlanePoint> points, Numbers numbers, const Progress& progress) const {
        return partition_tree(
            trees_.kind_,
            points,
            std::move(numbers),
            trees_.few_,
            progress,
            cancel_,
            EqualPoints::apart);
    }

    void add_inner(RayPointTree& outer) {
        const std::span<const PartitionNode> nodes = outer.tree.nodes();
        const LongLoop loop(nodes.size(), progress_between(progress_, outer_part, 1), cancel_, 1);
        outer.inner.resize(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            loop.turn(i);
            if (nodes[i].size() > trees_.few_)
                outer.inner[i] = inner(nodes[i]);
        }
    }

    std::unique_ptr<RayPointTree> inner(const PartitionNode& node) {
        const RayPointTree& outer = trees_.outer_;
        const auto rays = outer.tree.numbers_of(node);
        auto made = std::make_unique<RayPointTree>();
        made->tree = tree_of(trees_.y_points_, Numbers(rays.begin(), rays.end()), {});
        made->first_node = static_cast<std::uint32_t>(trees_.node_count_);
        made->places.resize(rays.size());
        for (std::uint32_t place = 0; place < rays.size(); ++place)
            made->places[outer.places[made->tree.numbers()[place]] - node.first] = place;
        trees_.node_count_ += made->tree.nodes().size();
        return made;
    }

    RayTrees& trees_;
    Progress progress_;
    const CancelFlag* cancel_;
};

RayTrees::RayTrees(
    std::span<const SlopedRay> rays,
    std::size_t few,
    const Progress& progress,
    const CancelFlag* cancel,
    TreeKind kind)
    : few_(std::max<std::size_t>(few, 1))
    , kind_(kind) {
    require_sloped_rays(rays);
    require_memory(
        bytes_forecast(rays.size(), few_, kind),
        "nesting trees of " + std::to_string(rays.size()) + " rays down to " + std::to_string(few_),
        "trees that end at more rays, as at " + std::to_string(8 * few_)
            + ", and trees of fewer rays take less");
    rays_.assign(rays.begin(), rays.end());
    x_points_.reserve(rays.size());
    y_points_.reserve(rays.size());
    for (const SlopedRay& ray : rays) {
        x_points_.push_back(x_point(ray));
        y_points_.push_back(y_point(ray));
    }
    RayTreesBuilder(*this, progress, cancel).build();
}

namespace {

/// Collects all rays that are met, live or not.
struct EveryRay {
    const RayTrees& trees;
    const IsoRectangle& rectangle;
    Numbers& found;
    StepCounts& counts;

    bool enters(RayTreeNode /*node*/) const { return true; }

    void met(RayTreeNode node) const { look_at_each(node); }

    void open_in_y(RayTreeNode node) const { look_at_each(node); }

    void open(RayTreeNode node) const { look_at_each(node); }

    /// Also where all lines are met: a ray may begin behind the rectangle.
    void look_at_each(RayTreeNode node) const {
        counts.points += node.rays().size();
        for (const std::uint32_t ray : node.rays())
            if (meets(trees.rays()[ray], rectangle))
                found.push_back(ray);
    }
};

/// Collects the live rays that are met.
struct EveryLiveRay {
    const RayTrees& trees;
    const LiveRays& live;
    PlaneStrip x;
    PlaneStrip y;
    Numbers& found;
    StepCounts& counts;

    bool enters(RayTreeNode node) const {
        ++counts.counters;
        return live.count_in(node) > 0;
    }

    void met(RayTreeNode node) const { live.append_of(node, found, counts); }

    void open_in_y(RayTreeNode node) const {
        look_at_each(node, [&](const SlopedRay& ray) { return contains(y, y_point(ray)); });
    }

    void open(RayTreeNode node) const {
        look_at_each(node, [&](const SlopedRay& ray) {
            return contains(x, x_point(ray)) && contains(y, y_point(ray));
        });
    }

    template <typename IsMet>
    void look_at_each(RayTreeNode node, const IsMet& is_met) const {
        counts.points += node.rays().size();
        for (const std::uint32_t ray : node.rays())
            if (live.is_live(ray) && is_met(trees.rays()[ray]))
                found.push_back(ray);
    }
};

} // namespace

Numbers RayTrees::rays_met(const IsoRectangle& rectangle, StepCounts* counts) const {
    require_rectangles({&rectangle, 1});
    StepCounts steps;
    StepCounts& counted = counts != nullptr ? *counts : steps;
    Numbers found;
    visit(rectangle, counted, EveryRay{*this, rectangle, found, counted});
    counted.reports += found.size();
    std::sort(found.begin(), found.end());
    return found;
}

std::size_t RayTrees::bytes() const {
    const auto bytes_of = [](const RayPointTree& tree) {
        return tree.tree.bytes() + tree.places.capacity() * sizeof(std::uint32_t)
            + tree.inner.capacity() * sizeof(std::unique_ptr<RayPointTree>);
    };
    std::size_t bytes = rays_.capacity() * sizeof(SlopedRay)
        + (x_points_.capacity() + y_points_.capacity()) * sizeof(PlanePoint) + bytes_of(outer_);
    for (const std::unique_ptr<RayPointTree>& inner : outer_.inner)
        bytes += inner ? sizeof(RayPointTree) + bytes_of(*inner) : 0;
    return bytes;
}

double RayTrees::bytes_forecast(std::size_t rays, std::size_t few, TreeKind kind) {
    few = std::max<std::size_t>(few, 1);
    constexpr std::size_t each_ray = sizeof(SlopedRay) + 2 * sizeof(PlanePoint)
        + ConjugationTree::building_bytes_per_point + sizeof(std::uint8_t);
    // Beside what the tree itself takes: places, and a live count for each node.
    const auto tree = [few](std::size_t count) {
        double bytes =
            halved_bytes_forecast(count, few) + static_cast<double>(count * sizeof(std::uint32_t));
        double nodes = 1;
        for (std::size_t size = count; size > few; size = (size + 1) / 2)
            nodes *= 2;
        return bytes + 2 * nodes * sizeof(std::uint32_t);
    };
    double bytes = tree(rays);
    double nodes = 1;
    for (std::size_t size = rays; size > 0; size = (size + 1) / 2, nodes *= 2) {
        bytes += nodes * sizeof(std::unique_ptr<RayPointTree>);
        if (size <= few)
            break;
        bytes += nodes * (sizeof(RayPointTree) + tree(size));
    }
    return static_cast<double>(rays * each_ray) + bytes * std::pow(depth_factor(kind), 2);
}

LiveRays::LiveRays(const RayTrees& trees)
    : trees_(trees)
    , counts_(trees.node_count())
    , live_(trees.rays().size()) {}

void LiveRays::add(std::uint32_t ray, StepCounts& counts) {
    VERA_CHECK(!is_live(ray));
    live_[ray] = 1;
    ++count_;
    trees_.for_each_node_of(ray, [&](RayTreeNode node) {
        ++counts.counters;
        ++counts_[node.number()];
    });
}

void LiveRays::remove(std::uint32_t ray, StepCounts& counts) {
    VERA_CHECK(is_live(ray));
    live_[ray] = 0;
    --count_;
    trees_.for_each_node_of(ray, [&](RayTreeNode node) {
        ++counts.counters;
        --counts_[node.number()];
    });
}

void LiveRays::append_of(RayTreeNode node, Numbers& rays, StepCounts& counts) const {
    ++counts.counters;
    if (count_in(node) == 0)
        return;
    const PartitionNode& held = node.node();
    if (count_in(node) == held.size()) {
        rays.insert(rays.end(), node.rays().begin(), node.rays().end());
    } else if (held.is_leaf()) {
        std::copy_if(
            node.rays().begin(),
            node.rays().end(),
            std::back_inserter(rays),
            [&](std::uint32_t ray) { return is_live(ray); });
        counts.points += held.size();
    } else {
        append_of({node.of, node.index + 1}, rays, counts);
        append_of({node.of, held.children}, rays, counts);
    }
}

void LiveRays::append_met(const IsoRectangle& rectangle, Numbers& rays, StepCounts& counts) const {
    const std::size_t before = rays.size();
    trees_.visit(
        rectangle,
        counts,
        EveryLiveRay{trees_, *this, x_strip(rectangle), y_strip(rectangle), rays, counts});
    counts.reports += rays.size() - before;
}

} // namespace vera
