// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/index_ray.h"

#include <memory>

#include "our_index.h"

namespace vera {

// The library's indexes of single precision, asked about the rays that Embree is asked about, which
// start a little beside the faces.

/// A MeshIndex; null where the scene is not one mesh.
std::unique_ptr<OurIndex> mesh_of(const IndexInput& input, IndexQuality quality);

/// A SphereIndex; null where the scene is not of spheres alone.
std::unique_ptr<OurIndex> spheres_of(const IndexInput& input, IndexQuality quality);

} // namespace vera
