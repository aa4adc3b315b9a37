// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"

#include "vera/accel/every_crossing.h"
#include "vera/base/check.h"

namespace vera {

namespace {

class BruteForce : public RayIndex {
public:
    explicit BruteForce(const Scene& scene)
        : scene_(&scene) {}

    void nearest_hits(
        std::span<const QueryRay> rays, std::span<Hit> hits, QueryCounts& counts) const override {
        VERA_CHECK(rays.size() == hits.size());
        for (std::size_t i = 0; i < rays.size(); ++i)
            hits[i] = nearest(rays[i], counts);
        counts.rays += rays.size();
    }

    void transmittances(
        std::span<const QueryRay> rays,
        std::span<Color> transmitted,
        QueryCounts& counts) const override {
        VERA_CHECK(rays.size() == transmitted.size());
        for (std::size_t i = 0; i < rays.size(); ++i)
            transmitted[i] = transmittance(rays[i], counts);
        counts.rays += rays.size();
    }

    std::size_t memory() const override { return sizeof(*this); }

private:
    template <typename Search>
    void search_all(const QueryRay& query, QueryCounts& counts, Search& search) const {
        detail::for_each_crossing_within(
            *scene_,
            {&scene_->geometry, query.ray, 0, inherited_material},
            query.start,
            counts.tests,
            [&](double t, FaceId face, MaterialId) { search.add(t, face); },
            [] { return false; });
    }

    Hit nearest(const QueryRay& query, QueryCounts& counts) const {
        detail::NearestSearch search;
        search.start(coincidence_reach(query.ray));
        search_all(query, counts, search);
        if (!search.undecided())
            return search.hit();
        detail::WindowSearch window(search.window_end());
        search_all(query, counts, window);
        return window.hit();
    }

    Color transmittance(const QueryRay& query, QueryCounts& counts) const {
        detail::TransmittanceSearch search;
        detail::for_each_crossing_within(
            *scene_,
            {&scene_->geometry, query.ray, 0, inherited_material},
            query.start,
            counts.tests,
            [&](double t, FaceId face, MaterialId material) {
                search.add(t, face, detail::transmission(*scene_, material));
            },
            [&] { return search.blocked(); });
        return search.transmitted();
    }

    const Scene* scene_;
};

} // namespace

std::unique_ptr<RayIndex> make_brute_force(const Scene& scene) {
    return std::make_unique<BruteForce>(scene);
}

} // namespace vera
