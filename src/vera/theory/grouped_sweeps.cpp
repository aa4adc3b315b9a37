// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/grouped_sweeps.h"

#include "vera/base/available_memory.h"
#include "vera/base/random.h"
#include "vera/theory/conjugation_tree.h"
#include "vera/theory/ray_parts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

/// log2 of the golden ratio.
constexpr double alpha = 0.6942419136306174;

std::size_t largest_level(std::size_t rays) {
    return rays == 0 ? 0 : static_cast<std::size_t>(std::bit_width(rays) - 1);
}

/// The level of the outer tree alone.
std::size_t outer_level(std::size_t level) {
    return (level + 1) / 2;
}

/// The groups of one node of the outer tree, which has that hull.
class NodeSweeper {
public:
    NodeSweeper(
        std::span<const IsoRectangle> rectangles,
        const SweptRays& swept,
        const Meeting& meeting,
        const CancelFlag* cancel)
        : rectangles_(rectangles)
        , swept_(swept)
        , meeting_(meeting)
        , cancel_(cancel) {}

    /// Of the rays of a node, those of the rectangles that its hull leaves.
    void sweep(const ConjugationTree& inner, const Numbers& asked) { search(inner, 0, asked); }

    SweepCounts counts;

private:
    void search(const ConjugationTree& tree, std::uint32_t number, const Numbers& asked) {
        const ConjugationNode& node = tree.nodes()[number];
        Numbers left;
        for (const std::uint32_t rectangle : asked)
            if (tree.inclusion(node, y_strip(rectangles_[rectangle]), steps_) != Inclusion::none)
                left.push_back(rectangle);
        counts.hulls += asked.size();
        if (left.empty())
            return;
        if (node.is_leaf())
            return sweep_group(tree.numbers_of(node), left);
        search(tree, number + 1, left);
        search(tree, node.children, left);
    }

    void sweep_group(std::span<const std::uint32_t> rays, const Numbers& asked) {
        const RayPart group(rectangles_, swept_, rays, asked);
        detail::sweep_checked(
            group.rectangles(), group.swept(), group.meeting(meeting_), counts, {}, cancel_);
    }

    std::span<const IsoRectangle> rectangles_;
    const SweptRays& swept_;
    const Meeting& meeting_;
    const CancelFlag* cancel_;
    StepCounts steps_;
};

/// Whether two lines cross between two zs.
bool cross(PlanePoint a, PlanePoint b, std::int32_t first_z, std::int32_t last_z) {
    const std::int64_t before = value_at(a, first_z) - value_at(b, first_z);
    const std::int64_t after = value_at(a, last_z) - value_at(b, last_z);
    return (before < 0 && after > 0) || (before > 0 && after < 0);
}

/// Crossings, in x and y, of pairs drawn at random: the mean number.
double
crossings_per_pair(std::span<const SlopedRay> rays, std::int32_t first_z, std::int32_t last_z) {
    constexpr std::uint64_t pairs = 1000;
    std::size_t crossings = 0;
    for (std::uint64_t pair = 0; pair < pairs; ++pair) {
        const SlopedRay& a = rays[random(1988, pair, 0) % rays.size()];
        const SlopedRay& b = rays[random(1988, pair, 1) % rays.size()];
        crossings += cross(x_point(a), x_point(b), first_z, last_z) ? 1 : 0;
        crossings += cross(y_point(a), y_point(b), first_z, last_z) ? 1 : 0;
    }
    return static_cast<double>(crossings) / static_cast<double>(pairs);
}

} // namespace

std::size_t stated_level(std::size_t rectangles, std::size_t rays, TreeKind kind) {
    if (rectangles == 0 || rays == 0)
        return 0;
    const double level =
        (2 * std::log2(static_cast<double>(rays)) - std::log2(static_cast<double>(rectangles)))
        / (1 + (kind == TreeKind::optimal ? 0.5 : alpha));
    return std::min(
        static_cast<std::size_t>(std::lround(std::fmax(level, 0))), largest_level(rays));
}

