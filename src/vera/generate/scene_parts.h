// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <string>

namespace vera {

// How generators put scenes together: parts are added in the order in which they would stand in a
// text.

/// A new material of that name and colour.
MaterialId add_material(Scene& scene, std::string name, Color diffuse);

/// A new, empty subscene; scene.subscenes[number of it] is its geometry.
SubsceneId add_subscene(Scene& scene, std::string name);

Geometry& geometry_of(Scene& scene, SubsceneId subscene);

void add(Geometry& geometry, const Sphere& sphere, MaterialId material = inherited_material);
void add(Geometry& geometry, const Triangle& triangle, MaterialId material = inherited_material);
void add(Geometry& geometry, RotationalShape shape, MaterialId material = inherited_material);
void add(Geometry& geometry, Mesh mesh, MaterialId material = inherited_material);

/// A plane convex polygon, its corners counterclockwise as seen from its outside.
void add_convex_polygon(
    Geometry& geometry, const std::vector<Vec3>& corners, MaterialId material = inherited_material);

/// The map must be invertible.
void add_call(
    Geometry& geometry,
    SubsceneId subscene,
    const Affine3& to_parent,
    MaterialId material = inherited_material);

/// The side of a cone that is cut off, or of a cylinder, between two different points; open at both
/// ends. The radii are not both 0.
RotationalShape cone_between(Vec3 base, double base_radius, Vec3 tip, double tip_radius);

/// A map that turns the y axis into the unit vector, by the shortest way, and leaves the origin.
Affine3 turned_from_y(Vec3 direction);

/// Leaves out subscenes that are called from nowhere.
void remove_unused_subscenes(Scene& scene);

/// The nearest multiples of 1e-6, which are short in texts.
Vec3 short_decimals(Vec3 a);

/// A map whose numbers are such multiples; it must stay invertible.
Affine3 short_decimals(const Affine3& map);

/// First one, then the other.
template <typename... Maps>
Affine3 in_turn(const Affine3& first, const Maps&... then) {
    Affine3 map = first;
    ((map = composed(then, map)), ...);
    return map;
}

} // namespace vera
