// SPDX-License-Identifier: Apache-2.0
// Places on spheres and on what a piece of a contour sweeps round its axis, found in few steps:
// what surface_within() looks for along the whole piece each time is near to a place that is known.
#pragma once

#include "vera/math/ray.h"
#include "vera/scene/contour.h"
#include "vera/scene/primitives.h"
#include "vera/scene/surface.h"
#include "vera/visible/convex_piece.h"

#include <cstdint>
#include <optional>

namespace vera {

/// A piece of a curved primitive, in the coordinates of its own geometry.
class CurvedPiece {
public:
    /// Of a sphere or rotational shape.
    CurvedPiece(const PrimitivePath& path, std::uint32_t piece);

    /// A place on a ray, and the surface's unit normal there, towards its outside.
    struct Place {
        double t = 0;
        Vec3 normal;
    };

    /// Where the ray meets the body of a convex piece; if it misses, where it is nearest to that,
    /// about. The body goes on beyond the piece's ends along the tangents there. Nothing where that
    /// is not found in some steps.
    std::optional<Place> meeting(const Ray& ray, const Passage& passage) const;

    /// Where the ray meets the surface near to the point at t, which is all but on it; where it
    /// goes along the surface, no farther than ten times as far as that is off. Looked for is from
    /// the parameter, of a contour, on, which becomes that of the place. Nothing where it is not
    /// found in some steps.
    std::optional<Place> meeting_near(const Ray& ray, double t, double& parameter) const;

    /// The parameter of the place of the contour that is nearest to the point; 0 of a sphere.
    double parameter_near(Vec3 point) const;

private:
    /// A place on the contour, and the tangent there.
    struct Contact;

    /// The place of the surface nearest to a point.
    struct Nearest {
        Vec3 normal;    ///< unit, towards the outside
        double off = 0; ///< how far the point is outside
    };

    std::optional<Place> sphere_meeting(const Ray& ray, const Passage& passage) const;
    Contact contact_at(double parameter) const;
    std::optional<Nearest> nearest_to(Vec3 point, double& parameter) const;
    double step_towards(const Contact& contact, ContourPiece::Point point) const;

    const Sphere* sphere_ = nullptr; ///< or else the shape
    const RotationalShape* shape_ = nullptr;
    ContourPiece contour_;
    ContourPiece::Point start_;
    Hodograph directions_ = {};
    double turned_ = 1; ///< -1 where the body is behind the inside
};

} // namespace vera
