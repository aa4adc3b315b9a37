// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/scene.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace vera {

/// A scene as plane triangles, in the coordinates of the main scene. Faces of one primitive share
/// their corners by number; those of different primitives that have a corner in common, in the same
/// geometry and under the same calls, have it to the bit.
struct Facets {
    /// Its corners run counterclockwise as seen from the outside that surface_at() tells. (Of a
    /// patch whose normals disagree, the outside in its middle.)
    struct Triangle {
        std::array<std::uint32_t, 3> corners = {};
        std::uint32_t piece = 0;     ///< as in FaceId
        std::uint64_t primitive = 0; ///< as in FaceId
        MaterialId material = inherited_material;
    };

    std::vector<Vec3> corners;
    std::vector<Triangle> triangles; ///< in the order of their primitives
};

/// How far from the curved surface a facet may lie near a point, both in the main scene's
/// coordinates. Infinity where it does not matter; what is not positive asks for as many facets as
/// there may be.
using Deviation = std::function<double(Vec3)>;

/// The most facets of one curved primitive: where the deviation asks for more, it is exceeded.
constexpr std::size_t most_facets_of_a_primitive = std::size_t{1} << 20U;

/// The scene's facets. Plane faces and patches keep their corners, curved surfaces have all theirs
/// on the surface. Closed surfaces are closed, corner number by corner number. The primitives must
/// be numbered. Throws Cancelled, InputError where there are 2^31 facets or corners, or more, and
/// std::runtime_error before they take all memory.
Facets facets(const Scene& scene, const Deviation& deviation, const CancelFlag* cancel = nullptr);

} // namespace vera
