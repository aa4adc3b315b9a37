// SPDX-License-Identifier: Apache-2.0
// Which triangles of a mesh are one plane face: a viewer sees six sides of a cube, and not the
// twelve triangles that its file has.
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/primitives.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Of each triangle of the mesh the first one, in its order, of the patch that it is in; or empty
/// where each is one by itself. A patch is what hangs together by neighbours in one plane:
/// triangles that have a side in common, which the one goes along and the other back, lie on either
/// side of it in exactly one plane and have, where the mesh has normals, one normal at all of their
/// corners. What has no area is a patch by itself, and sides that more than 64 triangles go along
/// need not count. Triangles that are parted by one of the ends, numbers of triangles in ascending
/// order, are no neighbours. Exact for all finite coordinates. Takes about as many steps as the
/// mesh has corners, and 25 bytes of memory for each triangle until it is done. Throws Cancelled.
std::vector<std::uint32_t> coplanar_patches(
    const Mesh& mesh, std::span<const std::uint32_t> ends = {}, const CancelFlag* cancel = nullptr);

} // namespace vera
