// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace vera {

/// How the terms of the lighting formula (VERA 2.3) that make up a ray's colour are numbered: Amb;
/// Dif of each light, in the order of the scene; Spk of each light; Slm; and what a ray sees that
/// leaves the scene. Rfl and Rfr are themselves sums of these, of what a further ray sees.
struct RayTerms {
    std::size_t lights = 0;

    static constexpr std::size_t ambient() { return 0; }

    constexpr std::size_t diffuse(std::size_t light) const { return 1 + light; }

    constexpr std::size_t highlight(std::size_t light) const { return 1 + lights + light; }

    constexpr std::size_t luminosity() const { return 1 + 2 * lights; }

    constexpr std::size_t firmament() const { return 2 + 2 * lights; }

    constexpr std::size_t count() const { return 3 + 2 * lights; }
};

/// On which way a term comes to the eye: from the surface that is seen (or the firmament), or by
/// what that surface mirrors (Rfl) or lets through (Rfr), however the ray goes on from there.
enum class LightWay : std::size_t { direct, mirrored, refracted };

constexpr std::size_t light_way_count = 3;

/// Where the term stands among those of a ray, of which there are light_way_count * count(): all
/// that come directly, then the mirrored ones, then the refracted ones.
constexpr std::size_t term_number(const RayTerms& terms, LightWay way, std::size_t term) {
    return static_cast<std::size_t>(way) * terms.count() + term;
}

} // namespace vera
