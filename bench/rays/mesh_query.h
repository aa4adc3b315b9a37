// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/mesh_index.h"

#include <memory>

#include "our_index.h"

namespace vera {

/// The library's index of one mesh, asked about the rays that Embree is asked about: in single
/// precision, and starting a little beside the faces. Null where the scene is not one mesh.
std::unique_ptr<OurIndex> mesh_of(const IndexInput& input, MeshIndexQuality quality);

} // namespace vera
