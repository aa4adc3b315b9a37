// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/border_ring.h"
#include "vera/visible/drawn_borders.h"
#include "vera/visible/numbered_areas.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/region_outlines.h"

#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// As the outlines of all other styles are made, region by region.
std::vector<FilledOutline> plain_outlines(
    const VisibleMap& map,
    const std::vector<std::uint64_t>& primitives,
    const PictureSettings& picture) {
    const RegionOutlines regions(map, straight_borders(map, picture));
    std::vector<FilledOutline> outlines(regions.count());
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        outlines[i].color = color_of_number(primitives[regions.rings(i).front().source] + 1);
        for (const BorderRing& ring : regions.borders(i))
            add_ring(ring, {}, outlines[i]);
    }
    return outlines;
}

void expect_like_plain_outlines(ScreenScene scene, const std::string& what) {
    PictureSettings picture;
    picture.width = 300;
    picture.height = 200;
    const VisibleMap map = visible_map(scene, whole_pieces(scene).pieces);
    std::uint32_t sources = 0;
    for (const ScreenTriangle& triangle : scene.triangles)
        sources = std::max(sources, triangle.source + 1);
    std::vector<std::uint64_t> primitives(sources);
    std::iota(primitives.begin(), primitives.end(), 70'000U); // all three bytes differ
    const std::vector<FilledOutline> expected = plain_outlines(map, primitives, picture);
    const SharedAreas areas = numbered_areas(map, primitives, picture);
    ASSERT_EQ(areas.count(), expected.size()) << what;
    for (std::size_t i = 0; i < areas.count(); ++i) {
        const FilledOutline outline = outline_of(areas, i);
        EXPECT_EQ(outline.color, expected[i].color) << what << ", area " << i;
        ASSERT_EQ(outline.rings, expected[i].rings) << what << ", area " << i;
    }
}

TEST(NumberedAreas, AreTheRegionsOfTheMap) {
    for (std::uint64_t seed = 0; seed < 60 && !HasFailure(); ++seed) {
        expect_like_plain_outlines(testing::layers(seed, 1 + seed % 30, 8), "layers");
        expect_like_plain_outlines(testing::tangle(seed, 1 + seed % 12, 6), "tangle");
    }
    expect_like_plain_outlines(testing::scattered(1, 2000, screen_size / 20), "scattered");
    expect_like_plain_outlines({}, "nothing");
}

TEST(NumberedAreas, TellPrimitivesByTheBytesOfTheirNumbers) {
    EXPECT_EQ(color_of_number(0), (DrawingColor{0, 0, 0}));
    EXPECT_EQ(color_of_number(0x010203), (DrawingColor{1, 2, 3}));
    EXPECT_EQ(color_of_number(0xffffff), (DrawingColor{255, 255, 255}));
}

} // namespace
} // namespace vera
