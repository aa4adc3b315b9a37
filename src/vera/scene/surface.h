// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/ray.h"
#include "vera/scene/hit.h"
#include "vera/scene/scene.h"

namespace vera {

/// What the lighting needs to know of the place where a ray meets a face, in the main scene's
/// coordinates.
struct SurfacePoint {
    Vec3 point;             ///< moved onto the face to within rounding
    double point_error = 0; ///< bound of what rounding may have moved it, along any axis
    Vec3 geometric_normal;  ///< unit, of the face itself, towards the outside
    Vec3 shading_normal;    ///< unit; of patches the interpolated one, else the geometric normal;
                            ///< in no way turned towards the viewer
    MaterialId material = inherited_material; ///< inherited where none was ever said
    FaceId face;
};

/// The place that a hit of a ray with this scene names. The hit must be one of the ray's.
SurfacePoint surface_at(const Scene& scene, const Ray& ray, const Hit& hit);

/// The geometry, element and way into a subscene that a primitive's number names.
struct PrimitivePath {
    const Geometry* geometry = nullptr;
    Element element;
    Affine3 to_world;   ///< from the geometry's coordinates to the main scene's
    Affine3 from_world; ///< its inverse, composed of the calls' own inverses
    MaterialId material = inherited_material;
    std::uint32_t depth = 0;   ///< how many subscene calls lead there
    bool in_main_scene = true; ///< then both maps are the identity
};

PrimitivePath path_to(const Scene& scene, std::uint64_t primitive);

/// The place on that piece of the primitive's face that a point near it stands for, both in the
/// coordinates of path.geometry.
SurfacePoint surface_within(const PrimitivePath& path, std::uint32_t piece, Vec3 local_point);

/// The same place in the main scene's coordinates.
SurfacePoint carried_to_main_scene(const PrimitivePath& path, const SurfacePoint& local);

} // namespace vera
