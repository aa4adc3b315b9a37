// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/inner_point.h"

#include <numeric>
#include <vector>

#include "formats/read_text.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// For all items of a text.
std::optional<Vec3> point_in(const std::string& text) {
    const SceneFile file = read_text("MA m DRF 1 1 1 CM m " + text);
    std::vector<std::uint32_t> items(file.scene.geometry.items.size());
    std::iota(items.begin(), items.end(), 0U);
    return inner_point(file.scene.geometry, items);
}

const std::string cube = "P4 0 0 0  0 1 0  1 1 0  1 0 0  P4 0 0 1  1 0 1  1 1 1  0 1 1 "
                         "P4 0 0 0  1 0 0  1 0 1  0 0 1  P4 0 1 0  0 1 1  1 1 1  1 1 0 "
                         "P4 0 0 0  0 0 1  0 1 1  0 1 0  P4 1 0 0  1 1 0  1 1 1  1 0 1 ";

TEST(InnerPoint, OfACubeIsItsMiddle) {
    for (const char* ip : {"", "IP 0.5 3 0.5 ", "IP -5 -5 -5 "})
        EXPECT_EQ(point_in(ip + cube), (Vec3{0.5, 0.5, 0.5}));
}

TEST(InnerPoint, IsInsideOfAllFacesOfASolidThatIsNotConvex) {
    // An arrow's head: what sees all of it is the small part at its tip.
    const auto point = point_in(
        "IP 50 50 50 PN 4 0 0 0  4 -8 0  0 -7 0  -4 -8 0  PN 4 0 0 1  -4 -8 1  0 -7 1  4 -8 1 "
        "P4 0 0 0 0 0 1 4 -8 1 4 -8 0  P4 4 -8 0 4 -8 1 0 -7 1 0 -7 0 "
        "P4 0 -7 0 0 -7 1 -4 -8 1 -4 -8 0  P4 -4 -8 0 -4 -8 1 0 0 1 0 0 0 ");
    ASSERT_TRUE(point);
    EXPECT_GT(point->z, 0);
    EXPECT_LT(point->z, 1);
    EXPECT_LT(point->y, -2 * std::abs(point->x)); // below the slopes
    EXPECT_GT(point->y, -7 + 0.25 * std::abs(point->x));
}

TEST(InnerPoint, IsNoneWhereNothingSeesAllFaces) {
    // A U.
    EXPECT_FALSE(
        point_in("PN 8 0 0 0 0 3 0 1 3 0 1 1 0 2 1 0 2 3 0 3 3 0 3 0 0 "
                 "PN 8 0 0 1 3 0 1 3 3 1 2 3 1 2 1 1 1 1 1 1 3 1 0 3 1 "
                 "P4 0 0 0 3 0 0 3 0 1 0 0 1 P4 3 0 0 3 3 0 3 3 1 3 0 1 P4 3 3 0 2 3 0 2 3 1 3 3 1 "
                 "P4 2 3 0 2 1 0 2 1 1 2 3 1 P4 2 1 0 1 1 0 1 1 1 2 1 1 P4 1 1 0 1 3 0 1 3 1 1 1 1 "
                 "P4 1 3 0 0 3 0 0 3 1 1 3 1 P4 0 3 0 0 0 0 0 0 1 0 3 1 "));
    EXPECT_FALSE(point_in("SP 0 0 0 1 "));
}

TEST(InnerPoint, KeepsTheSideOfFacesThatAreOfNoSolid) {
    // A wall through the cube, of which its inner point is to the right.
    const auto point = point_in("IP 0.9 3 0.5 " + cube + "P4 0.6 -1 -1 0.6 2 -1 0.6 2 2 0.6 -1 2 ");
    ASSERT_TRUE(point);
    EXPECT_GT(point->x, 0.6);
    EXPECT_LT(point->x, 1);
}

} // namespace
} // namespace vera
