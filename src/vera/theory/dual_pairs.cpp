// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/dual_pairs.h"

#include "vera/base/available_memory.h"
#include "vera/base/check.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/base/random.h"

#include <algorithm>
#include <string>

namespace vera {

DualPairs::DualPairs(
    std::span<const IsoRectangle> rectangles,
    Stabbing kind,
    Building building,
    const Progress& progress,
    const CancelFlag* cancel)
    : kind_(kind)
    , order_(rectangles) {
    const auto require = [&](double bytes) {
        require_memory(
            bytes,
            "locating rays among the pairs of sides of " + std::to_string(rectangles.size())
                + " rectangles",
            "bits in place of pairs, and fewer rectangles take less; nested trees take far less");
    };
    require(2 * SideProjection::bytes_forecast(rectangles.size()));
    StageProgress stages(progress, 4);
    along_y_ = SideProjection(rectangles, order_, SideProjection::Axis::x, stages.next(1), cancel);
    along_x_ = SideProjection(rectangles, order_, SideProjection::Axis::y, stages.next(1), cancel);
    trees_.resize(along_y_.line_count() * along_x_.line_count());
    const Progress of_pairs = stages.next(2);
    if (building == Building::all) {
        require(sampled_bytes_of_trees());
        long_parallel_loop(trees_.size(), of_pairs, cancel, 16, [&](std::size_t pair) {
            trees_[pair] = std::make_unique<const StabbingTree>(built(
                static_cast<std::uint32_t>(pair / along_x_.line_count()),
                static_cast<std::uint32_t>(pair % along_x_.line_count())));
        });
    }
    if (progress)
        progress(1);
}

/// Of all, by some of them spread over all, and with a fifth to spare.
double DualPairs::sampled_bytes_of_trees() const {
    constexpr std::size_t samples = 64;
    const std::size_t count = trees_.size();
    double bytes = 0;
    const std::size_t taken = std::min(samples, count);
    for (std::size_t i = 0; i < taken; ++i) {
        const std::size_t pair = random(1988, i, 0) % count;
        const auto line_x = static_cast<std::uint32_t>(pair / along_x_.line_count());
        bytes += static_cast<double>(
            built(line_x, static_cast<std::uint32_t>(pair % along_x_.line_count())).bytes());
    }
    return taken == 0
        ? 0
        : 1.2 * static_cast<double>(count) * (bytes / static_cast<double>(taken) + sizeof(void*));
}

StabbingTree DualPairs::built(std::uint32_t line_x, std::uint32_t line_y) const {
    const PivotRanges& across = along_y_.ranges(line_x);
    const PivotRanges& along = along_x_.ranges(line_y);
    return {kind_, across.ranges(), across.place_count(), along.ranges()};
}

const StabbingTree& DualPairs::tree(std::uint32_t line_x, std::uint32_t line_y) const {
    std::unique_ptr<const StabbingTree>& tree = trees_[line_x * along_x_.line_count() + line_y];
    const std::lock_guard lock(mutex_);
    if (!tree)
        tree = std::make_unique<const StabbingTree>(built(line_x, line_y));
    return *tree;
}

std::optional<DualPairs::Place> DualPairs::place_of(const WholeRay& ray, DualCounts& counts) const {
    require_ray(ray);
    const auto across = along_y_.pivot(ray, counts);
    if (!across)
        return std::nullopt;
    const auto along = along_x_.pivot(ray, counts);
    if (!along)
        return std::nullopt;
    return Place{tree(across->line, along->line), across->place, along->place};
}

std::optional<std::uint32_t>
DualPairs::first_rectangle(const WholeRay& ray, DualCounts* counts) const {
    VERA_CHECK(kind_ == Stabbing::from_a_rank);
    DualCounts steps;
    DualCounts& taken = counts != nullptr ? *counts : steps;
    const auto place = place_of(ray, taken);
    if (!place)
        return std::nullopt;
    const std::int32_t start = ray.origin[2];
    std::uint32_t least = order_.first_rank_from(start, taken);
    if (ray.direction[2] < 0) {
        const std::uint32_t end = order_.first_rank_above(start, taken);
        const auto last = place->tree.last_before(place->across, place->along, end, taken);
        if (!last)
            return std::nullopt;
        // Of those in its plane the one of the smallest number.
        least = order_.first_rank_from(order_.z(*last), taken);
    }
    const auto rank = place->tree.first_from(place->across, place->along, least, taken);
    return rank ? std::optional(order_.number(*rank)) : std::nullopt;
}

std::optional<std::uint32_t>
DualPairs::lowest_rectangle(const WholeRay& ray, DualCounts* counts) const {
    DualCounts steps;
    DualCounts& taken = counts != nullptr ? *counts : steps;
    const auto place = place_of(ray, taken);
    if (!place)
        return std::nullopt;
    const auto rank = place->tree.first(place->across, place->along, taken);
    return rank ? std::optional(order_.number(*rank)) : std::nullopt;
}

std::size_t DualPairs::built_count() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::count_if(
        trees_.begin(), trees_.end(), [](const auto& tree) { return tree != nullptr; }));
}

std::size_t DualPairs::bytes() const {
    const std::lock_guard lock(mutex_);
    std::size_t bytes = order_.bytes() + along_y_.bytes() + along_x_.bytes()
        + trees_.capacity() * sizeof(trees_[0]);
    for (const auto& tree : trees_)
        bytes += tree ? tree->bytes() : 0;
    return bytes;
}

double DualPairs::bytes_forecast(std::size_t rectangles, Stabbing kind) {
    const auto n = static_cast<double>(rectangles);
    return 2 * n * sizeof(std::uint32_t) * 2 + 2 * SideProjection::bytes_forecast(rectangles)
        + 4 * n * n * (sizeof(void*) + StabbingTree::bytes_forecast(kind, rectangles));
}

std::optional<std::uint32_t>
brute_force_lowest_rectangle(std::span<const IsoRectangle> rectangles, const WholeRay& ray) {
    const auto half_planes = condition_half_planes(ray);
    std::optional<std::uint32_t> lowest;
    for (std::uint32_t i = 0; i < rectangles.size(); ++i) {
        bool is_met = true;
        for (std::size_t side = 0; side < side_condition_count; ++side)
            is_met = is_met
                && contains(
                         half_planes.at(side),
                         condition_point(rectangles[i], static_cast<SideCondition>(side)));
        if (is_met && (!lowest || rectangles[i].z < rectangles[*lowest].z))
            lowest = i;
    }
    return lowest;
}

} // namespace vera
