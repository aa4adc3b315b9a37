// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/scene/scene.h"

#include <vector>

namespace vera {

Box3 bounds(const Sphere& sphere);
Box3 bounds(const RotationalShape& shape);

/// The smallest box that holds the element, but for rounding; never smaller. The element must not
/// be a subscene call, for which there is subscene_bounds().
Box3 bounds(const Geometry& geometry, Element element);

/// Bounds of every subscene in its own coordinates, all that it calls included.
std::vector<Box3> subscene_bounds(const Scene& scene);

/// Bounds of item `number` of a geometry of the scene, given those of the subscenes.
Box3 bounds(const Geometry& geometry, std::size_t number, const std::vector<Box3>& subscenes);

/// Bounds of a geometry of the scene, given those of the subscenes.
Box3 bounds(const Geometry& geometry, const std::vector<Box3>& subscenes);

/// Bounds of the whole scene. Empty when it holds nothing.
Box3 bounds(const Scene& scene);

} // namespace vera
