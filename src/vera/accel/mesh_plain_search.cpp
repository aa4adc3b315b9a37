// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/float_plain_search.h"
#include "vera/accel/mesh_tree.h"

#include <vector>

namespace vera::detail {

MeshHit nearest_plainly(const MeshTree& tree, const MeshRay& ray) {
    return nearest_hit_plainly(tree, ray);
}

bool meets_any_plainly(const MeshTree& tree, const MeshRay& ray) {
    return meets_plainly(tree, ray);
}

std::vector<MeshHit> all_hits_of(const MeshTree& tree, const MeshRay& ray) {
    return all_hits_plainly(tree, ray, [](const MeshHit& hit) { return hit.triangle; });
}

} // namespace vera::detail
