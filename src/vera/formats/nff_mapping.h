// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/camera.h"
#include "vera/scene/material.h"
#include "vera/scene/primitives.h"

#include <cstdint>
#include <optional>

namespace vera {

// What becomes of the entities of an NFF scene; docs/nff.md tells users.

/// RTDEPTH of NFF scenes, where no control file says otherwise.
constexpr std::uint32_t nff_depth = 5;

/// v from x y z at x y z up x y z angle a hither h resolution w h
struct NffView {
    Vec3 from;
    Vec3 at;
    Vec3 up;
    double angle_degrees = 45; ///< between the left and the right side of the picture
    std::uint32_t width = 512;
    std::uint32_t height = 512;
};

/// The camera, its picture upright through `at` and its pixels square. Nothing where the view is
/// degenerate.
std::optional<Camera> camera_of(const NffView& view);

/// f red green blue Kd Ks Shine T index
struct NffFill {
    Color color;
    double kd = 0;
    double ks = 0;
    double shine = 0;
    double transmittance = 0;
    double index = 1;
};

Material material_of(const NffFill& fill);

/// The SPC whose highlight f(x)^2, f(x) = (x-SPC)(x+SPC-2)/(1-SPC)^2, falls to half its height
/// where x^shine does; 1, no highlight, for shine <= 0.
double spc_of(double shine);

/// c base.x base.y base.z base.r apex.x apex.y apex.z apex.r: open at both ends.
struct NffCone {
    Vec3 base;
    double base_radius = 0;
    Vec3 apex;
    double apex_radius = 0;
};

/// Its outer side is the convex one, and the other one where the radii are negative. Nothing
/// without any area.
std::optional<RotationalShape> shape_of(const NffCone& cone);

} // namespace vera
