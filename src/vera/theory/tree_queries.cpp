// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/tree_queries.h"

#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"
#include "vera/theory/ray_parts.h"

#include <mutex>
#include <string>
#include <vector>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

/// What tells the plane the rays of a rectangle.
class QueriedTrees {
public:
    QueriedTrees(const RayTrees& trees, StepCounts& counts)
        : live_(trees)
        , counts_(counts) {}

    /// Trees do not change where rays cross.
    void move_to(std::int32_t /*z*/) {}

    void begin(std::span<const std::uint32_t> rays) {
        for (const std::uint32_t ray : rays)
            live_.add(ray, counts_);
    }

    void end(std::uint32_t ray) {
        if (live_.is_live(ray))
            live_.remove(ray, counts_);
    }

    void append_met(const IsoRectangle& rectangle, Numbers& met) {
        live_.append_met(rectangle, met, counts_);
    }

private:
    LiveRays live_;
    StepCounts& counts_;
};

} // namespace

void query_trees(
    std::span<const IsoRectangle> rectangles,
    const RayTrees& trees,
    std::span<const std::int32_t> last_z,
    const Meeting& meeting,
    StepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    const SweptRays swept = {trees.rays(), last_z};
    require_swept(rectangles, swept);
    stop_if_raised(cancel);
    if (rectangles.empty() || swept.rays.empty()) {
        if (progress)
            progress(1);
        return;
    }
    StepCounts steps;
    QueriedTrees queried(trees, counts != nullptr ? *counts : steps);
    MovingPlane(rectangles, swept, meeting).run(queried, progress, cancel);
}

void query_trees(
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    StepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    require_swept(rectangles, swept);
    const std::size_t count = swept.rays.size();
    require_memory(
        query_trees_bytes_forecast(rectangles.size(), count),
        "nesting trees of " + std::to_string(count) + " rays among "
            + std::to_string(rectangles.size()) + " rectangles",
        "fewer rays at a time take less");
    StepCounts together;
    std::mutex mutex;
    const auto answer = [&](std::span<const std::uint32_t> rays, const Numbers& asked) {
        const RayPart part(rectangles, swept, rays, asked);
        const SweptRays of_part = part.swept();
        StepCounts steps;
        steps.nodes += rectangles.size(); // with which the part's hull was compared
        if (!asked.empty()) {
            const RayTrees trees(of_part.rays, RayTrees::usual_few, {}, cancel);
            const Meeting met = part.meeting(meeting);
            query_trees(part.rectangles(), trees, of_part.last_z, met, &steps, {}, cancel);
        }
        const std::lock_guard lock(mutex);
        together += steps;
    };
    for_each_part(
        part_size(count, usual_parts_level(count)),
        EqualPoints::apart,
        rectangles,
        swept,
        answer,
        progress,
        cancel);
    if (counts != nullptr)
        *counts += together;
}

FirstRectangles first_rectangles(
    std::span<const IsoRectangle> rectangles,
    const RayTrees& trees,
    StepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    FirstRectangles first(trees.rays().size());
    query_trees(rectangles, trees, {}, first_meeting(first), counts, progress, cancel);
    return first;
}

double query_trees_bytes_forecast(std::size_t rectangles, std::size_t rays) {
    const std::size_t level = usual_parts_level(rays);
    const std::size_t size = part_size(rays, level);
    const double of_part = RayTrees::bytes_forecast(size)
        + moving_plane_bytes_forecast(rectangles, size)
        + static_cast<double>(size * RayPart::bytes_per_ray
                              + rectangles * RayPart::bytes_per_rectangle);
    return parts_bytes_forecast(level, rectangles, rays)
        + static_cast<double>(parts_at_work(level)) * of_part;
}

} // namespace vera
