// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/exact/screen_point.h"
#include "vera/scene/facets.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"
#include "vera/visible/projection.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace vera {

constexpr std::uint32_t no_curve = ~std::uint32_t{0};

/// The ellipse, in pixels, that the camera sees as the outline of the points
/// center + a1 axes[0] + a2 axes[1] + ... with a1^2 + a2^2 + ... <= 1: of an ellipsoid with three
/// axes, of an elliptic disc with two. Nothing where it is no ellipse, since a part of it is not
/// before the viewer, or is seen edge-on, as less than a thousandth of a pixel.
std::optional<DrawingEllipse> outline_ellipse(
    const CameraMap& map, const PictureSettings& picture, Vec3 center, std::span<const Vec3> axes);

/// How far, in pixels, what lies on a curve may be off it: as far as facets may, and the grid moves
/// points.
double curve_tolerance(const PictureSettings& picture, double deviation);

/// Where the picture shows the point, in pixels.
DrawingPoint in_pixels(const PictureSettings& picture, const RationalPoint& point);

/// The ellipses that lines of curved primitives lie upon: the silhouettes of spheres and of the
/// parts of rotational shapes that belong to one, and the circles at which these have edges.
class OutlineCurves {
public:
    /// None.
    OutlineCurves() = default;

    /// Of the primitives, which are in ascending order.
    OutlineCurves(
        const Scene& scene,
        const CameraMap& map,
        const PictureSettings& picture,
        std::span<const std::uint64_t> primitives);

    /// The curve of the facet's primitive and piece that is within the tolerance, in pixels, of the
    /// line's ends and middle; or no_curve. Of spheres only where the line is a silhouette.
    std::uint32_t curve_of(
        const Facets::Triangle& facet,
        bool is_silhouette,
        const std::array<DrawingPoint, 2>& ends,
        double tolerance) const;

    const DrawingEllipse& operator[](std::uint32_t curve) const { return curves_[curve]; }

    std::span<const DrawingEllipse> all() const { return curves_; }

private:
    /// Of a piece of a primitive the circles at which it begins and ends, and the silhouette of the
    /// sphere that it is a part of; or no_curve.
    struct OfPiece {
        std::uint32_t begin = no_curve;
        std::uint32_t end = no_curve;
        std::uint32_t sphere = no_curve;
    };

    struct OfPrimitive {
        std::uint64_t primitive = 0;
        std::size_t first_piece = 0; ///< in pieces_
    };

    /// The number of the outline of what has that center and these axes, in the shape's
    /// coordinates.
    using CurveOf = std::function<std::uint32_t(Vec3 center, std::vector<Vec3> axes)>;

    void add_pieces(const RotationalShape& shape, const CurveOf& curve);

    std::vector<OfPrimitive> primitives_;
    std::vector<OfPiece> pieces_;
    std::vector<DrawingEllipse> curves_;
};

} // namespace vera