std::size_t
sampled_level(std::span<const IsoRectangle> rectangles, std::span<const SlopedRay> rays) {
    if (rectangles.empty() || rays.empty())
        return 0;
    const auto by_z = [](const IsoRectangle& a, const IsoRectangle& b) { return a.z < b.z; };
    const auto [lowest, highest] = std::minmax_element(rectangles.begin(), rectangles.end(), by_z);
    std::int32_t first_z = largest_plane_coordinate;
    for (const SlopedRay& ray : rays)
        first_z = std::min(first_z, ray.first_z);
    first_z = std::max(first_z, lowest->z);
    if (first_z >= highest->z)
        return 0;
    // Steps of a crossing, of a rectangle in a group, and of what it takes to divide a ray's points
    // once more: their ratios decide.
    constexpr double steps_of_crossing = 30;
    constexpr double steps_of_rectangle = 30;
    constexpr double steps_of_division = 15;
    // On scattered rays a line leaves so many of 2^i nodes undecided: 2^(i growth).
    constexpr double growth = 0.55;
    const auto m = static_cast<double>(rays.size());
    const double crossings = 0.5 * m * m * crossings_per_pair(rays, first_z, highest->z);
    const auto steps = [&](std::size_t level) {
        const auto i = static_cast<double>(level);
        return steps_of_crossing * crossings * std::exp2(-i)
            + steps_of_rectangle * static_cast<double>(rectangles.size()) * std::exp2(growth * i)
            + steps_of_division * m * i;
    };
    std::size_t best = 0;
    for (std::size_t level = 1; level <= largest_level(rays.size()); ++level)
        if (steps(level) < steps(best))
            best = level;
    return best;
}

void sweep_groups(
    std::size_t level,
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    SweepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    require_swept(rectangles, swept);
    const std::size_t count = swept.rays.size();
    level = std::min(level, largest_level(count));
    require_memory(
        sweep_groups_bytes_forecast(level, rectangles.size(), count),
        "sweeps through " + std::to_string(rectangles.size()) + " rectangles with "
            + std::to_string(count) + " rays",
        "fewer rays at a time take less");
    std::vector<PlanePoint> y_points(count);
    std::transform(swept.rays.begin(), swept.rays.end(), y_points.begin(), y_point);
    SweepCounts together;
    std::mutex mutex;
    const auto sweep_node = [&](std::span<const std::uint32_t> rays, const Numbers& asked) {
        NodeSweeper sweeper(rectangles, swept, meeting, cancel);
        sweeper.counts.hulls += rectangles.size();
        const ConjugationTree inner(
            y_points, Numbers(rays.begin(), rays.end()), part_size(count, level), {}, cancel);
        sweeper.sweep(inner, asked);
        const std::lock_guard lock(mutex);
        together += sweeper.counts;
    };
    for_each_part(
        part_size(count, outer_level(level)),
        EqualPoints::together,
        rectangles,
        swept,
        sweep_node,
        progress,
        cancel);
    if (counts != nullptr)
        *counts += together;
}

FirstRectangles sweep_groups_first_rectangles(
    std::size_t level,
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    SweepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    FirstRectangles first(rays.size());
    sweep_groups(level, rectangles, {rays}, first_meeting(first), counts, progress, cancel);
    return first;
}

double sweep_groups_bytes_forecast(std::size_t level, std::size_t rectangles, std::size_t rays) {
    // Groups at work at once have no more rays than there are, and each list of rectangles no more
    // than there are: one for each node from the root to the group, and the group's own.
    const std::size_t lists = outer_level(level) + 2;
    const std::size_t each_rectangle =
        (lists + 1) * sizeof(std::uint32_t) + RayPart::bytes_per_rectangle;
    constexpr std::size_t each_ray = sizeof(PlanePoint) + RayPart::bytes_per_ray
        + sizeof(std::uint32_t) + ConjugationTree::building_bytes_per_point;
    return parts_bytes_forecast(outer_level(level), rectangles, rays)
        + sweep_bytes_forecast(0, rays)
        + static_cast<double>(parts_at_work(level) * rectangles * each_rectangle)
        + static_cast<double>(rays * each_ray)
        + ConjugationTree::bytes_forecast(rays, part_size(rays, level));
}

} // namespace vera
