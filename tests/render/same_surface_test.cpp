// SPDX-License-Identifier: Apache-2.0
#include "vera/render/seen.h"

#include <gtest/gtest.h>

namespace vera {
namespace {

Seen saw(std::uint64_t primitive, Vec3 point, Vec3 normal) {
    Seen seen;
    seen.found = true;
    seen.face = {primitive, 0};
    seen.material = MaterialId{0};
    seen.point = point;
    seen.normal = normal;
    return seen;
}

TEST(SameSurface, IsNothingAndNothingOrTheSameFace) {
    const Seen floor = saw(0, {0, 0, 0}, {0, 1, 0});
    EXPECT_TRUE(same_surface({}, {}));
    EXPECT_FALSE(same_surface({}, floor));
    EXPECT_FALSE(same_surface(floor, {}));
    EXPECT_TRUE(same_surface(floor, saw(0, {9, 3, 0}, {1, 0, 0})));
}

TEST(SameSurface, GoesOnFromFaceToFaceOfAPlaneOrSmoothMesh) {
    const Seen floor = saw(0, {0, 0, 0}, {0, 1, 0});
    EXPECT_TRUE(same_surface(floor, saw(1, {100, 0, 0}, {0, 1, 0})));
    EXPECT_TRUE(same_surface(floor, saw(1, {1, -0.1, 0}, normalized({0.2, 1, 0}))));
    EXPECT_TRUE(same_surface(floor, saw(1, {100, 0, 0}, {0, -1, 0}))) << "turned the other way";
    EXPECT_TRUE(same_surface(floor, saw(1, {0, 0, 0}, {0, 1, 0})));
}

TEST(SameSurface, EndsAtACreaseAStepOrAnotherMaterial) {
    const Seen floor = saw(0, {0, 0, 0}, {0, 1, 0});
    EXPECT_FALSE(same_surface(floor, saw(1, {1, 0, 0}, {1, 0, 0}))) << "a wall";
    EXPECT_FALSE(same_surface(floor, saw(1, {0.1, 1, 0}, {0, 1, 0}))) << "a table";
    Seen carpet = saw(1, {1, 0, 0}, {0, 1, 0});
    carpet.material = MaterialId{1};
    EXPECT_FALSE(same_surface(floor, carpet));
}

} // namespace
} // namespace vera
