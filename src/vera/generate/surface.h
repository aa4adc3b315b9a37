// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/generate/formula.h"
#include "vera/math/box3.h"
#include "vera/scene/camera.h"
#include "vera/scene/primitives.h"

#include <cstddef>
#include <functional>
#include <string>

namespace vera {

/// A surface (x, y, z) of u and v, for u and v in their ranges, each from a smaller to a larger
/// number.
struct Surface {
    Formula x;
    Formula y;
    Formula z;
    double u_begin = 0;
    double u_end = 1;
    double v_begin = 0;
    double v_end = 1;
};

/// A surface cannot be made of triangles as asked for; what() says why.
class SurfaceError : public std::runtime_error {
public:
    SurfaceError(const std::string& problem, std::string advice)
        : std::runtime_error(problem)
        , remedy(std::move(advice)) {}

    std::string remedy; ///< what to do
};

/// The surface takes more triangles than are allowed.
class TooManyTriangles : public SurfaceError {
public:
    using SurfaceError::SurfaceError;
};

/// How far triangles may lie off a part of a surface that lies in the box; a length.
using AllowedDeviation = std::function<double(const Box3& part)>;

struct TessellationSettings {
    AllowedDeviation allowed;
    std::size_t most_triangles = 2'000'000;
    Progress progress = {};
    const CancelFlag* cancel = nullptr;
};

/// Triangles with normals so that no point of the surface lies farther from the triangle with the
/// same u and v than is allowed: proven by intervals, rounding included, not sampled. Parts that
/// bend more get more triangles; neighbours share their corners, and sides of the ranges that meet,
/// as those of a torus do, are joined, so that there is no gap. Normals are those of the surface;
/// where it has none, as at a pole, they are what it tends to.
///
/// Throws TooManyTriangles when it takes more than settings say, with an estimate of how many, and
/// SurfaceError where the surface has no finite value, jumps, has no area, is too far or too small
/// for a scene or for what is allowed. The same for any number of threads.
Mesh tessellated(const Surface& surface, const TessellationSettings& settings);

/// The box of a sample of points of the surface; empty where none is finite.
Box3 sampled_bounds(const Surface& surface);

/// The same length everywhere.
AllowedDeviation deviation_of(double length);

/// As much as shifts nothing by more than so many pixels in the picture of a perspective camera
/// that is so many pixels wide, with square pixels.
AllowedDeviation deviation_of_pixels(double pixels, const Camera& camera, std::uint32_t width);

} // namespace vera
