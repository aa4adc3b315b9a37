// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/closed_bodies.h"

#include <array>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

Facets facets_of(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    Facets facets;
    for (int i = 0; i < 8; ++i)
        facets.corners.push_back({1.0 * (i & 1), 1.0 * (i >> 1 & 1), 1.0 * (i >> 2)});
    for (const auto& corners : triangles)
        facets.triangles.push_back({corners});
    return facets;
}

using Numbers = std::vector<std::uint32_t>;

TEST(ClosedBodies, AreFacetsWithoutABorder) {
    const ClosedBodies bodies =
        closed_bodies(facets_of({{0, 1, 2}, {0, 2, 4}, {5, 6, 7}, {0, 4, 1}, {1, 4, 2}}));
    EXPECT_EQ(bodies.of_facet, (Numbers{0, 0, no_body, 0, 0}));
    ASSERT_EQ(bodies.boxes.size(), 1U);
    EXPECT_EQ(bodies.boxes[0], (Box3{{0, 0, 0}, {1, 1, 1}}));
}

TEST(ClosedBodies, AreNotThoseWithABorder) {
    EXPECT_EQ(
        closed_bodies(facets_of({{0, 1, 2}, {0, 2, 4}, {0, 4, 1}})).of_facet, Numbers(3, no_body));
}

TEST(ClosedBodies, AreNotThoseWhoseFacetsDisagreeAboutTheOutside) {
    EXPECT_EQ(
        closed_bodies(facets_of({{0, 1, 2}, {0, 2, 4}, {0, 4, 1}, {1, 2, 4}})).of_facet,
        Numbers(4, no_body));
}

TEST(ClosedBodies, AreNotThoseOfWhichThreeFacetsMeetAtASide) {
    EXPECT_EQ(
        closed_bodies(facets_of({{0, 1, 2}, {0, 2, 4}, {0, 4, 1}, {1, 4, 2}, {0, 1, 7}})).of_facet,
        Numbers(5, no_body));
}

TEST(ClosedBodies, AreNotThoseOfAFacetWithTwoCornersInOne) {
    EXPECT_EQ(closed_bodies(facets_of({{0, 0, 1}})).of_facet, Numbers(1, no_body));
}

} // namespace
} // namespace vera
