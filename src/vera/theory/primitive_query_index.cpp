// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/primitive_query_index.h"

#include "vera/accel/searches.h"
#include "vera/base/available_memory.h"
#include "vera/base/check.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/scene/bounds.h"
#include "vera/theory/grouped_sweeps.h"
#include "vera/theory/point_boxes.h"
#include "vera/theory/ray_parts.h"
#include "vera/theory/tree_queries.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace vera {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of a ray that asks for nothing more.
constexpr double ended = -infinity;

Box3 grid_bounds(const Scene& scene) {
    const Box3 box = bounds(scene);
    return box.empty() ? Box3{{}, {}} : box;
}

/// Groups of fewer rays than a leaf of the kinetic range tree have would gain nothing.
std::size_t largest_useful_level(std::size_t rays) {
    std::size_t level = 0;
    while (rays >> (level + KineticRangeTree::leaf_bits + 1) != 0)
        ++level;
    return level;
}

/// The zs at which there are any, ascending.
std::vector<std::int32_t> planes_of(std::span<const IsoRectangle> rectangles) {
    std::vector<std::int32_t> planes;
    planes.reserve(rectangles.size());
    for (const IsoRectangle& rectangle : rectangles)
        planes.push_back(rectangle.z);
    std::sort(planes.begin(), planes.end());
    return planes;
}

} // namespace

PrimitiveQueryIndex::PrimitiveQueryIndex(const Scene& scene, PrimitiveQuerySettings settings)
    : scene_(&scene)
    , settings_(std::move(settings))
    , primitives_(scene, settings_.cancel)
    , grid_(grid_bounds(scene)) {
    const std::size_t count = primitives_.size();
    require_memory(
        static_cast<double>(count)
            * (sizeof(StepBox) + sizeof(IsoRectangle) + sizeof(std::uint32_t)),
        "boxes of " + std::to_string(count) + " primitives",
        "--strategy rays takes less");
    for (std::uint32_t i = 0; i < count; ++i) {
        const double slack = primitives_.slack(i, grid_.reach(), grid_.origin_error());
        if (const auto box = grid_.larger_box(primitives_.box(i), slack)) {
            boxes_.push_back(*box);
            boxed_.push_back(i);
        } else {
            unboxed_.push_back(i);
        }
    }
}

void PrimitiveQueryIndex::nearest_hits(
    std::span<const QueryRay> rays, std::span<Hit> hits, QueryCounts& counts) const {
    VERA_CHECK(rays.size() == hits.size());
    std::vector<detail::NearestSearch> searches(rays.size());
    std::vector<Swept> swept(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        searches[i].start(coincidence_reach(rays[i].ray));
        swept[i] = from_its_beginning(rays[i].ray);
    }
    GenerationCounts generation;
    generation.rays = rays.size();
    answer(
        std::move(swept),
        [&](std::uint32_t ray, std::uint32_t primitive) {
            primitives_.for_each_crossing_of(
                primitive, rays[ray], [&](double t, FaceId face) { searches[ray].add(t, face); });
            return searches[ray].limit();
        },
        generation,
        counts);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!searches[i].undecided()) {
            hits[i] = searches[i].hit();
            continue;
        }
        // More faces coincide there than a search notes.
        detail::WindowSearch window(searches[i].window_end());
        for (std::uint32_t primitive = 0; primitive < primitives_.size(); ++primitive)
            primitives_.for_each_crossing_of(
                primitive, rays[i], [&](double t, FaceId face) { window.add(t, face); });
        counts.tests += primitives_.size();
        hits[i] = window.hit();
    }
}

PrimitiveQueryIndex::Swept PrimitiveQueryIndex::from_its_beginning(const Ray& ray) const {
    Swept swept = {ray, ray.t_max, grid_.beginning(ray)};
    if (swept.start < 0) {
        swept.ray.origin = point_at(ray, swept.start);
        swept.ray.t_min = 0;
        swept.ray.t_max = swept.end = ray.t_max - swept.start;
    }
    return swept;
}

