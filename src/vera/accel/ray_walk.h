// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/math/box3.h"
#include "vera/math/color.h"
#include "vera/math/transform.h"
#include "vera/scene/hit.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// The main scene, or a subscene as it is called somewhere, that a ray comes to.
struct WalkedPlace {
    std::size_t geometry = 0;          ///< 0: the main scene; else 1 + number of the subscene
    std::uint64_t first_primitive = 0; ///< as a FaceId numbers them
    std::size_t depth = 0;             ///< of calls: of the main scene 0
    Affine3 to_scene;                  ///< from its own coordinates
};

/// An object in a list that a ray comes to, and what becomes of it there.
struct WalkedObject {
    enum class Outcome : std::uint8_t {
        missed,  ///< tested; of a call: what it holds is not near the ray
        met,     ///< tested: the ray crosses it, be it behind something else
        again,   ///< not tested: it was in another list before
        entered, ///< a call, whose grids or nodes are followed
        searched ///< a call nested so deeply that all of its objects were tested
    };

    std::uint64_t primitive = 0; ///< as a FaceId has it; of a call the first that it holds
    bool is_call = false;        ///< calls do not count as tests
    Outcome outcome = Outcome::missed;
    double t = 0;            ///< where met: of the first crossing
    std::size_t place = 0;   ///< where entered: number in RayWalk::places
    std::uint64_t tests = 0; ///< where searched
};

/// A step of a ray through an index. Cells and nodes are what QueryCounts::cells counts; grids,
/// cells and nodes are numbered from 0.
struct WalkStep {
    enum class Kind : std::uint8_t {
        cell, ///< of a tree of grids
        node, ///< of a hierarchy of boxes
        leaf  ///< a list of objects there
    };

    Kind kind = Kind::cell;
    std::size_t place = 0;    ///< number in RayWalk::places
    std::uint32_t level = 1;  ///< from the top; a call's first grid or node is one below the call
    std::uint32_t number = 0; ///< of the grid, or of the node, in its place
    std::array<std::int32_t, 3> cell = {}; ///< of the grid, along x, y and z
    bool is_grid = false;                  ///< the cell has a grid of its own
    std::uint32_t own_grid = 0;            ///< and its number
    std::uint32_t listed = 0;              ///< objects in the list
    Box3 box;                              ///< in the place's coordinates
    std::vector<WalkedObject> objects;     ///< of the list, in its order, as far as it was gone
                                           ///< through
};

/// How an index answers one ray. What a call leads to stands behind the step with the call.
struct RayWalk {
    std::vector<WalkedPlace> places; ///< the main scene first
    std::vector<WalkStep> steps;     ///< in the order of the walk
    QueryCounts counts;              ///< cells and tests among the steps
    Hit hit;                         ///< of a nearest_walk()
    Color transmitted;               ///< of a transmittance_walk()
};

/// An index that can tell how it answers a ray: by a plain walk for one ray, step for step what the
/// search does for a ray alone, and its reference. Takes much longer.
class WalkedIndex {
public:
    WalkedIndex() = default;
    WalkedIndex(const WalkedIndex&) = delete;
    WalkedIndex& operator=(const WalkedIndex&) = delete;
    virtual ~WalkedIndex() = default;

    /// As RayIndex::nearest_hits() of one ray.
    virtual RayWalk nearest_walk(const QueryRay& ray) const = 0;

    /// As RayIndex::transmittances() of one ray.
    virtual RayWalk transmittance_walk(const QueryRay& ray) const = 0;
};

} // namespace vera
