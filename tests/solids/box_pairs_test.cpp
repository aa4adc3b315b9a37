// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/box_pairs.h"

#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

std::vector<Box3> random_boxes(std::mt19937& random, std::size_t count, double largest) {
    std::vector<Box3> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const auto value = [&] { return static_cast<double>(random() % 12); };
        const Vec3 lower = {value(), value(), value()};
        const auto size = [&] { return static_cast<double>(random() % 4) * largest / 3; };
        boxes.push_back({lower, lower + Vec3{size(), size(), size()}});
    }
    return boxes;
}

TEST(BoxPairs, AreThoseThatMeetAndEachOnce) {
    std::mt19937 random(4);
    for (int round = 0; round < 60; ++round) {
        const auto boxes = random_boxes(random, random() % 300, round % 3 == 0 ? 12 : 1);
        std::set<std::pair<std::uint32_t, std::uint32_t>> found;
        for_each_box_pair(boxes, [&](std::uint32_t i, std::uint32_t k) {
            ASSERT_LT(i, k);
            ASSERT_TRUE(found.emplace(i, k).second);
        });
        for (std::uint32_t i = 0; i < boxes.size(); ++i)
            for (std::uint32_t k = i + 1; k < boxes.size(); ++k) {
                bool meet = true;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    meet = meet && boxes[i].lower[axis] <= boxes[k].upper[axis]
                        && boxes[k].lower[axis] <= boxes[i].upper[axis];
                ASSERT_EQ(found.contains({i, k}), meet) << i << ' ' << k;
            }
    }
}

TEST(BoxPairs, CanBeStopped) {
    std::mt19937 random(4);
    const auto boxes = random_boxes(random, 2000, 1);
    CancelFlag cancel;
    double last = 0;
    for_each_box_pair(
        boxes,
        [](std::uint32_t, std::uint32_t) {},
        [&](double done) {
            EXPECT_GE(done, last);
            last = done;
        });
    EXPECT_EQ(last, 1);
    cancel.raise();
    EXPECT_THROW(
        for_each_box_pair(
            boxes, [](std::uint32_t, std::uint32_t) {}, {}, &cancel),
        Cancelled);
}

} // namespace
} // namespace vera