PrimitiveQueryIndex::Swept PrimitiveQueryIndex::from_the_light(const Ray& ray) const {
    Swept reversed = {ray, ray.t_max - ray.t_min, 0};
    reversed.ray.origin = point_at(ray, ray.t_max);
    reversed.ray.direction = -ray.direction;
    reversed.ray.t_min = 0;
    reversed.ray.t_max = reversed.end;
    if (grid_.can_hold(ray) && grid_.can_hold(reversed.ray))
        return reversed;
    return from_its_beginning(ray);
}

void PrimitiveQueryIndex::transmittances(
    std::span<const QueryRay> rays, std::span<Color> transmitted, QueryCounts& counts) const {
    VERA_CHECK(rays.size() == transmitted.size());
    std::vector<detail::TransmittanceSearch> searches(rays.size());
    std::vector<Swept> swept;
    swept.reserve(rays.size());
    for (const QueryRay& ray : rays)
        swept.push_back(from_the_light(ray.ray));
    GenerationCounts generation;
    generation.are_shadow_rays = true;
    generation.rays = rays.size();
    answer(
        std::move(swept),
        [&](std::uint32_t ray, std::uint32_t primitive) {
            detail::TransmittanceSearch& search = searches[ray];
            const Color tab = detail::transmission(*scene_, primitives_[primitive].material);
            primitives_.for_each_crossing_of(
                primitive, rays[ray], [&](double t, FaceId face) { search.add(t, face, tab); });
            if (search.blocked())
                return ended;
            return infinity;
        },
        generation,
        counts);
    for (std::size_t i = 0; i < rays.size(); ++i)
        transmitted[i] = searches[i].transmitted();
}

void PrimitiveQueryIndex::answer(
    std::vector<Swept> swept,
    const Test& test,
    GenerationCounts& generation,
    QueryCounts& counts) const {
    std::atomic<std::uint64_t> tests = 0;
    const Test counted = [&](std::uint32_t ray, std::uint32_t primitive) {
        ++tests;
        const double end = std::fmin(swept[ray].end, test(ray, primitive) - swept[ray].start);
        swept[ray].end = end;
        return end;
    };
    look_at_all(swept, counted, generation);
    look_where_rays_begin(swept, counted, generation);
    constexpr std::size_t sweeps = 6;
    StageProgress stages(generation_progress(), sweeps);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool upwards : {true, false})
            sweep_along({axis, upwards}, swept, counted, generation, stages.next(1));
    generation.tests = tests;
    counts.rays += generation.rays;
    counts.tests += generation.tests;
    counts.cells += generation.sweeps.nodes + generation.trees.nodes;
    const std::lock_guard lock(mutex_);
    generations_.push_back(generation);
}

Progress PrimitiveQueryIndex::generation_progress() const {
    if (!settings_.progress)
        return {};
    const std::lock_guard lock(mutex_);
    const double left = std::exp2(-static_cast<double>(generations_.size()));
    return [this, left](double done) { settings_.progress(1 - left + 0.5 * left * done); };
}

/// What grids cannot hold is tested with everything.
void PrimitiveQueryIndex::look_at_all(
    std::vector<Swept>& swept, const Test& test, GenerationCounts& generation) const {
    for (std::uint32_t ray = 0; ray < swept.size(); ++ray) {
        const bool is_held = grid_.can_hold(swept[ray].ray);
        if (is_held) {
            for (const std::uint32_t primitive : unboxed_)
                if (test(ray, primitive) == ended)
                    break;
            continue;
        }
        stop_if_raised(settings_.cancel);
        ++generation.apart;
        for (std::uint32_t primitive = 0; primitive < primitives_.size(); ++primitive)
            if (test(ray, primitive) == ended)
                break;
        swept[ray].end = ended;
    }
}

