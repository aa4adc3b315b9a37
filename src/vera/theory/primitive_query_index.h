// SPDX-License-Identifier: Apache-2.0
// Generation-wise ray tracing with primitive queries (VERA 3.3.2) of any scene: for each primitive,
// the rays of a generation that it may meet are found, and not the other way round.
//
// The primitives' boxes become rectangles, and the rays whole rays (query_grid.h). Six sweeps, up
// and down each axis, by a kinetic range tree or by trees of rays, tell which rays enter which
// boxes. Those primitives are tested, and a ray ends where nothing behind can be in front of what
// it has met. Boxes in which a ray begins are told apart. Shadow rays are swept from the light to
// the place, and so all of a light come from one point.
//
// What is tested is what other indexes test, and so the hits are the same to the bit.
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"
#include "vera/theory/nested_sweeps.h"
#include "vera/theory/placed_primitives.h"
#include "vera/theory/query_grid.h"
#include "vera/theory/space_sweep.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// How primitives find their rays.
enum class RayQueries {
    automatic, ///< in as many groups as crossings that are sampled tell: one where rays do not
               ///< cross
    sweep,     ///< in one space sweep
    groups,    ///< in the sweeps of as many groups as proposition 5 says
    nested,    ///< in the sweeps at the ends of nested trees, as proposition 5 is stated
    trees      ///< in the nested trees of proposition 3
};

struct PrimitiveQuerySettings {
    RayQueries queries = RayQueries::automatic;
    std::optional<std::size_t> level = {}; ///< of groups and of nested sweeps: 2^level groups; of
                                           ///< automatic: in these
    Progress progress = {};
    const CancelFlag* cancel = nullptr;
};

/// What a generation of rays has taken.
struct GenerationCounts {
    bool are_shadow_rays = false;
    std::uint64_t rays = 0;
    std::uint64_t tests = 0;        ///< of a ray with a primitive
    std::uint64_t begun_within = 0; ///< boxes in which a ray begins, counted for each ray, up to
                                    ///< the one with what ends it
    std::uint64_t apart = 0;        ///< rays that grids cannot hold: tested with every primitive
    std::uint64_t swept = 0;        ///< rays that come to planes with boxes' faces, each counted
                                    ///< for each of its axes
    SweepCounts sweeps;
    StepCounts trees; ///< of queries; not what it takes to make them

    /// Rays that boxes' faces tell: with begun_within all tests, where grids hold all rays and
    /// primitives.
    std::uint64_t reports() const { return sweeps.reports + trees.reports; }

    std::uint64_t steps() const { return sweeps.steps() + trees.steps(); }

    GenerationCounts& operator+=(const NestedSweepCounts& more) {
        sweeps += more.sweeps;
        trees += more.trees;
        return *this;
    }
};

class PrimitiveQueryIndex : public RayIndex {
public:
    /// The scene must outlive it. Throws std::runtime_error where the memory that is available does
    /// not suffice, and Cancelled; so do queries.
    explicit PrimitiveQueryIndex(const Scene& scene, PrimitiveQuerySettings settings = {});

    /// All rays of one call are answered together.
    void nearest_hits(
        std::span<const QueryRay> rays, std::span<Hit> hits, QueryCounts& counts) const override;

    void transmittances(
        std::span<const QueryRay> rays,
        std::span<Color> transmitted,
        QueryCounts& counts) const override;

    std::size_t memory() const override;

    /// Of the calls so far, in the order in which they ended.
    std::vector<GenerationCounts> generations() const;

    /// Tells from now on how far generations are that are asked for one after the other: each takes
    /// half of what is left, since nobody knows how many there will be.
    void set_progress(Progress progress) { settings_.progress = std::move(progress); }

private:
    /// A ray as it is swept, from t = 0 on, and up to which t.
    struct Swept {
        Ray ray;
        double end = 0;
        double start = 0; ///< that 0, as a t of the ray that was asked
    };

    /// Tests the ray with the primitive. Returns the t, as the ray was asked, up to which it asks
    /// for more; -infinity: for nothing.
    using Test = std::function<double(std::uint32_t ray, std::uint32_t primitive)>;

    void
    answer(std::vector<Swept> swept, const Test& test, GenerationCounts& counts, QueryCounts& sum)
        const;
    void look_at_all(std::vector<Swept>& swept, const Test& test, GenerationCounts& counts) const;
    void look_where_rays_begin(
        std::vector<Swept>& swept, const Test& test, GenerationCounts& counts) const;
    void sweep_along(
        SweepDirection direction,
        std::vector<Swept>& swept,
        const Test& test,
        GenerationCounts& counts,
        const Progress& progress) const;
    Progress generation_progress() const;
    /// Calls the meeting as sweep() does.
    NestedSweepCounts
    ask(std::span<const IsoRectangle> rectangles,
        const SweptRays& swept,
        const Meeting& meeting,
        const Progress& progress) const;
    Swept from_its_beginning(const Ray& ray) const;
    Swept from_the_light(const Ray& ray) const;

    const Scene* scene_;
    PrimitiveQuerySettings settings_;
    PlacedPrimitives primitives_;
    QueryGrid grid_;
    std::vector<StepBox> boxes_;
    std::vector<std::uint32_t> boxed_;   ///< the primitives of the boxes
    std::vector<std::uint32_t> unboxed_; ///< primitives that grids cannot hold
    mutable std::mutex mutex_;
    mutable std::vector<GenerationCounts> generations_;
};

} // namespace vera
