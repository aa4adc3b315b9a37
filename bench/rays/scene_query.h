// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <memory>

#include "our_index.h"

namespace vera {

// The indexes of whole scenes, as the renderer asks them.

std::unique_ptr<OurIndex> grid_of(const Scene& scene);
std::unique_ptr<OurIndex> bvh_of(const Scene& scene);
std::unique_ptr<OurIndex> brute_force_of(const Scene& scene);

} // namespace vera
