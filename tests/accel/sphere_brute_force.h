// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/sphere_index.h"

#include <vector>

namespace vera::testing {

/// All that a SphereIndex can be asked about a ray.
struct SphereAnswer {
    SphereHit nearest;
    bool met = false;
    std::vector<SphereHit> all;
};

/// The answer of one who asks every sphere, in no clever way: what a SphereIndex is held to.
SphereAnswer brute_force_answer(SphereSpan spheres, const IndexRay& ray);

std::vector<SphereAnswer>
brute_force_answers(SphereSpan spheres, const std::vector<IndexRay>& rays);

} // namespace vera::testing
