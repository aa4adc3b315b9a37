// SPDX-License-Identifier: Apache-2.0
// What generations of rays take of memory while several parts are answered at once, compared with
// what is forecast. A program of its own, since it counts every byte that is allocated.
#include "vera/theory/conjugation_tree.h"
#include "vera/theory/grouped_sweeps.h"
#include "vera/theory/nested_sweeps.h"
#include "vera/theory/ray_parts.h"
#include "vera/theory/tree_queries.h"

#include <functional>
#include <random>
#include <vector>

#include "base/counted_memory.h"
#include "theory/rectangles.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::Rectangles;
using testing::SlopedRays;

constexpr std::size_t ray_count = 16'384;
constexpr std::size_t rectangle_count = 256;
constexpr std::size_t level = 6;

struct Way {
    const char* name;
    std::function<void(const Rectangles&, const SlopedRays&, const Meeting&)> ask;
    double forecast;
};

std::vector<Way> ways() {
    const std::size_t parts = usual_parts_level(ray_count);
    return {
        {"trees",
         [](const auto& rectangles, const auto& rays, const Meeting& meeting) {
             query_trees(rectangles, {rays}, meeting);
         },
         query_trees_bytes_forecast(rectangle_count, ray_count)},
        {"nested",
         [parts](const auto& rectangles, const auto& rays, const Meeting& meeting) {
             nested_sweeps(level, parts, rectangles, {rays}, meeting);
         },
         nested_sweeps_bytes_forecast(level, parts, rectangle_count, ray_count)},
        {"groups",
         [](const auto& rectangles, const auto& rays, const Meeting& meeting) {
             sweep_groups(level, rectangles, {rays}, meeting);
         },
         sweep_groups_bytes_forecast(level, rectangle_count, ray_count)}};
}

/// With points on parabolas: all are corners of the hulls of their nodes, and so trees take the
/// most.
SlopedRays rays_of_convex_points() {
    SlopedRays made;
    for (std::size_t i = 0; i < ray_count; ++i) {
        const auto along = static_cast<std::int32_t>(i) - static_cast<std::int32_t>(ray_count / 2);
        made.push_back({along, along * along, -along, along * along, -500});
    }
    return made;
}

TEST(QueryMemory, OfSeveralPartsAtOnceIsNoMoreThanWasForecast) {
    ASSERT_EQ(usual_parts_level(ray_count), 3U);
    std::mt19937_64 random(8);
    Rectangles rectangles = testing::rectangles_within(rectangle_count - 1, 500, 100, random);
    // It comes last, and is asked of all parts.
    constexpr std::int32_t far = 100'000'000;
    rectangles.push_back({501, -far, far, -far, far});
    // Parts are divided before they are answered, and what that takes is given back by then.
    constexpr double of_dividing = ray_count * ConjugationTree::building_bytes_per_point;
    for (const SlopedRays& rays :
         {rays_of_convex_points(), testing::sloped_rays_within(ray_count, 500, 3, random)})
        for (const Way& way : ways()) {
            FirstRectangles first(ray_count);
            const Meeting meeting = first_meeting(first);
            const testing::MemoryWatch watch;
            way.ask(rectangles, rays, meeting);
            EXPECT_LT(static_cast<double>(watch.most_bytes()), way.forecast - of_dividing)
                << way.name << ", first slope " << rays[0].slope_x;
        }
}

} // namespace
} // namespace vera