void PrimitiveQueryIndex::look_where_rays_begin(
    std::vector<Swept>& swept, const Test& test, GenerationCounts& generation) const {
    std::vector<Vec3> origins;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t ray = 0; ray < swept.size(); ++ray)
        if (swept[ray].end != ended) {
            origins.push_back(swept[ray].ray.origin);
            numbers.push_back(ray);
        }
    const PointBoxes points(origins);
    std::vector<std::uint32_t> within;
    const LongLoop loop(boxes_.size(), {}, settings_.cancel);
    for (std::size_t box = 0; box < boxes_.size(); ++box) {
        loop.turn(box);
        within.clear();
        points.append_in(grid_.scene_box(boxes_[box]), within);
        for (const std::uint32_t i : within) {
            if (swept[numbers[i]].end == ended)
                continue;
            ++generation.begun_within;
            test(numbers[i], boxed_[box]);
        }
    }
}

void PrimitiveQueryIndex::sweep_along(
    SweepDirection direction,
    std::vector<Swept>& swept,
    const Test& test,
    GenerationCounts& generation,
    const Progress& progress) const {
    std::vector<IsoRectangle> rectangles;
    rectangles.reserve(boxes_.size());
    for (const StepBox& box : boxes_)
        rectangles.push_back(grid_.entry(box, direction));
    const std::vector<std::int32_t> planes = planes_of(rectangles);
    std::vector<SlopedRay> rays;
    std::vector<std::int32_t> last_z;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t ray = 0; ray < swept.size(); ++ray) {
        if (swept[ray].end == ended)
            continue;
        const auto sloped = grid_.sloped_ray(swept[ray].ray, direction);
        if (!sloped)
            continue;
        const std::int32_t last = grid_.last_step(swept[ray].ray, swept[ray].end, direction);
        // What another sweep has ended comes to no plane here.
        const auto first = std::lower_bound(planes.begin(), planes.end(), sloped->first_z);
        if (first == planes.end() || *first > last)
            continue;
        rays.push_back(*sloped);
        last_z.push_back(last);
        numbers.push_back(ray);
    }
    generation.swept += rays.size();
    const Meeting meeting = [&](std::uint32_t rectangle, std::uint32_t i) {
        const std::uint32_t ray = numbers[i];
        const double end = test(ray, boxed_[rectangle]);
        return end == ended ? std::numeric_limits<std::int32_t>::min()
                            : grid_.last_step(swept[ray].ray, end, direction);
    };
    generation += ask(rectangles, {rays, last_z}, meeting, progress);
}

NestedSweepCounts PrimitiveQueryIndex::ask(
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const Meeting& meeting,
    const Progress& progress) const {
    const std::size_t count = swept.rays.size();
    const CancelFlag* const cancel = settings_.cancel;
    NestedSweepCounts counts;
    const auto sweep_in_groups = [&](std::size_t level) {
        if (level == 0)
            sweep(rectangles, swept, meeting, &counts.sweeps, progress, cancel);
        else
            sweep_groups(level, rectangles, swept, meeting, &counts.sweeps, progress, cancel);
    };
    const std::size_t stated = settings_.level.value_or(stated_level(rectangles.size(), count));
    switch (settings_.queries) {
    case RayQueries::automatic: {
        const std::size_t sampled =
            std::min(sampled_level(rectangles, swept.rays), largest_useful_level(count));
        sweep_in_groups(settings_.level.value_or(sampled));
        break;
    }
    case RayQueries::sweep:
        sweep_in_groups(0);
        break;
    case RayQueries::groups:
        sweep_in_groups(stated);
        break;
    case RayQueries::nested:
        nested_sweeps(
            std::min(stated, largest_useful_level(count)),
            usual_parts_level(count),
            rectangles,
            swept,
            meeting,
            &counts,
            progress,
            cancel);
        break;
    case RayQueries::trees:
        query_trees(rectangles, swept, meeting, &counts.trees, progress, cancel);
        break;
    }
    return counts;
}

std::size_t PrimitiveQueryIndex::memory() const {
    return primitives_.bytes() + boxes_.capacity() * sizeof(StepBox)
        + (boxed_.capacity() + unboxed_.capacity()) * sizeof(std::uint32_t);
}

std::vector<GenerationCounts> PrimitiveQueryIndex::generations() const {
    const std::lock_guard lock(mutex_);
    return generations_;
}

} // namespace vera
