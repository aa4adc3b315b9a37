// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/math/transform.h"
#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/visible/screen_scene.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace vera {

/// A point as a camera sees it: at x / w of the picture's width from the left, and y / w of its
/// height from below, if w is positive.
struct ImagePoint {
    double x = 0;
    double y = 0;
    double w = 1;     ///< 1 in the image plane, 0 in that of the view point; of parallel rays 1
    double depth = 0; ///< of parallel rays: how far behind the image plane, in unit directions
};

/// Maps points to where a camera sees them.
class CameraMap {
public:
    /// Throws InputError for a camera whose corners are on one line, or that looks along its image.
    explicit CameraMap(const Camera& camera);

    ImagePoint image_point(Vec3 point) const;

    bool is_parallel() const { return is_parallel_; }

    /// How large a pixel of a raster is at the point, in the scene's units, along its shorter side;
    /// never 0. Infinite where nothing is seen: behind the view point.
    double size_of_pixel(double columns, double rows, Vec3 point) const;

    /// How far something at the point may move across the ray to it, and moves no farther than a
    /// pixel; in all directions: where nothing is seen, beside the picture and behind the viewer,
    /// as far as in the farthest corner of the picture at that distance.
    double size_of_pixel_around(double columns, double rows, Vec3 point) const;

    /// How far the point lies behind the plane, parallel to the picture, of the view point; else 0.
    double way_behind(Vec3 point) const;

private:
    /// How far apart planes parallel to the picture are whose w, or depth, differs by 1.
    double unit_depth() const;

    Affine3 from_world_;
    bool is_parallel_ = false;
    double width_ = 0; ///< of the picture in the image plane
    double height_ = 0;
    Vec3 viewpoint_;             ///< unless the rays are parallel
    double farthest_corner_ = 1; ///< of the picture in the image plane, from the view point
};

/// Whose curved surfaces are to be near to what they stand for.
enum class FacetReach {
    seen,    ///< what lies before the viewer
    throwing ///< all that may throw shadows into the picture
};

/// How far facets may lie off curved surfaces: so many pixels of a picture. What the picture does
/// not show has facets as at its corners, since in the plane of the viewer a pixel has no size;
/// behind it, where nothing there throws shadows, as few as may be: off by as much as it lies
/// behind that plane, so that nothing comes before it by that. Refers to the map.
Deviation deviation_in_pixels(
    const CameraMap& map, double columns, double rows, double pixels, FacetReach reach);

/// The facets as the camera sees them: cut at the frame and before the viewer, and moved to the
/// grid, of which y grows downward. sources[i] is that of facet i. Points that coincide are one.
/// What is farther than w = farthest is cut away. Throws Cancelled.
ScreenScene screen_scene(
    const Facets& facets,
    const CameraMap& map,
    std::span<const std::uint32_t> sources,
    double farthest = std::numeric_limits<double>::infinity(),
    const CancelFlag* cancel = nullptr);

} // namespace vera
