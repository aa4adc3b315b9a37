// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/query_grid.h"

#include <algorithm>
#include <cmath>

namespace vera {

namespace {

/// How far a whole ray may lie off the ray, in units, up to where planes end on the other side:
/// half a unit a step, half a unit where it begins, and what double precision adds to that.
constexpr std::int32_t largest_deviation = QueryGrid::farthest_step + 2;

/// Where a ray that is not steep and comes to any box is at most, in units, in the middle of the
/// scene.
static_assert(
    static_cast<double>(QueryGrid::farthest_step) * QueryGrid::units_in_step
            * (1 + QueryGrid::steepest)
        + largest_deviation
    < largest_plane_coordinate);

/// The largest box and its margin fit.
static_assert((2 * QueryGrid::steps + 20) / 26 + QueryGrid::steps + 10 < QueryGrid::farthest_step);

/// The margin that lets steep rays enter elsewhere, as a part of the longest side, two steps
/// included: m with steepest m >= side + 2 m + 2 steps.
double margin_of(double longest_side) {
    return (longest_side + 2) / (QueryGrid::steepest - 2);
}

/// As a whole number that is not beyond the farthest.
std::int32_t clamped_step(double step) {
    constexpr double beyond = QueryGrid::farthest_step + 1;
    return static_cast<std::int32_t>(std::clamp(step, -beyond, beyond));
}

} // namespace

QueryGrid::QueryGrid(const Box3& bounds)
    : center_(center(bounds)) {
    int exponent = 0;
    const double largest = max_component(0.5 * bounds.upper - 0.5 * bounds.lower);
    if (largest > 0)
        std::frexp(largest, &exponent);
    scale_ = std::ldexp(1.0, -std::max(exponent, -1000)); // which must not overflow
}

bool QueryGrid::can_hold(const Ray& ray) const {
    const double origin_size = max_component(abs(scale_ * (ray.origin - center_)));
    const double direction_size = max_component(abs(ray.direction));
    // What is not a number fails all.
    return ray.t_min >= 0 && ray.t_max >= 0 && origin_size < farthest_origin
        && scale_ * ray.origin_error < largest_origin_error && direction_size > 1e-280
        && direction_size < 1e280 && is_finite(ray.direction);
}

double QueryGrid::beginning(const Ray& ray) const {
    if (ray.t_min >= 0)
        return 0;
    // Farther along some axis than the largest box on the other side.
    const double origin_size = max_component(abs(scale_ * (ray.origin - center_)));
    const double direction_size = scale_ * max_component(abs(ray.direction));
    return std::fmax(ray.t_min, -(origin_size + 2) / direction_size);
}

double QueryGrid::reach() const {
    return max_component(abs(center_)) + farthest_origin / scale_;
}

std::optional<StepBox> QueryGrid::larger_box(const Box3& box, double slack) const {
    // Below what the margins are right to: that the ray's own rounding adds a step's 2^-20.
    const double slack_steps = steps * scale_ * slack + 0x1p-8;
    if (!(slack_steps < 8))
        return {};
    const double longest = steps * scale_ * max_component(extent(box)) + 2 * slack_steps;
    const double margin = slack_steps + margin_of(longest);
    StepBox result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lower = std::floor(step_at(box.lower, axis) - margin);
        const double upper = std::ceil(step_at(box.upper, axis) + margin);
        if (!(lower >= -farthest_step && upper <= farthest_step))
            return {};
        result.lower[axis] = static_cast<std::int32_t>(lower);
        result.upper[axis] = static_cast<std::int32_t>(upper);
    }
    return result;
}

Box3 QueryGrid::scene_box(const StepBox& box) const {
    // A little larger than what its steps say: what begins on its border begins within.
    constexpr double rounding = 0x1p-8;
    const double size = 1 / (steps * scale_);
    Box3 result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        result.lower[axis] = center_[axis] + (box.lower[axis] - rounding) * size;
        result.upper[axis] = center_[axis] + (box.upper[axis] + rounding) * size;
    }
    return result;
}

IsoRectangle QueryGrid::entry(const StepBox& box, SweepDirection direction) const {
    const std::size_t x = (direction.axis + 1) % 3;
    const std::size_t y = (direction.axis + 2) % 3;
    return {
        direction.upwards ? box.lower[direction.axis] : -box.upper[direction.axis],
        box.lower[x] * units_in_step - largest_deviation,
        box.upper[x] * units_in_step + largest_deviation,
        box.lower[y] * units_in_step - largest_deviation,
        box.upper[y] * units_in_step + largest_deviation};
}

std::optional<SlopedRay> QueryGrid::sloped_ray(const Ray& ray, SweepDirection direction) const {
    const double sense = direction.upwards ? 1 : -1;
    const double way = sense * ray.direction[direction.axis];
    if (!(way * steepest >= max_component(abs(ray.direction))))
        return {};
    const double start = sense * step_at(ray.origin, direction.axis);
    // Rays begin behind the planes of those that come from the same point, never before them.
    const double first = std::ceil(std::fmax(start, -farthest_step));
    if (first > farthest_step)
        return {};
    SlopedRay result;
    result.first_z = static_cast<std::int32_t>(first);
    const auto set = [&](std::size_t axis, std::int32_t& slope, std::int32_t& offset) {
        const double exact_slope = ray.direction[axis] / way;
        const double at_first =
            units_in_step * (step_at(ray.origin, axis) + exact_slope * (first - start));
        slope = static_cast<std::int32_t>(std::lround(units_in_step * exact_slope));
        const double at_zero = std::round(at_first) - static_cast<double>(slope) * first;
        if (!(std::abs(at_zero) <= largest_plane_coordinate))
            return false;
        offset = static_cast<std::int32_t>(at_zero);
        return true;
    };
    if (!set((direction.axis + 1) % 3, result.slope_x, result.offset_x)
        || !set((direction.axis + 2) % 3, result.slope_y, result.offset_y))
        return {};
    return result;
}

std::int32_t QueryGrid::last_step(const Ray& ray, double t, SweepDirection direction) const {
    const double sense = direction.upwards ? 1 : -1;
    const double last = sense
        * (step_at(ray.origin, direction.axis)
           + steps * (scale_ * (t * ray.direction[direction.axis])));
    return clamped_step(std::floor(last + 0x1p-8));
}

} // namespace vera
