// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/nested_sweeps.h"

#include "vera/base/available_memory.h"
#include "vera/base/check.h"
#include "vera/theory/ray_parts.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

/// Whether what decides at the node is y alone: it is one of an inner tree.
bool is_inner(RayTreeNode node) {
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
        RayTreeNode node,
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
        found_.clear();
        for (; begun_ < by_first_z_.size(); ++begun_) {
            const std::uint32_t ray = by_first_z_[begun_];
            if (rectangle.z < rays_[ray].first_z)
                break;
            if (live.is_live(numbers_[ray])) // and has not ended since it began
                found_.push_back(ray);
        }
        tree_->add(found_);
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

/// What tells the plane the rays of a rectangle.
class NestedSweeps {
public:
    NestedSweeps(const RayTrees& trees, std::int32_t last_z, NestedSweepCounts& counts)
        : trees_(trees)
        , last_z_(last_z)
        , counts_(counts)
        , live_(trees)
        , sweeps_(trees.node_count()) {}

    /// Each sweep moves when it is asked.
    void move_to(std::int32_t /*z*/) {}

    void begin(std::span<const std::uint32_t> rays) {
        for (const std::uint32_t ray : rays)
            live_.add(ray, counts_.trees);
    }

    /// Sweeps that were made before hold the ray, too, where it has not begun.
    void end(std::uint32_t ray) {
        if (live_.is_live(ray))
            live_.remove(ray, counts_.trees);
        trees_.for_each_node_of(ray, [&](RayTreeNode node) {
            if (NodeSweep* const sweep = sweeps_[node.number()].get())
                sweep->remove(ray);
        });
    }

    void append_met(const IsoRectangle& rectangle, Numbers& met) {
        trees_.visit(rectangle, counts_.trees, Visitor{*this, rectangle, met});
    }

private:
    struct Visitor {
        NestedSweeps& sweeps;
        const IsoRectangle& rectangle;
        Numbers& found;

        bool enters(RayTreeNode node) const { return sweeps.live_.count_in(node) > 0; }

        /// What a tree tells; sweeps count themselves what they do.
        void met(RayTreeNode node) const {
            const std::size_t before = found.size();
            sweeps.live_.append_of(node, found, sweeps.counts_.trees);
            sweeps.counts_.trees.reports += found.size() - before;
        }

        void open_in_y(RayTreeNode node) const { sweeps.ask(node, rectangle, found); }

        void open(RayTreeNode node) const { sweeps.ask(node, rectangle, found); }
    };

    void ask(RayTreeNode node, const IsoRectangle& rectangle, Numbers& met) {
        std::unique_ptr<NodeSweep>& sweep = sweeps_[node.number()];
        if (!sweep)
            sweep = std::make_unique<NodeSweep>(
                node, trees_, live_, rectangle.z, last_z_, counts_.sweeps);
        sweep->append_met(rectangle, live_, met);
    }

    const RayTrees& trees_;
    std::int32_t last_z_;
    NestedSweepCounts& counts_;
    LiveRays live_;
    std::vector<std::unique_ptr<NodeSweep>> sweeps_; ///< of each node that was asked
};

/// The most rays of a node at which trees are cut.
std::size_t few_at(std::size_t level, std::size_t rays) {
    return part_size(rays, std::min<std::size_t>(level, 31));
}

/// The proposition itself, on one thread.
struct NestedQuery {
    std::size_t few = 1;
    TreeKind kind = TreeKind::conjugation;
    const CancelFlag* cancel = nullptr;

    void answer(
        std::span<const IsoRectangle> rectangles,
        const SweptRays& swept,
        const Meeting& meeting,
        NestedSweepCounts& counts,
        const Progress& progress) const {
        if (rectangles.empty() || swept.rays.empty())
            return;
        const RayTrees trees(swept.rays, few, {}, cancel, kind);
        MovingPlane plane(rectangles, swept, meeting);
        NestedSweeps sweeps(trees, plane.last_z(), counts);
        plane.run(sweeps, progress, cancel);
    }
};

} // namespace

void nested_sweeps(
    std::size_t level,
    std::size_t parts_level,
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    NestedSweepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel,
    TreeKind kind) {
    require_swept(rectangles, swept);
    const std::size_t count = swept.rays.size();
    parts_level = std::min({parts_level, level, std::size_t{31}});
    require_memory(
        nested_sweeps_bytes_forecast(level, parts_level, rectangles.size(), count, kind),
        "nested sweeps of " + std::to_string(count) + " rays",
        "fewer rays at a time, and trees that are cut higher, take less");
    const NestedQuery query = {few_at(level, count), kind, cancel};
    NestedSweepCounts together;
    if (parts_level == 0) {
        query.answer(rectangles, swept, meeting, together, progress);
    } else {
        std::mutex mutex;
        const auto answer = [&](std::span<const std::uint32_t> rays, const Numbers& asked) {
            const RayPart part(rectangles, swept, rays, asked);
            NestedSweepCounts steps;
            steps.sweeps.hulls += rectangles.size();
            query.answer(part.rectangles(), part.swept(), part.meeting(meeting), steps, {});
            const std::lock_guard lock(mutex);
            together += steps;
        };
        for_each_part(
            part_size(count, parts_level),
            EqualPoints::apart,
            rectangles,
            swept,
            answer,
            progress,
            cancel);
    }
    if (counts != nullptr)
        *counts += together;
    if (progress)
        progress(1);
}

FirstRectangles nested_sweeps_first_rectangles(
    std::size_t level,
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    NestedSweepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel,
    TreeKind kind) {
    FirstRectangles first(rays.size());
    nested_sweeps(
        level, 0, rectangles, {rays}, first_meeting(first), counts, progress, cancel, kind);
    return first;
}

double nested_sweeps_bytes_forecast(
    std::size_t level,
    std::size_t parts_level,
    std::size_t rectangles,
    std::size_t rays,
    TreeKind kind) {
    parts_level = std::min(parts_level, level);
    const std::size_t size = part_size(rays, parts_level);
    const std::size_t depth = std::min<std::size_t>(level, 31) - parts_level;
    // A ray is in the sweep of one node of the outer tree, and of one of each inner tree above it.
    const double of_part =
        depth_factor(kind) * static_cast<double>(depth + 2) * KineticRangeTree::bytes_forecast(size)
        + RayTrees::bytes_forecast(size, few_at(level, rays), kind)
        + moving_plane_bytes_forecast(rectangles, size)
        + static_cast<double>(
            size * RayPart::bytes_per_ray + rectangles * RayPart::bytes_per_rectangle);
    return parts_bytes_forecast(parts_level, rectangles, rays)
        + static_cast<double>(parts_at_work(parts_level)) * of_part;
}

} // namespace vera
