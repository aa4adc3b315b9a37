// SPDX-License-Identifier: Apache-2.0
#include "float_query.h"

#include "vera/accel/mesh_index.h"
#include "vera/accel/sphere_index.h"

#include <algorithm>
#include <limits>
#include <span>

#include "turns.h"

namespace vera {

namespace {

/// What differs between the two indexes.
struct OfMesh {
    using Index = MeshIndex;
    using Hit = MeshHit;
    using Counts = MeshQueryCounts;

    static Index index_of(const FloatGeometry& floats, IndexQuality quality) {
        return Index(
            {std::span(floats.corners).first(floats.corners.size() - 1), floats.triangles},
            quality);
    }

    static std::uint64_t tests(const Counts& counts) { return counts.triangles; }
};

struct OfSpheres {
    using Index = SphereIndex;
    using Hit = SphereHit;
    using Counts = SphereQueryCounts;

    static Index index_of(const FloatGeometry& floats, IndexQuality quality) {
        return Index(floats.spheres, quality);
    }

    static std::uint64_t tests(const Counts& counts) { return counts.spheres; }
};

template <typename Kind>
class FloatQuery : public OurQuery {
public:
    FloatQuery(
        const typename Kind::Index& index,
        const RaySet& rays,
        std::size_t threads,
        std::size_t generation)
        : index_(index)
        , nearest_(rays.question == Question::nearest)
        , threads_(threads)
        , generation_(generation)
        , hits_(nearest_ ? rays.floats.size() : 0)
        , met_(nearest_ ? 0 : rays.floats.size()) {
        rays_.reserve(rays.floats.size());
        for (const FloatRay& ray : rays.floats)
            rays_.push_back({ray.origin, 0, ray.direction, ray.t_max});
    }

    double run(OurCall call) override {
        // A call for each ray is made in turns of as many rays as Embree's are.
        const std::size_t turn = call == OurCall::all ? whole_generation : generation_;
        const Stopwatch watch(threads_);
        for_each_generation(
            rays_.size(), turn, threads_, [&](std::size_t first, std::size_t count) {
                if (call == OurCall::one)
                    ask_one_by_one(first, count);
                else
                    ask(first, count, nullptr);
            });
        return watch.seconds();
    }

    Distances distances() const override {
        Distances result;
        result.reserve(rays_.size());
        for (const auto& hit : hits_)
            result.push_back(hit.t);
        for (const std::uint8_t met : met_)
            result.push_back(met != 0 ? 0 : std::numeric_limits<float>::infinity());
        return result;
    }

    Steps steps() override {
        typename Kind::Counts counts;
        for_each_generation(
            rays_.size(), generation_, 1, [&](std::size_t first, std::size_t count) {
                ask(first, count, &counts);
            });
        return {counts.nodes, Kind::tests(counts)};
    }

private:
    void ask(std::size_t first, std::size_t count, typename Kind::Counts* counts) {
        const auto some = std::span(rays_).subspan(first, count);
        if (nearest_)
            index_.nearest_hits(some, std::span(hits_).subspan(first, count), counts);
        else
            index_.meet_any(some, std::span(met_).subspan(first, count), counts);
    }

    void ask_one_by_one(std::size_t first, std::size_t count) {
        for (std::size_t i = first; i < first + count; ++i)
            if (nearest_)
                hits_[i] = index_.nearest_hit(rays_[i]);
            else
                met_[i] = index_.meets_any(rays_[i]) ? 1 : 0;
    }

    const typename Kind::Index& index_;
    bool nearest_;
    std::size_t threads_;
    std::size_t generation_;
    std::vector<IndexRay> rays_;
    std::vector<typename Kind::Hit> hits_;
    std::vector<std::uint8_t> met_;
};

template <typename Kind>
class BuiltFloatIndex : public OurIndex {
public:
    BuiltFloatIndex(const FloatGeometry& floats, IndexQuality quality)
        : index_(Kind::index_of(floats, quality)) {}

    std::size_t bytes() const override { return index_.statistics().bytes; }

    std::size_t nodes() const override { return index_.statistics().nodes; }

    std::vector<OurCall> calls() const override {
        return {OurCall::generation, OurCall::all, OurCall::one};
    }

    std::unique_ptr<OurQuery>
    query(const RaySet& rays, std::size_t threads, std::size_t generation) const override {
        return std::make_unique<FloatQuery<Kind>>(index_, rays, threads, generation);
    }

private:
    typename Kind::Index index_;
};

} // namespace

std::unique_ptr<OurIndex> mesh_of(const IndexInput& input, IndexQuality quality) {
    if (!input.one_mesh)
        return nullptr;
    return std::make_unique<BuiltFloatIndex<OfMesh>>(input.floats, quality);
}

std::unique_ptr<OurIndex> spheres_of(const IndexInput& input, IndexQuality quality) {
    if (!input.only_spheres)
        return nullptr;
    return std::make_unique<BuiltFloatIndex<OfSpheres>>(input.floats, quality);
}

} // namespace vera
