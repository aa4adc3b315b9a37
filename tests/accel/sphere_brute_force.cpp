// SPDX-License-Identifier: Apache-2.0
#include "sphere_brute_force.h"

#include "vera/accel/sphere_crossing.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vera::testing {

SphereAnswer brute_force_answer(SphereSpan spheres, const IndexRay& ray) {
    SphereAnswer answer;
    if (!detail::is_followed(ray))
        return answer;
    detail::SphereDecider decider(spheres, ray);
    std::vector<std::pair<double, SphereHit>> hits;
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        if (!detail::is_sphere(spheres[i]))
            continue;
        decider.consider(i);
        decider.for_each_hit(i, [&](const SphereHit& hit, double t) { hits.emplace_back(t, hit); });
        answer.met = answer.met || decider.meets(i);
    }
    std::sort(hits.begin(), hits.end(), [](const auto& one, const auto& other) {
        return one.first < other.first
            || (one.first == other.first && one.second.sphere < other.second.sphere);
    });
    answer.nearest = decider.hit();
    for (const auto& [t, hit] : hits)
        answer.all.push_back(hit);
    return answer;
}

std::vector<SphereAnswer>
brute_force_answers(SphereSpan spheres, const std::vector<IndexRay>& rays) {
    std::vector<SphereAnswer> answers;
    for (const IndexRay& ray : rays)
        answers.push_back(brute_force_answer(spheres, ray));
    return answers;
}

} // namespace vera::testing
