// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/math/vec3.h"
#include "vera/scene/light.h"
#include "vera/scene/material.h"
#include "vera/scene/scene.h"
#include "vera/scene/surface.h"

#include <optional>

namespace vera {

/// A place on a surface as the lighting formula sees it (VERA 2.3): the vectors that it names, all
/// unit, turned to the side that the ray comes from.
struct Incidence {
    Vec3 point;
    double point_error = 0; ///< as of a SurfacePoint
    Vec3 to_viewer;         ///< R: back along the ray
    Vec3 normal;            ///< N: R.N >= 0; of patches the interpolated one
    Vec3 geometric_normal;  ///< of the face itself, turned to the side of R
    Vec3 mirrored;          ///< S: R mirrored at N
    double cos_viewer = 1;  ///< R.N
    bool from_outside = true;
};

/// ray_direction is a unit vector.
Incidence incidence(const SurfacePoint& surface, Vec3 ray_direction);

/// Whether the light, so far from the point, is on the side of R, both of N and of the face itself,
/// which blocks the light behind it. One in the face's plane, as far as rounding tells, is not.
bool is_lit_from(const Incidence& at, Vec3 to_light);

/// Dif and Spk of one light.
struct LightTerms {
    Color diffuse;
    Color highlight;

    friend constexpr bool operator==(const LightTerms&, const LightTerms&) = default;
};

constexpr bool is_black(const LightTerms& terms) {
    return is_black(terms.diffuse) && is_black(terms.highlight);
}

/// What the light gives where nothing stands between it and the surface.
LightTerms unshadowed(const Incidence& at, const Material& material, const PointLight& light);

constexpr LightTerms operator*(Color visibility, const LightTerms& terms) {
    return {visibility * terms.diffuse, visibility * terms.highlight};
}

/// The factor of a highlight before it is squared: 1 at x = 1, falling to 0 at x = spc.
double highlight_factor(double x, double spc);

/// The terms of the formula that come from the surface itself. Dif and Spk are sums over the lights
/// in the order of the scene.
struct LocalTerms {
    Color ambient;    ///< Amb
    Color diffuse;    ///< Dif
    Color highlight;  ///< Spk
    Color luminosity; ///< Slm

    friend constexpr bool operator==(const LocalTerms&, const LocalTerms&) = default;
};

/// Slm.
constexpr Color luminosity(double cos_viewer, const Material& material) {
    return cos_viewer * material.san + material.sdi;
}

/// Amb and Slm; the others are 0.
LocalTerms unlit(const Incidence& at, const Material& material, Color ambient_light);

constexpr LocalTerms& operator+=(LocalTerms& terms, const LightTerms& light) {
    terms.diffuse += light.diffuse;
    terms.highlight += light.highlight;
    return terms;
}

/// ((Amb + Dif) + Spk) + Slm, in this order; Rfl and then Rfr are added to it.
constexpr Color sum(const LocalTerms& terms) {
    return terms.ambient + terms.diffuse + terms.highlight + terms.luminosity;
}

/// The direction, unit, of the ray that goes on into the material or out of it, by Snell's law
/// between ref inside and 1 outside; nothing when it is totally reflected.
std::optional<Vec3> refracted(const Incidence& at, double ref);

/// The material of that number, or what stands for a missing one.
const Material& material_of(const Scene& scene, MaterialId material);

} // namespace vera
