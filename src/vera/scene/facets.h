// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace vera {

/// The corners of facets: their own, or those of a mesh that has the same ones in this order, and
/// must outlive them.
class FacetCorners {
public:
    std::size_t size() const { return of_mesh_.empty() ? own_.size() : of_mesh_.size(); }

    /// All zeros are positive, so that equal corners have equal bits.
    Vec3 operator[](std::size_t i) const {
        return of_mesh_.empty() ? own_[i] : of_mesh_[i] + Vec3{};
    }

    std::size_t capacity() const { return own_.capacity(); }

    void reserve(std::size_t count) { own_.reserve(count); }

    void push_back(Vec3 corner) { own_.push_back(corner + Vec3{}); }

    /// In place of its own, of which there must be none.
    void share(std::span<const Vec3> of_mesh) { of_mesh_ = of_mesh; }

private:
    std::vector<Vec3> own_;
    std::span<const Vec3> of_mesh_;
};

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

    FacetCorners corners;
    std::vector<Triangle> triangles; ///< in the order of their primitives
};

/// How far from the curved surface a facet may lie near a point, both in the main scene's
/// coordinates. Infinity where it does not matter; what is not positive asks for as many facets as
/// there may be.
using Deviation = std::function<double(Vec3)>;

/// The most facets of one curved primitive: where the deviation asks for more, it is exceeded.
constexpr std::size_t most_facets_of_a_primitive = std::size_t{1} << 20U;

/// Whether facets may share the corners of a scene's only mesh, which must outlive them then.
enum class MeshCorners : std::uint8_t { copied, shared };

/// The scene's facets. Plane faces and patches keep their corners, curved surfaces have all theirs
/// on the surface. Closed surfaces are closed, corner number by corner number. The primitives must
/// be numbered. Throws Cancelled, InputError where there are 2^31 facets or corners, or more, and
/// std::runtime_error before they take all memory.
Facets facets(
    const Scene& scene,
    const Deviation& deviation,
    const CancelFlag* cancel = nullptr,
    MeshCorners mesh_corners = MeshCorners::copied);

} // namespace vera
