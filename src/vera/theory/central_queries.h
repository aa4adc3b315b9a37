// SPDX-License-Identifier: Apache-2.0
// Rays from one point (VERA 3.2): the point is wrapped up in a cube, and what is seen of it through
// each of the cube's faces is a map. A ray passes through one face, at a point of its map, and the
// region in which that lies is the surface that the ray meets first. For n corners of which k edges
// cross, as seen from the point, the maps take O((n + k) log n) steps, and a ray O(log n).
#pragma once

#include "vera/base/parallel.h"
#include "vera/math/vec3.h"
#include "vera/scene/facets.h"
#include "vera/visible/region_locator.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace vera {

constexpr std::size_t cube_face_count = 6;

/// A place on a cube round the origin: face 0 lies in the direction of x, 1 opposite, 2 and 3 of y,
/// 4 and 5 of z. Both coordinates are those of the face's map, in steps of its grid.
struct CubePlace {
    std::size_t face = 0;
    double x = 0;
    double y = 0;
};

/// Where a ray from the middle passes the cube: the face of the longest component of its direction,
/// of equally long ones the lowest. Nothing where no component is different from 0, or one is not a
/// number.
std::optional<CubePlace> cube_place(Vec3 direction);

/// Answers which facet a ray from the centre meets first. What is asked may be asked from many
/// threads.
class CentralQueries {
public:
    /// Corners are rounded to a grid of 2^22 steps across each face, as in drawings: a facet's
    /// border may be 2^-21 radians off. Facets that penetrate each other are cut. Throws Cancelled,
    /// and std::runtime_error where the memory that is available does not suffice.
    CentralQueries(
        const Facets& facets,
        Vec3 center,
        LocatorKind kind = LocatorKind::slabs,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// The number of the facet that is seen in that direction, if any; on a border, either of those
    /// beside it. The direction need not be unit.
    std::optional<std::uint32_t> first_facet(Vec3 direction, LocatorSteps& steps) const;

    /// What was nearer to the centre than that, along an axis, was cut away; or 0.
    double cut_distance() const { return cut_distance_; }

    /// Pairs of facets that still penetrate each other.
    std::size_t penetrating() const { return penetrating_; }

    /// Borders in the six maps together.
    std::size_t borders() const { return borders_; }

    /// Bytes of memory that it holds.
    std::size_t memory() const;

private:
    struct Face {
        std::unique_ptr<RegionLocator> locator;
        std::vector<std::uint32_t> facets; ///< of each region
    };

    std::array<Face, cube_face_count> faces_;
    double cut_distance_ = 0;
    std::size_t penetrating_ = 0;
    std::size_t borders_ = 0;
};

} // namespace vera
