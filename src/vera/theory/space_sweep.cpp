// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/space_sweep.h"

#include "vera/base/available_memory.h"
#include "vera/base/check.h"
#include "vera/base/long_loop.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>
#include <string>
#include <utility>
#include <vector>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

Numbers numbers_by(std::size_t count, const std::function<std::int32_t(std::uint32_t)>& z_of) {
    Numbers numbers(count);
    std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
    std::sort(numbers.begin(), numbers.end(), [&](std::uint32_t a, std::uint32_t b) {
        return z_of(a) != z_of(b) ? z_of(a) < z_of(b) : a < b;
    });
    return numbers;
}

/// One sweep, from rectangle to rectangle.
class Sweep {
public:
    Sweep(
        std::span<const IsoRectangle> rectangles,
        const SweptRays& swept,
        const Meeting& meeting,
        SweepCounts& counts)
        : rectangles_(rectangles)
        , swept_(swept)
        , meeting_(meeting)
        , by_z_(numbers_by(rectangles.size(), [&](std::uint32_t i) { return rectangles[i].z; }))
        , by_first_z_(
              numbers_by(swept.rays.size(), [&](std::uint32_t i) { return swept.rays[i].first_z; }))
        , last_z_(swept.last_z.begin(), swept.last_z.end())
        , left_(swept.rays.size())
        // Before the first ray begins nothing has to be known: all may come from one point there.
        , tree_(
              swept.rays,
              std::max(rectangles[by_z_.front()].z, swept.rays[by_first_z_.front()].first_z),
              rectangles[by_z_.back()].z,
              counts) {
        last_z_.resize(swept.rays.size(), largest_plane_coordinate);
        for (std::uint32_t ray = 0; ray < last_z_.size(); ++ray)
            if (last_z_[ray] < rectangles[by_z_.back()].z)
                ending_.push({last_z_[ray], ray});
    }

    void run(const Progress& progress, const CancelFlag* cancel) {
        const LongLoop loop(by_z_.size(), progress, cancel, 64);
        for (std::size_t i = 0; i < by_z_.size() && left_ > 0; ++i) {
            loop.turn(i);
            const std::int32_t z = rectangles_[by_z_[i]].z;
            if (z < swept_.rays[by_first_z_.front()].first_z)
                continue;
            end_rays_before(z);
            pass_crossings(z, cancel);
            begin_rays(z);
            meet(by_z_[i]);
        }
    }

private:
    /// A last z and its ray.
    using Ending = std::pair<std::int32_t, std::uint32_t>;

    /// Many crossings may lie between two rectangles.
    void pass_crossings(std::int32_t z, const CancelFlag* cancel) {
        constexpr std::uint64_t every = 1 << 16;
        for (std::uint64_t passed = 0; tree_.pass_crossing(z); ++passed)
            if (passed % every == 0)
                stop_if_raised(cancel);
    }

    void begin_rays(std::int32_t z) {
        for (; begun_ < by_first_z_.size(); ++begun_) {
            const std::uint32_t ray = by_first_z_[begun_];
            if (z < swept_.rays[ray].first_z)
                return;
            if (last_z_[ray] != ended)
                tree_.add(ray);
        }
    }

    void end_rays_before(std::int32_t z) {
        while (!ending_.empty() && ending_.top().first < z) {
            const std::uint32_t ray = ending_.top().second;
            ending_.pop();
            if (last_z_[ray] != ended && last_z_[ray] < z)
                end(ray);
        }
    }

    void end(std::uint32_t ray) {
        last_z_[ray] = ended;
        tree_.remove(ray);
        --left_;
    }

    void meet(std::uint32_t number) {
        met_.clear();
        tree_.append_met(rectangles_[number], met_);
        const std::int32_t z = rectangles_[number].z;
        for (const std::uint32_t ray : met_) {
            const std::int32_t last = std::min(meeting_(number, ray), last_z_[ray]);
            if (last < z) {
                end(ray);
            } else if (last < last_z_[ray]) {
                last_z_[ray] = last;
                ending_.push({last, ray});
            }
        }
    }

    /// Below what any ray's last z is.
    static constexpr std::int32_t ended = std::numeric_limits<std::int32_t>::min();

    std::span<const IsoRectangle> rectangles_;
    const SweptRays& swept_;
    const Meeting& meeting_;
    Numbers by_z_;
    Numbers by_first_z_;
    std::vector<std::int32_t> last_z_;
    std::priority_queue<Ending, std::vector<Ending>, std::greater<>> ending_;
    std::size_t begun_ = 0;
    std::size_t left_;
    Numbers met_;
    KineticRangeTree tree_;
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
    if (!rectangles.empty() && !swept.rays.empty())
        Sweep(rectangles, swept, meeting, counts).run(progress, cancel);
    if (progress)
        progress(1);
}

void sweep(
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    SweepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    require_rectangles(rectangles);
    require_sloped_rays(swept.rays);
    VERA_CHECK(swept.last_z.empty() || swept.last_z.size() == swept.rays.size());
    require_memory(
        sweep_bytes_forecast(rectangles.size(), swept.rays.size()),
        "a sweep through " + std::to_string(rectangles.size()) + " rectangles with "
            + std::to_string(swept.rays.size()) + " rays",
        "fewer rays at a time take less");
    SweepCounts steps;
    detail::sweep_checked(
        rectangles, swept, meeting, counts != nullptr ? *counts : steps, progress, cancel);
}

Meeting detail::first_meeting(FirstRectangles& first) {
    return [&first](std::uint32_t rectangle, std::uint32_t ray) {
        first[ray] = rectangle;
        return std::numeric_limits<std::int32_t>::min();
    };
}

FirstRectangles sweep_first_rectangles(
    std::span<const IsoRectangle> rectangles,
    std::span<const SlopedRay> rays,
    SweepCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    FirstRectangles first(rays.size());
    sweep(rectangles, {rays}, detail::first_meeting(first), counts, progress, cancel);
    return first;
}

double sweep_bytes_forecast(std::size_t rectangles, std::size_t rays) {
    // Beside the tree: orders by z, where rays end, those that are told.
    constexpr std::size_t each_ray = 3 * sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);
    return KineticRangeTree::bytes_forecast(rays)
        + static_cast<double>(rectangles * sizeof(std::uint32_t) + rays * each_ray);
}

} // namespace vera
