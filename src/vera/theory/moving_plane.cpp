// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/moving_plane.h"

#include "vera/base/check.h"

#include <numeric>

namespace vera {

namespace {

template <typename ZOf>
std::vector<std::uint32_t> numbers_by(std::size_t count, const ZOf& z_of) {
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
    std::sort(numbers.begin(), numbers.end(), [&](std::uint32_t a, std::uint32_t b) {
        return z_of(a) != z_of(b) ? z_of(a) < z_of(b) : a < b;
    });
    return numbers;
}

} // namespace

std::vector<std::uint32_t> rectangles_by_z(std::span<const IsoRectangle> rectangles) {
    return numbers_by(rectangles.size(), [&](std::uint32_t i) { return rectangles[i].z; });
}

std::vector<std::uint32_t> rays_by_first_z(std::span<const SlopedRay> rays) {
    return numbers_by(rays.size(), [&](std::uint32_t i) { return rays[i].first_z; });
}

void require_swept(std::span<const IsoRectangle> rectangles, const SweptRays& swept) {
    require_rectangles(rectangles);
    require_sloped_rays(swept.rays);
    VERA_CHECK(swept.last_z.empty() || swept.last_z.size() == swept.rays.size());
}

Meeting first_meeting(FirstRectangles& first) {
    return [&first](std::uint32_t rectangle, std::uint32_t ray) {
        first[ray] = rectangle;
        return std::numeric_limits<std::int32_t>::min();
    };
}

MovingPlane::MovingPlane(
    std::span<const IsoRectangle> rectangles, const SweptRays& swept, const Meeting& meeting)
    : rectangles_(rectangles)
    , swept_(swept)
    , meeting_(meeting)
    , by_z_(rectangles_by_z(rectangles))
    , by_first_z_(rays_by_first_z(swept.rays))
    , last_z_(swept.last_z.begin(), swept.last_z.end())
    , left_(swept.rays.size()) {
    last_z_.resize(swept.rays.size(), largest_plane_coordinate);
    for (std::uint32_t ray = 0; ray < last_z_.size(); ++ray)
        if (last_z_[ray] < last_z())
            ending_.push({last_z_[ray], ray});
}

std::int32_t MovingPlane::first_z() const {
    return std::max(rectangles_[by_z_.front()].z, swept_.rays[by_first_z_.front()].first_z);
}

double moving_plane_bytes_forecast(std::size_t rectangles, std::size_t rays) {
    // Orders by z, where rays end, those that begin and those that are told.
    constexpr std::size_t each_ray = 4 * sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);
    return static_cast<double>(rectangles * sizeof(std::uint32_t) + rays * each_ray);
}

} // namespace vera
