// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace vera {

/// The farthest point of one primitive, exact but for rounding. Not for subscene calls, and for a
/// mesh that of all its triangles.
Vec3 farthest_point(const Geometry& geometry, const Item& item, Vec3 direction);

/// Tells how far a scene reaches in any direction, subscenes included. Copies of a subscene that
/// cannot reach farther than what was found already are left out by their boxes, so that it costs
/// little where much is called. The scene must outlive it and not change.
class SceneSupport {
public:
    explicit SceneSupport(const Scene& scene);

    /// A point of the scene that lies farthest in the direction, but for rounding: by less than
    /// 2^-40 of how far the scene's box reaches. Nothing for an empty scene.
    std::optional<Vec3> farthest_point(Vec3 direction) const;

    const Box3& bounds() const { return bounds_; }

private:
    const Scene& scene_;
    std::vector<Box3> subscene_bounds_;
    Box3 bounds_;
};

} // namespace vera
