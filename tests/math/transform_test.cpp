// SPDX-License-Identifier: Apache-2.0
#include "vera/math/transform.h"

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(Rotation, TurnsRightHandedAboutXThenYThenZ) {
    EXPECT_EQ(transformed_point(rotation({90, 0, 0}), {0, 1, 0}), (Vec3{0, 0, 1}));
    EXPECT_EQ(transformed_point(rotation({0, 90, 0}), {0, 0, 1}), (Vec3{1, 0, 0}));
    EXPECT_EQ(transformed_point(rotation({0, 0, 90}), {1, 0, 0}), (Vec3{0, 1, 0}));
    EXPECT_EQ(transformed_point(rotation({90, 90, 0}), {0, 1, 0}), (Vec3{1, 0, 0}));
}

TEST(Inverse, UndoesTheMap) {
    const Affine3 map =
        composed(translation({1, 2, 3}), composed(rotation({30, 40, 50}), scaling(-0.25)));
    const auto back = inverse(map);
    ASSERT_TRUE(back);
    const Vec3 point = transformed_point(*back, transformed_point(map, {4, -5, 6}));
    EXPECT_NEAR(point.x, 4, 1e-13);
    EXPECT_NEAR(point.y, -5, 1e-13);
    EXPECT_NEAR(point.z, 6, 1e-13);
}

TEST(Inverse, ExistsInAnyUnitOfLengthAndNotForSingularMaps) {
    EXPECT_TRUE(inverse(scaling(1e-120)));
    EXPECT_TRUE(inverse(scaling(1e120)));
    EXPECT_FALSE(inverse(scaling(0)));
    EXPECT_FALSE(inverse({{{Vec3{1, 2, 3}, Vec3{2, 4, 6}, Vec3{0, 0, 1}}}, {}}));
    EXPECT_FALSE(inverse({{{Vec3{0.1, 0.2, 0.3}, Vec3{0.3, 0.6, 0.9}, Vec3{0, 0, 1}}}, {}}));
}

TEST(TransformedRay, KeepsItsT) {
    const Affine3 map = composed(translation({5, 0, 0}), scaling(3));
    const Ray ray = {.origin = {1, 2, 3}, .direction = {0, 0, 1}};
    EXPECT_EQ(point_at(transformed_ray(map, ray), 7), transformed_point(map, point_at(ray, 7)));
    EXPECT_GT(transformed_ray(map, ray).origin_error, 0);
}

TEST(TransformedBox, HoldsTheImageAndStaysEmptyWhenEmpty) {
    EXPECT_TRUE(transformed_box(scaling(2), Box3{}).empty());
    const Box3 box = transformed_box(rotation({0, 0, 45}), {{-1, -1, -1}, {1, 1, 1}});
    EXPECT_NEAR(box.upper.x, 1.4142135623730951, 1e-14);
    EXPECT_GE(box.upper.z, 1);
}

} // namespace
} // namespace vera
