// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/point_boxes.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(PointBoxes, TellThePointsThatLookingAtEachTells) {
    std::mt19937_64 random(1988);
    const auto some = [&] { return static_cast<double>(random() % 7); };
    const auto some_point = [&] {
        const double x = some();
        const double y = some();
        const double z = some();
        return Vec3{x, y, z};
    };
    std::size_t told = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<Vec3> points(random() % 200);
        const bool are_equal = round % 7 == 0;
        const Vec3 one = some_point();
        for (Vec3& point : points)
            point = are_equal ? one : some_point();
        const PointBoxes boxes(points);
        for (int i = 0; i < 10; ++i) {
            const Vec3 a = some_point();
            const Vec3 b = some_point();
            const Box3 box = {min(a, b), max(a, b)};
            std::vector<std::uint32_t> expected;
            for (std::uint32_t p = 0; p < points.size(); ++p)
                if (contains(box, points[p]))
                    expected.push_back(p);
            std::vector<std::uint32_t> found;
            boxes.append_in(box, found);
            std::sort(found.begin(), found.end());
            ASSERT_EQ(found, expected);
            told += found.size();
        }
    }
    EXPECT_GT(told, 10000U);
}

} // namespace
} // namespace vera
