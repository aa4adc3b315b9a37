// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/math/vec3.h"
#include "vera/scene/hit.h"
#include "vera/scene/material.h"
#include "vera/scene/surface.h"

#include <cmath>

namespace vera {

/// What a view ray saw: of which surface, and of which colour, clamped.
struct Seen {
    bool found = false;
    bool below_profile = false; ///< the earth that PROFILE shapes, where nothing was found
    FaceId face;
    MaterialId material = inherited_material;
    Vec3 point;
    Vec3 normal;
    Color color;
};

inline Seen seen(const Hit& hit, const SurfacePoint& surface) {
    if (!hit.found())
        return {};
    return {true, false, surface.face, surface.material, surface.point, surface.shading_normal, {}};
}

/// Whether two rays saw the same surface, as far as a picture shows it: the sky, the earth, the
/// same face, or faces of one material that go over into each other without a crease or a step.
/// Tells nothing about size or scale.
inline bool same_surface(const Seen& a, const Seen& b) {
    constexpr double smallest_cosine = 0.9; // a crease of 26 degrees
    constexpr double largest_slope = 0.25;  // of the step, seen along the surface
    if (!a.found || !b.found)
        return a.found == b.found && a.below_profile == b.below_profile;
    if (a.face == b.face)
        return true;
    if (a.material != b.material || std::abs(dot(a.normal, b.normal)) < smallest_cosine)
        return false;
    const Vec3 step = b.point - a.point;
    const double rise = dot(a.normal, step);
    return rise * rise <= largest_slope * largest_slope * dot(step, step);
}

} // namespace vera
