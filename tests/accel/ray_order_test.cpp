// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/ray_order.h"
#include "vera/base/random.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <span>
#include <vector>

#include "expected_answers.h"
#include "mesh_brute_force.h"
#include "sample_mesh.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using detail::least_ordered;
using detail::most_ordered;
using detail::order_rays;
using detail::start_apart;

/// Rays whose coordinates are a few numbers, some of which are none.
std::vector<IndexRay> rays_of_few_numbers(std::uint64_t seed, std::size_t count, bool broken) {
    const std::vector<float> numbers = {
        -1,
        -0.0F,
        0,
        0.25F,
        1,
        std::numeric_limits<float>::quiet_NaN(),
        std::numeric_limits<float>::infinity()};
    const std::size_t kinds = broken ? numbers.size() : 5;
    std::vector<IndexRay> rays(count);
    std::uint64_t drawn = 0;
    for (IndexRay& ray : rays)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ray.origin[axis] = numbers[random(seed, drawn++, 0) % kinds];
            ray.direction[axis] = numbers[random(seed, drawn++, 0) % kinds];
        }
    return rays;
}

std::vector<std::uint32_t> all_numbers(std::size_t count) {
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

TEST(RayOrder, HasEachRayOnceWhateverItsNumbersAre) {
    for (const std::size_t count :
         {std::size_t{0}, std::size_t{1}, std::size_t{500}, most_ordered}) {
        std::vector<std::uint32_t> numbers;
        order_rays(rays_of_few_numbers(count, count, true), numbers);
        std::sort(numbers.begin(), numbers.end());
        EXPECT_EQ(numbers, all_numbers(count));
    }
}

TEST(RayOrder, KeepsThoseOfOneOctantAndOneOriginTogetherAndInTheirOrder) {
    const auto rays = rays_of_few_numbers(3, 2000, false);
    std::vector<std::uint32_t> numbers;
    order_rays(rays, numbers);
    // What rays have in common, with 0 and -0 as one.
    const auto kind_of = [&](std::uint32_t number) {
        const IndexRay& ray = rays[number];
        std::vector<float> kind;
        for (std::size_t axis = 0; axis < 3; ++axis)
            kind.push_back(ray.direction[axis] < 0 ? 1.0F : 0.0F);
        for (const float x : ray.origin)
            kind.push_back(x + 0.0F);
        return kind;
    };
    std::set<std::vector<float>> seen;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const bool goes_on = i > 0 && kind_of(numbers[i]) == kind_of(numbers[i - 1]);
        if (goes_on)
            EXPECT_LT(numbers[i - 1], numbers[i]);
        else
            EXPECT_TRUE(seen.insert(kind_of(numbers[i])).second) << "place " << i;
    }
}

TEST(RayOrder, IsMissingWhereMostRaysStartFarFromTheOneBefore) {
    std::vector<IndexRay> rays(3000);
    EXPECT_FALSE(start_apart(rays)) << "all at one place";
    for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i].origin[1] = static_cast<float>(i);
    EXPECT_FALSE(start_apart(rays)) << "along a line";
    for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i].origin[1] = static_cast<float>(random(1, i, 0) % 1000);
    EXPECT_TRUE(start_apart(rays));
    EXPECT_FALSE(start_apart({}));
    EXPECT_FALSE(start_apart(std::span(rays).first(1)));
}

TEST(RayOrder, ChangesNoAnswer) {
    const testing::SampleMesh mesh = testing::random_mesh(4, 40);
    const std::size_t count = most_ordered + least_ordered + 5;
    auto rays = rays_of_few_numbers(9, count, false);
    for (std::size_t i = 0; i < count; i += 97)
        rays[i].direction[i % 3] = std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(start_apart(rays));
    const MeshIndex index(mesh.spans());
    std::vector<MeshHit> hits(count);
    std::vector<std::uint8_t> met(count, 7);
    index.nearest_hits(rays, hits);
    index.meet_any(rays, met);
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto expected = testing::brute_force_answer(mesh.spans(), rays[i]);
        ASSERT_TRUE(testing::same_bits(hits[i], expected.nearest)) << testing::told(rays[i]);
        ASSERT_EQ(met[i], expected.met ? 1 : 0) << testing::told(rays[i]);
        found += expected.met ? 1U : 0U;
    }
    EXPECT_GT(found, count / 10);
    EXPECT_LT(found, count);
}

} // namespace
} // namespace vera
