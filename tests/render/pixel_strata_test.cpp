// SPDX-License-Identifier: Apache-2.0
#include "vera/render/pixel_strata.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// What a ray sees that meets nothing, or a face of this number.
Seen sky() {
    return {};
}

Seen face(std::uint32_t number) {
    Seen seen;
    seen.found = true;
    seen.face.primitive = number;
    seen.material = MaterialId{number};
    return seen;
}

void add(PixelStrata& strata, std::size_t list, const Seen& seen, Color color) {
    Stratum& stratum = strata[strata.find_or_add(list, seen)];
    ++stratum.covered;
    stratum.add(color);
}

TEST(PixelStrata, WeighSurfacesByAllRaysAndColoursBySome) {
    PixelStrata strata;
    const std::size_t list = strata.begin(sky());
    EXPECT_FALSE(strata.shows_several(list));
    add(strata, list, sky(), {0, 0, 1});
    add(strata, list, face(1), {1, 0, 0});
    add(strata, list, face(1), {0.5, 0, 0});
    for (int i = 0; i < 5; ++i)
        ++strata[strata.find_or_add(list, face(1))].covered;
    EXPECT_TRUE(strata.shows_several(list));
    EXPECT_EQ(strata.color(list), (Color{0.75 * 7 / 8, 0, 1.0 / 8}));
}

TEST(PixelStrata, LeaveOutACentreThatNoRayMeets) {
    PixelStrata strata;
    const std::size_t list = strata.begin(face(7));
    add(strata, list, sky(), {0.25, 0.5, 1});
    add(strata, list, sky(), {0.25, 0.5, 1});
    EXPECT_EQ(strata.color(list), (Color{0.25, 0.5, 1}));
    EXPECT_EQ(strata.deviation(list, nullptr), 0);
}

TEST(PixelStrata, OfOneColourEachDoNotDeviateAtAll) {
    PixelStrata strata;
    const std::size_t list = strata.begin(face(1));
    const Color one = {0.1, 0.2, 0.3};
    const Color other = {0.7, 0.9, 0.11};
    for (int i = 0; i < 7; ++i) {
        add(strata, list, face(1), one);
        add(strata, list, face(2), other);
    }
    EXPECT_EQ(strata.deviation(list, &one), 0) << "to the bit, for a tolerance of 0";
}

TEST(PixelStrata, DeviateByWhatVariesWithinSurfaces) {
    PixelStrata strata;
    const std::size_t list = strata.begin(face(1));
    add(strata, list, face(1), {0, 0, 0});
    add(strata, list, face(1), {0, 1, 0});
    add(strata, list, face(2), {1, 1, 1});
    add(strata, list, face(2), {1, 1, 1});
    // The variance of 0 and 1 is 1/2, without bias, and half of the rays met that surface.
    EXPECT_DOUBLE_EQ(strata.deviation(list, nullptr), 0.5);
    const Color center = {0, 0.5, 0};
    EXPECT_DOUBLE_EQ(strata.deviation(list, &center), std::sqrt(0.5 * 0.25));
}

TEST(PixelStrata, TakeTheMeanWhereASurfaceHasOneColour) {
    PixelStrata strata;
    const std::size_t list = strata.begin(sky());
    add(strata, list, sky(), {0, 0, 0});
    add(strata, list, face(1), {1, 0, 0});
    EXPECT_DOUBLE_EQ(strata.deviation(list, nullptr), 0.5);
    const Color center = {0, 0, 0};
    EXPECT_DOUBLE_EQ(strata.deviation(list, &center), std::sqrt(0.5 * 0.25));
}

TEST(PixelStrata, KeepTheListsOfPixelsApart) {
    PixelStrata strata;
    const std::size_t first = strata.begin(sky());
    const std::size_t second = strata.begin(sky());
    add(strata, first, face(1), {1, 0, 0});
    add(strata, second, face(1), {0, 1, 0});
    add(strata, first, face(2), {1, 0, 0});
    EXPECT_EQ(strata.color(first), (Color{1, 0, 0}));
    EXPECT_EQ(strata.color(second), (Color{0, 1, 0}));
}

TEST(PixelStrata, TakeTheRoomOfListsThatAreNeededNoMore) {
    PixelStrata strata;
    for (int i = 0; i < 1000; ++i) {
        const std::size_t kept = strata.begin(face(1));
        const std::size_t list = strata.begin(sky());
        add(strata, list, face(1), {0, 1, 0});
        add(strata, kept, face(1), {1, 0, 0});
        add(strata, list, face(2), {0, 1, 0});
        EXPECT_EQ(strata.color(list), (Color{0, 1, 0})) << "nothing is left of others";
        strata.end(list);
        EXPECT_EQ(strata.color(kept), (Color{1, 0, 0}));
        strata.end(kept);
    }
    EXPECT_EQ(strata.room(), 4U);
}

} // namespace
} // namespace vera
