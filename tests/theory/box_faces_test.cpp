// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/box_faces.h"

#include <algorithm>
#include <random>
#include <stdexcept>
#include <vector>

#include "theory/rectangles.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using Random = std::mt19937_64;
using testing::any_within;

/// Within the reach, with sides of at most the size; some of them flat.
std::vector<WholeBox>
boxes_within(std::size_t count, std::int32_t reach, std::int32_t size, Random& random) {
    std::vector<WholeBox> made(count);
    for (WholeBox& box : made)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lower[axis] = any_within(reach, random);
            const auto side =
                static_cast<std::int32_t>(random() % (static_cast<std::uint64_t>(size) + 1));
            box.upper[axis] = std::min(box.lower[axis] + side, reach);
        }
    return made;
}

WholeRay ray_of_any_direction(std::int32_t reach, std::int32_t slope, Random& random) {
    WholeRay ray;
    for (std::int32_t& value : ray.origin)
        value = any_within(reach, random);
    do {
        for (std::int32_t& value : ray.direction)
            value = any_within(slope, random);
    } while (ray.direction == std::array<std::int32_t, 3>{});
    return ray;
}

TEST(BoxFaces, AreMetFirstAsLookingAtEachTells) {
    Random random(1988);
    int met = 0;
    int missed = 0;
    for (int round = 0; round < 600; ++round) {
        // Boxes that share planes, edges and corners, and rays along them.
        const std::int32_t reach = round % 2 == 0 ? 2 : 8;
        const std::size_t count = random() % 25;
        const std::vector<WholeBox> boxes = boxes_within(count, reach, 3, random);
        const BoxFaces faces(boxes, 1 + round % 3);
        for (int i = 0; i < 180; ++i) {
            const WholeRay ray = ray_of_any_direction(reach + 1, 2, random);
            const auto expected = brute_force_first_face(boxes, ray);
            ASSERT_EQ(faces.first_face(ray), expected) << "round " << round << ", ray " << i;
            ++(expected ? met : missed);
        }
    }
    EXPECT_GT(met + missed, 100'000);
    EXPECT_GT(met, 20'000);
    EXPECT_GT(missed, 10'000);
}

TEST(BoxFaces, AreMetFirstAtTheLargestCoordinates) {
    Random random(5);
    for (int round = 0; round < 20; ++round) {
        const std::vector<WholeBox> boxes =
            boxes_within(30, largest_plane_coordinate, largest_plane_coordinate, random);
        const BoxFaces faces(boxes, 2);
        for (int i = 0; i < 100; ++i) {
            const WholeRay ray =
                ray_of_any_direction(largest_plane_coordinate, 2'000'000'000, random);
            ASSERT_EQ(faces.first_face(ray), brute_force_first_face(boxes, ray));
        }
    }
}

TEST(BoxFaces, NeedADirection) {
    const BoxFaces faces(std::vector<WholeBox>(1));
    EXPECT_THROW(faces.first_face({}), std::invalid_argument);
    EXPECT_THROW(brute_force_first_face({}, {}), std::invalid_argument);
}

} // namespace
} // namespace vera
