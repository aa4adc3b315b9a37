// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/ray.h"
#include "vera/scene/hit.h"
#include "vera/scene/scene.h"
#include "vera/shade/place_blocks.h"

#include <array>
#include <span>

namespace vera {

/// A ray, and its first hit of the scene. Set by whoever makes it: blocks of them are made for all
/// rays, and to clear them first would take longer than to fill them.
struct MetFace {
    const Ray* ray;
    const Hit* hit;
};

/// surface_at() of up to block_size hits, to the bit, each put into the lane of its number; returns
/// the materials. Spheres, plane faces, patches and mantles (of straight pieces of a contour) are
/// placed together with the others of their kind, what lies in subscenes and curved pieces one by
/// one.
std::array<MaterialId, block_size>
put_surfaces(const Scene& scene, std::span<const MetFace> met, PlaceBlock& block);

} // namespace vera
