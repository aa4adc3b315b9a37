// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/math/color.h"
#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"
#include "vera/scene/surface.h"
#include "vera/visible/convex_piece.h"
#include "vera/visible/curved_piece.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace vera {

/// What a face gives back towards the viewer, place by place of the picture: the lighting formula
/// (VERA 2.3) without mirrors and glass, with the lights that reach it. Patches have their
/// interpolated normal, and the facets of a curved surface that of the surface itself: of the side
/// of a convex piece (FaceUnit::smooth) where the ray meets it, of others where it does near the
/// facet. Refers to the scene.
class RegionLight {
public:
    RegionLight(
        const Scene& scene,
        const Camera& camera,
        const PictureSettings& picture,
        const Facets& facets,
        std::uint32_t first_facet,
        LightSet lights = all_lights);

    /// At a point of the picture where the face is seen; as a screen shows it, from 0 to 1.
    Color operator()(DrawingPoint point) const;

    /// Whether the face is the side of a convex piece.
    bool is_smooth() const { return convexity_ != Convexity::none; }

private:
    SurfacePoint on_facet(const Ray& ray) const;
    SurfacePoint on_body(const Ray& ray) const;
    SurfacePoint at(Vec3 point, Vec3 local_normal) const;

    const Scene& scene_;
    ViewRays rays_;
    double width_;
    double height_;
    Color ambient_;
    Facets::Triangle facet_;
    PrimitivePath path_;
    Vec3 corner_;
    Vec3 normal_; ///< of the facet's plane, unit, towards the outside
    bool shows_outside_ = true;
    std::optional<Vec3> flat_normal_; ///< that of all places, in the primitive's coordinates
    std::optional<CurvedPiece> curved_;
    double parameter_ = 0; ///< of a curved piece, near to the facet
    Convexity convexity_ = Convexity::none;
    double reach_ = 0; ///< of a convex piece: all that is seen of it is that near to the corner
    LightSet lights_;
};

/// How far rounding may have moved the place, along any axis, that a ray of the picture sees of a
/// plane face: unlike where other rays end, it is not moved onto the face.
double error_of_seen(const Ray& ray, Vec3 point);

} // namespace vera
