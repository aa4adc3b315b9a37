// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/space_sweep.h"

#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"

#include <string>
#include <vector>

namespace vera {

namespace {

/// What tells the plane of one sweep the rays of a rectangle.
class SweptTree {
public:
    SweptTree(
        const SweptRays& swept,
        const MovingPlane& plane,
        SweepCounts& counts,
        const CancelFlag* cancel)
        : tree_(swept.rays, plane.first_z(), plane.last_z(), counts)
        , cancel_(cancel) {}

    /// Many crossings may lie between two rectangles.
    void move_to(std::int32_t z) {
        constexpr std::uint64_t every = 1 << 16;
        for (std::uint64_t passed = 0; tree_.pass_crossing(z); ++passed)
            if (passed % every == 0)
                stop_if_raised(cancel_);
    }

    void begin(std::span<const std::uint32_t> rays) { tree_.add(rays); }

    void end(std::uint32_t ray) { tree_.remove(ray); }

    void append_met(const IsoRectangle& rectangle, std::vector<std::uint32_t>& met) {
        tree_.append_met(rectangle, met);
    }

private:
    KineticRangeTree tree_;
    const CancelFlag* cancel_;
};

} // namespace

void detail::sweep_checked(
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    SweepCounts& counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    stop_if_raised(cancel);
    if (rectangles.empty() || swept.rays.empty()) {
        if (progress)
            progress(1);
        return;
    }
    MovingPlane plane(rectangles, swept, meeting);
    SweptTree tree(swept, plane, counts, cancel);
    plane.run(tree, progress, cancel);
}

void sweep(
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    SweepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    require_swept(rectangles, swept);
    require_memory(
        sweep_bytes_forecast(rectangles.size(), swept.rays.size()),
        "a sweep through " + std::to_string(rectangles.size()) + " rectangles with "
            + std::to_string(swept.rays.size()) + " rays",
        "fewer rays at a time take less");
    SweepCounts steps;
    detail::sweep_checked(
        rectangles, swept, meeting, counts != nullptr ? *counts : steps, progress, cancel);
}

FirstRectangles sweep_first_rectangles(
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    SweepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    FirstRectangles first(rays.size());
    sweep(rectangles, {rays}, first_meeting(first), counts, progress, cancel);
    return first;
}

double sweep_bytes_forecast(std::size_t rectangles, std::size_t rays) {
    return KineticRangeTree::bytes_forecast(rays) + moving_plane_bytes_forecast(rectangles, rays);
}

} // namespace vera
