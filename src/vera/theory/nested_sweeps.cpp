// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/nested_sweeps.h"

#include "vera/base/available_memory.h"
#include "vera/base/check.h"
#include "vera/base/long_loop.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

/// Whether what decides at the node is y alone: it is one of an inner tree.
bool is_inner(RayNode node) {
    return node.of->first_node != 0;
}

/// A plane sweep is a space sweep of what is all at x = 0: of a ray, or a rectangle, its y.
SlopedRay flattened(const SlopedRay& ray) {
    return {0, 0, ray.slope_y, ray.offset_y, ray.first_z};
}

IsoRectangle flattened(const IsoRectangle& rectangle) {
    return {rectangle.z, 0, 0, rectangle.lower_y, rectangle.upper_y};
}

/// The sweep of a node: of those of its rays that had not ended when it began.
class NodeSweep {
public:
    NodeSweep(
        RayNode node,
        const RayTrees& trees,
        const LiveRays& live,
        std::int32_t z,
        std::int32_t last_z,
        SweepCounts& counts)
        : is_flat_(is_inner(node)) {
        for (const std::uint32_t ray : node.rays())
            if (live.is_live(ray) || trees.rays()[ray].first_z > z)
                numbers_.push_back(ray);
        std::sort(numbers_.begin(), numbers_.end());
        for (const std::uint32_t ray : numbers_)
            rays_.push_back(is_flat_ ? flattened(trees.rays()[ray]) : trees.rays()[ray]);
        by_first_z_ = rays_by_first_z(rays_);
        tree_ = std::make_unique<KineticRangeTree>(rays_, z, last_z, counts);
    }

    /// Appends the rays that the rectangle meets, which lies not before those asked so far.
    void append_met(const IsoRectangle& rectangle, const LiveRays& live, Numbers& met) {
        while (tree_->pass_crossing(rectangle.z))
            ;
        for (; begun_ < by_first_z_.size(); ++begun_) {
            const std::uint32_t ray = by_first_z_[begun_];
            if (rectangle.z < rays_[ray].first_z)
                break;
            if (live.is_live(numbers_[ray])) // and has not ended since it began
                tree_->add(ray);
        }
        found_.clear();
        tree_->append_met(is_flat_ ? flattened(rectangle) : rectangle, found_);
        for (const std::uint32_t ray : found_)
            met.push_back(numbers_[ray]);
    }

    void remove(std::uint32_t number) {
        const auto found = std::lower_bound(numbers_.begin(), numbers_.end(), number);
        VERA_CHECK(found != numbers_.end() && *found == number);
        tree_->remove(static_cast<std::uint32_t>(found - numbers_.begin()));
    }

private:
    bool is_flat_;
    Numbers numbers_; ///< of the rays, ascending
    std::vector<SlopedRay> rays_;
    Numbers by_first_z_;
    std::size_t begun_ = 0;
    std::unique_ptr<KineticRangeTree> tree_;
    Numbers found_;
};

class NestedSweeps {
public:
    NestedSweeps(const RayTrees& trees, std::int32_t last_z, NestedSweepCounts& counts)
        : trees_(trees)
        , last_z_(last_z)
        , counts_(counts)
        , live_(trees)
        , sweeps_(trees.node_count())
        , by_first_z_(rays_by_first_z(trees.rays())) {}

    /// The rays that meet the rectangle and no earlier one: they end.
    const Numbers& met_first(const IsoRectangle& rectangle) {
        for (; begun_ < by_first_z_.size(); ++begun_) {
            if (rectangle.z < trees_.rays()[by_first_z_[begun_]].first_z)
                break;
            live_.add(by_first_z_[begun_], counts_.trees);
        }
        met_.clear();
        trees_.visit(rectangle, counts_.trees, Visitor{*this, rectangle});
        for (const std::uint32_t ray : met_)
            end(ray);
        return met_;
    }

    bool have_all_ended() const { return live_.count() == 0 && begun_ == by_first_z_.size(); }

private:
    struct Visitor {
        NestedSweeps& sweeps;
        const IsoRectangle& rectangle;

        bool enters(RayNode node) const { return sweeps.live_.count_in(node) > 0; }

        void met(RayNode node) const {
            sweeps.live_.append_of(node, sweeps.met_, sweeps.counts_.trees);
        }

        void open_in_y(RayNode node) const { sweeps.ask(node, rectangle); }

        void open(RayNode node) const { sweeps.ask(node, rectangle); }
    };

    void ask(RayNode node, const IsoRectangle& rectangle) {
        std::unique_ptr<NodeSweep>& sweep = sweeps_[node.number()];
        if (!sweep)
            sweep = std::make_unique<NodeSweep>(
                node, trees_, live_, rectangle.z, last_z_, counts_.sweeps);
        sweep->append_met(rectangle, live_, met_);
    }

    void end(std::uint32_t ray) {
        live_.remove(ray, counts_.trees);
        trees_.for_each_node_of(ray, [&](RayNode node) {
            if (NodeSweep* const sweep = sweeps_[node.number()].get())
                sweep->remove(ray);
        });
    }

    const RayTrees& trees_;
    std::int32_t last_z_;
    NestedSweepCounts& counts_;
    LiveRays live_;
    std::vector<std::unique_ptr<NodeSweep>> sweeps_; ///< of each node that was asked
    Numbers by_first_z_;
    std::size_t begun_ = 0;
    Numbers met_;
};

} // namespace

FirstRectangles nested_sweeps_first_rectangles(
    std::size_t level,
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    NestedSweepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel,
    TreeKind kind) {
    require_rectangles(rectangles);
    const std::size_t depth = std::min<std::size_t>(level, 31);
    const std::size_t few =
        std::max<std::size_t>((rays.size() + (std::size_t{1} << depth) - 1) >> depth, 1);
    // A ray is in the sweep of one node of the outer tree, and of one of each inner tree above it.
    require_memory(
        depth_factor(kind) * static_cast<double>(depth + 2)
                * KineticRangeTree::bytes_forecast(rays.size())
            + RayTrees::bytes_forecast(rays.size(), few, kind),
        "nested sweeps of " + std::to_string(rays.size()) + " rays",
        "fewer rays at a time, and trees that are cut higher, take less");
    const RayTrees trees(rays, few, {}, cancel, kind);
    FirstRectangles first(rays.size());
    if (rectangles.empty() || rays.empty())
        return first;
    NestedSweepCounts steps;
    const Numbers order = rectangles_by_z(rectangles);
    NestedSweeps sweeps(trees, rectangles[order.back()].z, counts != nullptr ? *counts : steps);
    const LongLoop loop(order.size(), progress, cancel, 16);
    for (std::size_t i = 0; i < order.size() && !sweeps.have_all_ended(); ++i) {
        loop.turn(i);
        for (const std::uint32_t ray : sweeps.met_first(rectangles[order[i]]))
            first[ray] = order[i];
    }
    if (progress)
        progress(1);
    return first;
}

} // namespace vera
