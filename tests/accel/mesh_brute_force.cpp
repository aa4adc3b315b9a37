// SPDX-License-Identifier: Apache-2.0
#include "mesh_brute_force.h"

#include "vera/accel/mesh_crossing.h"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>

namespace vera::testing {

MeshAnswer brute_force_answer(MeshSpans mesh, const MeshRay& ray) {
    if (!detail::is_followed(ray))
        return {};
    const PreparedRay prepared = detail::prepared_mesh_ray(ray);
    detail::NearestCrossing nearest;
    std::vector<std::pair<detail::MeshCrossing, std::uint32_t>> crossings;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Vec3 a = detail::in_double(mesh.vertices[mesh.triangles[i][0]]);
        const Vec3 b = detail::in_double(mesh.vertices[mesh.triangles[i][1]]);
        const Vec3 c = detail::in_double(mesh.vertices[mesh.triangles[i][2]]);
        if (!is_finite(a) || !is_finite(b) || !is_finite(c))
            continue;
        if (const auto crossing = detail::mesh_crossing(prepared, a, b, c)) {
            nearest.add(*crossing, i);
            crossings.emplace_back(*crossing, i);
        }
    }
    std::sort(crossings.begin(), crossings.end(), [](const auto& one, const auto& other) {
        return std::tie(one.first.t, one.second) < std::tie(other.first.t, other.second);
    });
    MeshAnswer answer = {nearest.hit(), !crossings.empty(), {}};
    for (const auto& [crossing, triangle] : crossings)
        answer.all.push_back(detail::mesh_hit(crossing, triangle));
    return answer;
}

std::vector<MeshAnswer> brute_force_answers(MeshSpans mesh, const std::vector<MeshRay>& rays) {
    std::vector<MeshAnswer> answers;
    for (const MeshRay& ray : rays)
        answers.push_back(brute_force_answer(mesh, ray));
    return answers;
}

} // namespace vera::testing
