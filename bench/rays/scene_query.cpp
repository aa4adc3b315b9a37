// SPDX-License-Identifier: Apache-2.0
#include "scene_query.h"

#include "vera/accel/brute_force.h"
#include "vera/accel/grid_tree.h"
#include "vera/accel/wide_bvh.h"

#include <limits>
#include <span>
#include <utility>

#include "turns.h"

namespace vera {

namespace {

class SceneQuery : public OurQuery {
public:
    SceneQuery(
        const RayIndex& index, const RaySet& rays, std::size_t threads, std::size_t generation)
        : index_(index)
        , rays_(rays)
        , threads_(threads)
        , generation_(generation)
        , hits_(rays.question == Question::nearest ? rays.queries.size() : 0)
        , transmitted_(rays.question == Question::any ? rays.queries.size() : 0) {}

    double run(OurCall call) override {
        const std::size_t generation = call == OurCall::all ? whole_generation : generation_;
        const Stopwatch watch(threads_);
        for_each_generation(
            rays_.queries.size(), generation, threads_, [&](std::size_t first, std::size_t count) {
                QueryCounts counts;
                ask(first, count, counts);
            });
        return watch.seconds();
    }

    Distances distances() const override {
        Distances result;
        result.reserve(rays_.queries.size());
        for (const Hit& hit : hits_)
            result.push_back(static_cast<float>(hit.t));
        for (const Color& color : transmitted_)
            result.push_back(is_black(color) ? 0 : std::numeric_limits<float>::infinity());
        return result;
    }

    Steps steps() override {
        QueryCounts counts;
        for_each_generation(
            rays_.queries.size(), generation_, 1, [&](std::size_t first, std::size_t count) {
                ask(first, count, counts);
            });
        return {counts.cells, counts.tests};
    }

private:
    void ask(std::size_t first, std::size_t count, QueryCounts& counts) {
        const auto some = std::span(rays_.queries).subspan(first, count);
        if (rays_.question == Question::nearest)
            index_.nearest_hits(some, std::span(hits_).subspan(first, count), counts);
        else
            index_.transmittances(some, std::span(transmitted_).subspan(first, count), counts);
    }

    const RayIndex& index_;
    const RaySet& rays_;
    std::size_t threads_;
    std::size_t generation_;
    std::vector<Hit> hits_;
    std::vector<Color> transmitted_;
};

class SceneIndex : public OurIndex {
public:
    SceneIndex(std::unique_ptr<RayIndex> index, std::size_t nodes)
        : index_(std::move(index))
        , nodes_(nodes) {}

    std::size_t bytes() const override { return index_->memory(); }

    std::size_t nodes() const override { return nodes_; }

    std::vector<OurCall> calls() const override { return {OurCall::generation, OurCall::all}; }

    std::unique_ptr<OurQuery>
    query(const RaySet& rays, std::size_t threads, std::size_t generation) const override {
        return std::make_unique<SceneQuery>(*index_, rays, threads, generation);
    }

private:
    std::unique_ptr<RayIndex> index_;
    std::size_t nodes_;
};

} // namespace

std::unique_ptr<OurIndex> grid_of(const Scene& scene) {
    auto grid = make_grid_tree(scene);
    const std::size_t cells = grid->statistics().cells;
    return std::make_unique<SceneIndex>(std::move(grid), cells);
}

std::unique_ptr<OurIndex> bvh_of(const Scene& scene) {
    auto tree = make_wide_bvh(scene);
    const std::size_t nodes = tree->statistics().nodes;
    return std::make_unique<SceneIndex>(std::move(tree), nodes);
}

std::unique_ptr<OurIndex> brute_force_of(const Scene& scene) {
    return std::make_unique<SceneIndex>(make_brute_force(scene), 0);
}

} // namespace vera
