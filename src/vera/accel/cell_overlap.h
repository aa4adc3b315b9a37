// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"
#include "vera/scene/geometry.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera::detail {

/// A box as overlap tests want it.
struct Block {
    Vec3 center;
    Vec3 half; ///< half its extent
};

/// The shapes of a geometry's elements in local coordinates: center moved to 0, then all
/// multiplied by scale. Decides which cells an element is listed in.
class CellShape {
public:
    CellShape(const Geometry& geometry, Vec3 center, double scale)
        : geometry_(&geometry)
        , origin_(center)
        , scale_(scale) {}

    /// Makes this the shape of another element, which is not a subscene call.
    void assign(Element element);

    /// Whether the element's surface may pass through the block: never false where it does, and
    /// true without need only for rotational shapes, which are taken for the cylinders round their
    /// pieces, and for polygons that are not convex.
    bool touches(const Block& block) const;

private:
    enum class Kind : std::uint8_t { sphere, triangles, polygon, rotational };

    /// The part of a rotational shape from one height to another.
    struct Ring {
        double from = 0;
        double to = 0;
        double radius = 0;
    };

    Vec3 local(Vec3 point) const { return scale_ * (point - origin_); }

    void assign_triangle(std::size_t number, const std::array<Vec3, 3>& corners);
    void assign_polygon(const Polygon& polygon);
    void assign_rings(const RotationalShape& shape);
    bool sphere_touches(const Block& block) const;
    bool rings_touch(const Block& block) const;

    const Geometry* geometry_;
    Vec3 origin_;
    double scale_;

    Kind kind_ = Kind::sphere;
    Vec3 center_; ///< of the sphere; the base of the rotational shape
    Vec3 axis_;
    double radius_ = 0;
    std::array<std::array<Vec3, 3>, 2> triangles_;
    std::size_t triangle_count_ = 0;
    std::vector<Vec3> corners_;
    std::vector<Ring> rings_;
};

} // namespace vera::detail
