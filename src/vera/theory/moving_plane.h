// SPDX-License-Identifier: Apache-2.0
// A plane across the z axis that moves through rectangles and rays (VERA 3.3.2), whatever structure
// tells which rays a rectangle meets. At one z, rays cross first; then those begin that do there;
// then come the rectangles, in the order of their numbers; and then rays end. So a ray meets the
// rectangles in the order in which they lie along it.
#pragma once

#include "vera/base/long_loop.h"
#include "vera/theory/sloped_ray.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace vera {

/// Called where a ray meets a rectangle, by their numbers. Returns the last z up to which the ray
/// asks for more; one before the rectangle ends it at once.
using Meeting = std::function<std::int32_t(std::uint32_t rectangle, std::uint32_t ray)>;

/// Rays that end, too: what rectangles are asked about.
struct SweptRays {
    std::span<const SlopedRay> rays;
    std::span<const std::int32_t> last_z =
        {}; ///< of each, up to which it asks; empty: all to the end
};

/// The numbers of the rectangles in the order in which a plane that goes the way z grows comes to
/// them: by z, and by number in one plane.
std::vector<std::uint32_t> rectangles_by_z(std::span<const IsoRectangle> rectangles);

/// The numbers of the rays in the order in which it comes to their beginnings.
std::vector<std::uint32_t> rays_by_first_z(std::span<const SlopedRay> rays);

/// Throws std::invalid_argument as require_rectangles() and require_sloped_rays() do.
void require_swept(std::span<const IsoRectangle> rectangles, const SweptRays& swept);

/// A meeting that notes the first rectangle of each ray there, and ends the ray.
Meeting first_meeting(FirstRectangles& first);

/// The plane, from rectangle to rectangle. There must be some, and rays.
class MovingPlane {
public:
    MovingPlane(
        std::span<const IsoRectangle> rectangles, const SweptRays& swept, const Meeting& meeting);

    /// Before the first ray begins nothing has to be known: all may come from one point there.
    std::int32_t first_z() const;

    std::int32_t last_z() const { return rectangles_[by_z_.back()].z; }

    /// Moves it, and tells the structure:
    ///
    ///     structure.end(ray)               has ended, and perhaps never begun;
    ///     structure.move_to(z)             rays cross up to there;
    ///     structure.begin(rays)            these begin;
    ///     structure.append_met(rectangle, met)   asks for those that have begun and not ended.
    ///
    /// Throws Cancelled.
    template <typename Structure>
    void run(Structure& structure, const Progress& progress, const CancelFlag* cancel) {
        const LongLoop loop(by_z_.size(), progress, cancel, 64);
        for (std::size_t i = 0; i < by_z_.size() && left_ > 0; ++i) {
            loop.turn(i);
            const std::int32_t z = rectangles_[by_z_[i]].z;
            if (z < swept_.rays[by_first_z_.front()].first_z)
                continue;
            end_rays_before(z, structure);
            structure.move_to(z);
            begin_rays(z, structure);
            meet(by_z_[i], structure);
        }
        if (progress)
            progress(1);
    }

private:
    /// A last z and its ray.
    using Ending = std::pair<std::int32_t, std::uint32_t>;

    template <typename Structure>
    void begin_rays(std::int32_t z, Structure& structure) {
        beginning_.clear();
        for (; begun_ < by_first_z_.size(); ++begun_) {
            const std::uint32_t ray = by_first_z_[begun_];
            if (z < swept_.rays[ray].first_z)
                break;
            if (last_z_[ray] != ended)
                beginning_.push_back(ray);
        }
        if (!beginning_.empty())
            structure.begin(std::span(beginning_));
    }

    template <typename Structure>
    void end_rays_before(std::int32_t z, Structure& structure) {
        while (!ending_.empty() && ending_.top().first < z) {
            const std::uint32_t ray = ending_.top().second;
            ending_.pop();
            if (last_z_[ray] != ended && last_z_[ray] < z)
                end(ray, structure);
        }
    }

    template <typename Structure>
    void end(std::uint32_t ray, Structure& structure) {
        last_z_[ray] = ended;
        structure.end(ray);
        --left_;
    }

    template <typename Structure>
    void meet(std::uint32_t number, Structure& structure) {
        met_.clear();
        structure.append_met(rectangles_[number], met_);
        const std::int32_t z = rectangles_[number].z;
        for (const std::uint32_t ray : met_) {
            const std::int32_t last = std::min(meeting_(number, ray), last_z_[ray]);
            if (last < z) {
                end(ray, structure);
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
    std::vector<std::uint32_t> by_z_;
    std::vector<std::uint32_t> by_first_z_;
    std::vector<std::int32_t> last_z_;
    std::priority_queue<Ending, std::vector<Ending>, std::greater<>> ending_;
    std::size_t begun_ = 0;
    std::size_t left_; ///< rays that have not ended
    std::vector<std::uint32_t> beginning_;
    std::vector<std::uint32_t> met_;
};

/// What a MovingPlane takes of memory, in bytes, at most.
double moving_plane_bytes_forecast(std::size_t rectangles, std::size_t rays);

} // namespace vera
