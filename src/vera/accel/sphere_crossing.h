// SPDX-License-Identifier: Apache-2.0
// Where a ray meets a sphere: the arithmetic, in double precision, that decides in the end whatever
// way a SphereIndex has searched.
//
// The line comes nearest to the center at t = m, and passes it at the distance |l|, with l the part
// of the way from the origin to the center that lies across the direction d. It then meets the
// sphere of radius r at m - h and m + h, with h = sqrt((r^2 - |l|^2) / |d|^2), and does not where
// |l| > r. To square the distance |l| loses far less than the difference of squares of the
// quadratic equation does, which is between numbers as large as the way's square (Haines, Guenther
// and Akenine-Moeller, Precision improvements for ray/sphere intersection, Ray Tracing Gems 2019).
#pragma once

#include "vera/accel/float_tree.h"
#include "vera/accel/sphere_index.h"
#include "vera/math/vec3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace vera::detail {

/// The t at which a line enters a sphere and leaves it; the same where it touches it.
struct SphereCrossings {
    double enter = 0;
    double leave = 0;
};

/// A ray as it is tested against spheres.
struct SphereRay {
    Vec3 origin;
    Vec3 direction;
    double per_square = 0; ///< 1 / the square of the direction's length
    double t_min = 0;
    double t_max = 0;

    /// What lies beyond the largest float is not met: there is no t for it.
    explicit SphereRay(const IndexRay& ray)
        : origin(in_double(ray.origin))
        , direction(in_double(ray.direction))
        , per_square(1 / dot(direction, direction))
        , t_min(static_cast<double>(std::max(ray.t_min, -std::numeric_limits<float>::max())))
        , t_max(static_cast<double>(std::min(ray.t_max, std::numeric_limits<float>::max()))) {}

    bool covers(double t) const { return t_min <= t && t <= t_max; }
};

/// Whether a sphere can be met: its numbers are finite and its radius is not negative.
inline bool is_sphere(const std::array<float, 4>& sphere) {
    return std::isfinite(sphere[0]) && std::isfinite(sphere[1]) && std::isfinite(sphere[2])
        && std::isfinite(sphere[3]) && sphere[3] >= 0;
}

/// Where the ray's line meets the sphere, in the order of operations that every way of answering
/// follows. The numbers of any ray that is followed and of any sphere neither overflow nor vanish
/// in double precision.
inline std::optional<SphereCrossings>
sphere_crossings(const SphereRay& ray, const std::array<float, 4>& sphere) {
    const Vec3 way = in_double({sphere[0], sphere[1], sphere[2]}) - ray.origin;
    const auto radius = static_cast<double>(sphere[3]);
    const double middle = dot(way, ray.direction) * ray.per_square;
    const Vec3 across = way - middle * ray.direction;
    const double rest = radius * radius - dot(across, across);
    if (!(rest >= 0))
        return std::nullopt;
    const double half = std::sqrt(rest * ray.per_square);
    return SphereCrossings{middle - half, middle + half};
}

/// The first of the crossings that the ray covers: where it enters the sphere, or, where that is
/// before its beginning, where it leaves it.
inline std::optional<double> first_covered(const SphereRay& ray, const SphereCrossings& crossings) {
    const double t = crossings.enter >= ray.t_min ? crossings.enter : crossings.leave;
    if (!ray.covers(t))
        return std::nullopt;
    return t;
}

/// What is told of a crossing: without -0.
inline SphereHit sphere_hit(double t, std::uint32_t sphere) {
    return {static_cast<float>(t) + 0.0F, sphere};
}

/// Decides which spheres a ray meets, and which first of those that are considered. The ray is
/// followed: see is_followed().
class SphereDecider {
public:
    SphereDecider(SphereSpan spheres, const IndexRay& ray)
        : spheres_(spheres)
        , ray_(ray) {}

    /// Of a sphere of this center and radius.
    bool meets(const std::array<float, 4>& numbers) const { return first_t(numbers).has_value(); }

    bool meets(std::uint32_t sphere) const { return meets(spheres_[sphere]); }

    /// The sphere, whose center and radius the caller knows already.
    void consider(std::uint32_t sphere, const std::array<float, 4>& numbers) {
        const std::optional<double> t = first_t(numbers);
        if (t && (*t < t_ || (*t == t_ && sphere < sphere_))) {
            t_ = *t;
            sphere_ = sphere;
        }
    }

    void consider(std::uint32_t sphere) { consider(sphere, spheres_[sphere]); }

    /// Of the nearest crossing so far; infinity where there is none.
    double t() const { return t_; }

    SphereHit hit() const { return sphere_ == no_sphere ? SphereHit{} : sphere_hit(t_, sphere_); }

    /// Calls add(hit, t) for each crossing with the sphere that the ray covers.
    template <typename Add>
    void for_each_hit(std::uint32_t sphere, const Add& add) const {
        const auto crossings = sphere_crossings(ray_, spheres_[sphere]);
        if (!crossings)
            return;
        if (ray_.covers(crossings->enter))
            add(sphere_hit(crossings->enter, sphere), crossings->enter);
        if (crossings->leave != crossings->enter && ray_.covers(crossings->leave))
            add(sphere_hit(crossings->leave, sphere), crossings->leave);
    }

private:
    std::optional<double> first_t(const std::array<float, 4>& numbers) const {
        const auto crossings = sphere_crossings(ray_, numbers);
        return crossings ? first_covered(ray_, *crossings) : std::nullopt;
    }

    SphereSpan spheres_;
    SphereRay ray_;
    double t_ = std::numeric_limits<double>::infinity();
    std::uint32_t sphere_ = no_sphere;
};

} // namespace vera::detail
