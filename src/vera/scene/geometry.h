// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/math/transform.h"
#include "vera/scene/material.h"
#include "vera/scene/primitives.h"

#include <compare>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace vera {

/// Number of a subscene in Scene::subscenes.
enum class SubsceneId : std::uint32_t {};

/// SSC name {MX m11..m34 | RT ax ay az | TR x y z | SC f}
struct SubsceneCall {
    SubsceneId subscene = {};
    Affine3 to_parent;   ///< carries the subscene's points into the calling scene
    Affine3 from_parent; ///< its inverse
};

enum class ItemKind : std::uint8_t {
    sphere,
    triangle,
    polygon,
    patch,
    rotational_shape,
    mesh,
    subscene_call
};

/// Which side of a plane face or patch is the outside. Spheres and rotational shapes ignore it.
enum class Outside : std::uint8_t {
    by_normal,     ///< no inner point: where the normal points, of patches the interpolated one
    along_normal,  ///< where the face's own (geometric) normal points
    against_normal ///< the other side
};

/// A statement of geometry: what it is, and what the attributes that held there said.
struct Item {
    ItemKind kind = ItemKind::sphere;
    Outside outside = Outside::by_normal;
    std::uint16_t file = 0;  ///< number in Scene::files
    std::uint32_t index = 0; ///< number in the vector of its kind
    MaterialId material = inherited_material;
    std::uint32_t line = 0; ///< in the file, from 1
};

/// A primitive of a geometry, or a subscene call, as an index sees it: item number `item`, and of a
/// mesh, triangle number `triangle`. Elements are numbered in text order, mesh triangles each.
struct Element {
    std::uint32_t item = 0;
    std::uint32_t triangle = 0;

    /// By the order of the text.
    friend auto operator<=>(const Element&, const Element&) = default;
};

/// Elements one behind the other that a mesh file gives a name: an object (o) of an OBJ file, or a
/// group (g) in one. See named_parts.h.
struct NamedPart {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::string name; ///< as the file has it, in whatever encoding; not empty
    Element first;
    Element end;                 ///< behind the last one: of another item, its triangle 0
    std::uint32_t parent = none; ///< number of the smallest one that this is within
};

/// An item that holds more than one primitive, or none: where its elements and primitives begin.
struct Compound {
    std::uint32_t item = 0;
    std::uint64_t first_element = 0;
    std::uint64_t first_primitive = 0;
};

/// The main scene's geometry or a subscene's, in its own coordinates.
struct Geometry {
    std::string name; ///< of the subscene; empty for the main scene
    std::vector<Sphere> spheres;
    std::vector<Triangle> triangles;
    std::vector<Polygon> polygons;
    std::vector<Vec3> corners; ///< of the polygons
    std::vector<Patch> patches;
    std::vector<RotationalShape> rotational_shapes;
    std::vector<Mesh> meshes;
    std::vector<SubsceneCall> calls;

    std::vector<Item> items; ///< all of the above in text order

    /// In the order of their first elements, each before those within it. None is empty, and two
    /// that have an element in common are one within the other.
    std::vector<NamedPart> named_parts;

    // Derived by number_primitives(Scene&).
    std::vector<Compound> compounds;   ///< the meshes and subscene calls, in text order
    std::uint64_t element_count = 0;   ///< primitives, with subscene calls counted once each
    std::uint64_t primitive_count = 0; ///< primitives, with subscenes expanded at each call
};

/// Element number i < element_count.
Element element_at(const Geometry& geometry, std::uint64_t i);

/// The number, in text order with subscenes expanded, of the element's (first) primitive.
std::uint64_t primitive_number(const Geometry& geometry, Element element);

} // namespace vera
