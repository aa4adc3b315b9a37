// SPDX-License-Identifier: Apache-2.0
#include "our_index.h"

#include "vera/accel/brute_force.h"
#include "vera/accel/grid_tree.h"
#include "vera/accel/wide_bvh.h"
#include "vera/base/check.h"

#include <limits>
#include <span>
#include <utility>

#include "turns.h"

namespace vera {

namespace {

using Maker = std::unique_ptr<RayIndex> (*)(const Scene& scene);

/// Every index that there is, the usual one first: a further one is a line here.
const std::vector<std::pair<std::string, Maker>>& makers() {
    static const std::vector<std::pair<std::string, Maker>> all = {
        {"grid",
         [](const Scene& scene) -> std::unique_ptr<RayIndex> { return make_grid_tree(scene); }},
        {"bvh",
         [](const Scene& scene) -> std::unique_ptr<RayIndex> { return make_wide_bvh(scene); }},
        {"brute", make_brute_force}};
    return all;
}

} // namespace

const std::vector<std::string>& index_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const auto& [name, make] : makers())
            all.push_back(name);
        return all;
    }();
    return names;
}

std::unique_ptr<RayIndex> make_index(const std::string& name, const Scene& scene) {
    for (const auto& [each, make] : makers())
        if (each == name)
            return make(scene);
    VERA_CHECK(false);
    return nullptr;
}

OurQuery::OurQuery(const RayIndex& index, const RaySet& rays, std::size_t threads)
    : index_(index)
    , rays_(rays)
    , threads_(threads)
    , hits_(rays.question == Question::nearest ? rays.queries.size() : 0)
    , transmitted_(rays.question == Question::any ? rays.queries.size() : 0) {}

double OurQuery::run(std::size_t generation) {
    const std::span<const QueryRay> queries = rays_.queries;
    const Stopwatch watch(threads_);
    for_each_generation(
        queries.size(), generation, threads_, [&](std::size_t first, std::size_t count) {
            QueryCounts counts;
            if (rays_.question == Question::nearest)
                index_.nearest_hits(
                    queries.subspan(first, count), std::span(hits_).subspan(first, count), counts);
            else
                index_.transmittances(
                    queries.subspan(first, count),
                    std::span(transmitted_).subspan(first, count),
                    counts);
        });
    return watch.seconds();
}

Distances OurQuery::distances() const {
    Distances result;
    result.reserve(rays_.queries.size());
    for (const Hit& hit : hits_)
        result.push_back(static_cast<float>(hit.t));
    for (const Color& color : transmitted_)
        result.push_back(is_black(color) ? 0 : std::numeric_limits<float>::infinity());
    return result;
}

} // namespace vera
