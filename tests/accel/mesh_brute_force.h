// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/mesh_index.h"

#include <vector>

namespace vera::testing {

/// All that a MeshIndex can be asked about a ray.
struct MeshAnswer {
    MeshHit nearest;
    bool met = false;
    std::vector<MeshHit> all;
};

/// The answer of one who asks every triangle, in no clever way: what a MeshIndex is held to.
MeshAnswer brute_force_answer(MeshSpans mesh, const MeshRay& ray);

std::vector<MeshAnswer> brute_force_answers(MeshSpans mesh, const std::vector<MeshRay>& rays);

} // namespace vera::testing
