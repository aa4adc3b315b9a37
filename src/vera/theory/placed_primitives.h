// SPDX-License-Identifier: Apache-2.0
// All primitives of a scene in a row, subscenes expanded at each call: with the box of each in the
// scene's coordinates, and the test that decides whether a ray meets it.
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"
#include "vera/math/box3.h"
#include "vera/math/transform.h"
#include "vera/scene/crossings.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// A geometry where a chain of calls has put it.
struct PlacedGeometry {
    const Geometry* geometry = nullptr;
    const SubsceneCall* call = nullptr; ///< that put it there; nullptr for the main scene's
    std::uint32_t caller = 0;           ///< number of the geometry that calls
    Affine3 to_scene;
    Affine3 from_scene;
};

/// A primitive there. Its number in the row is that of its FaceIds.
struct PlacedPrimitive {
    std::uint32_t place = 0; ///< number of its geometry
    Element element;
    MaterialId material = inherited_material;
};

class PlacedPrimitives {
public:
    /// The scene must outlive it. Throws std::runtime_error where the memory that is available does
    /// not suffice, and Cancelled.
    explicit PlacedPrimitives(const Scene& scene, const CancelFlag* cancel = nullptr);

    std::size_t size() const { return primitives_.size(); }

    const PlacedPrimitive& operator[](std::size_t number) const { return primitives_[number]; }

    /// The smallest box that holds the primitive, in the scene's coordinates, but for rounding;
    /// never smaller.
    Box3 box(std::size_t number) const;

    /// How far outside of its box, in the scene's coordinates, a primitive may be met by a ray that
    /// starts within so far of (0, 0, 0), of which rounding has moved the origin by no more than
    /// the error: since tests round.
    double slack(std::size_t number, double reach, double origin_error) const;

    /// Calls sink(t, face) for every crossing of the ray with that primitive: the one arithmetic
    /// that decides for every index.
    template <typename Sink>
    void for_each_crossing_of(std::size_t number, const QueryRay& query, const Sink& sink) const {
        const PlacedPrimitive& primitive = primitives_[number];
        for_each_crossing(
            *places_[primitive.place].geometry,
            primitive.element,
            primitive.place == 0 ? query.ray : carried(primitive.place, query.ray),
            query.start.primitive == number ? query.start.piece : no_piece,
            [&](double t, std::uint32_t piece) {
                sink(t, FaceId{number, piece});
            });
    }

    std::size_t bytes() const;

private:
    void place_all(const Scene& scene, const CancelFlag* cancel);

    /// The ray in the coordinates of the geometry there, carried call by call as every index does.
    Ray carried(std::uint32_t place, const Ray& ray) const;

    std::vector<PlacedGeometry> places_; ///< the main scene's first, and each before what it calls
    std::vector<PlacedPrimitive> primitives_;
};

} // namespace vera
