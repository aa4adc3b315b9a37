// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <cstdint>
#include <memory>
#include <vector>

#include "reference/vector.h"

namespace vera::reference {

/// The line origin + t * direction; the direction is a unit vector, so that t is a distance.
struct Line {
    Vector origin;
    Vector direction;
};

struct Face;

/// Where a line crosses a face.
struct Crossing {
    Real t = 0;
    Real s = 0; ///< of a curved piece of a contour: the place along the piece, from 0 to 1
    const Face* face = nullptr;
};

/// The surface at a crossing. Both normals are unit vectors.
struct Surface {
    Vector outside; ///< the face's own normal, towards the outside
    Vector normal;  ///< that of the lighting: of patches the interpolated one
};

/// One face of the scene, in place: a triangle, polygon, patch, sphere, or one piece of a
/// rotational shape.
struct Face {
    Face() = default;
    Face(const Face&) = delete;
    Face& operator=(const Face&) = delete;
    virtual ~Face() = default;

    /// Adds the places where the whole line, in both directions, crosses the face. A line that
    /// starts on this face (its origin lies there) does not cross it at t = 0.
    virtual void
    cross(const Line& line, bool starts_here, std::vector<Crossing>& crossings) const = 0;
    virtual Surface surface(Vector point, const Crossing& crossing) const = 0;

    std::uint64_t order = 0; ///< the face's place in the text
    MaterialId material = inherited_material;

    // A ball that holds the face: a line that misses it need not be tried.
    Vector ball_center;
    Real ball_radius = 0;
};

/// The faces of a scene or of one subscene call, and the calls within it, each in a ball.
struct Group {
    std::vector<std::unique_ptr<Face>> faces;
    std::vector<Group> groups;
    Vector ball_center;
    Real ball_radius = 0;
};

/// All faces of the scene with every subscene written out at each of its calls.
Group faces_of(const Scene& scene);

/// All crossings of the line with the scene, in no order.
std::vector<Crossing> crossings(const Group& group, const Line& line, const Face* start);

} // namespace vera::reference
