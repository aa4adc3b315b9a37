// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/drawing_file.h"

#include <cstdint>
#include <random>
#include <string>

#include "drawing/sample_drawing.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// Areas with corners on so few places that many rings vanish when they are rounded to pixels.
SharedAreas random_areas(std::uint32_t seed, std::uint32_t count) {
    std::mt19937 numbers(seed);
    const auto below = [&](std::uint32_t end) {
        return static_cast<std::uint32_t>(numbers() % end);
    };
    SharedAreas areas;
    for (std::uint32_t i = 0; i < 12; ++i) {
        const double x = 0.3 * below(12);
        const double y = 0.3 * below(12);
        areas.places.push_back({x, y});
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        for (std::uint32_t ring = below(4); ring > 0; --ring) {
            for (std::uint32_t corner = below(6); corner > 0; --corner)
                areas.corners.push_back(below(12));
            areas.ring_ends.push_back(static_cast<std::uint32_t>(areas.corners.size()));
        }
        areas.area_ends.push_back(static_cast<std::uint32_t>(areas.ring_ends.size()));
        areas.colors.push_back({static_cast<std::uint8_t>(below(3)), 0, 0});
    }
    return areas;
}

/// The areas as outlines by themselves: how they are to look.
Drawing with_outlines(Drawing drawing) {
    for (std::size_t i = 0; i < drawing.areas.count(); ++i)
        drawing.fills.push_back(outline_of(drawing.areas, i));
    drawing.areas = {};
    return drawing;
}

void expect_like_outlines(const Drawing& drawing, const std::string& what) {
    DrawingSettings settings;
    settings.precision = 1;
    for (const Writer writer : {Writer{write_svg}, Writer{write_pdf}, Writer{write_eps}})
        EXPECT_TRUE(
            written(writer, drawing, settings) == written(writer, with_outlines(drawing), settings))
            << what;
}

TEST(SharedAreas, AreWrittenAsOutlinesOfTheirOwn) {
    std::size_t empty = 0;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        Drawing drawing = seed % 2 == 0 ? Drawing() : sample_drawing();
        drawing.areas = random_areas(seed, seed % 5);
        expect_like_outlines(drawing, "seed " + std::to_string(seed));
        DrawingSettings settings;
        settings.precision = 1;
        const std::string text = written(write_svg, drawing, settings);
        empty += text.find("\"fills\"") == std::string::npos ? 1 : 0;
    }
    EXPECT_GT(empty, 0U) << "nothing is left of the areas of some drawings";
    EXPECT_LT(empty, 100U);
}

TEST(SharedAreas, AreWrittenWhereTheyAreMoreThanOneBlock) {
    Drawing drawing;
    drawing.areas = random_areas(1, 10'000);
    expect_like_outlines(drawing, "many");
}

TEST(SharedAreas, AreTakenOutByThemselves) {
    SharedAreas areas;
    areas.places = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    areas.corners = {0, 1, 2, 0, 2, 3};
    areas.ring_ends = {3, 6};
    areas.area_ends = {0, 1, 2};
    areas.colors = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    EXPECT_TRUE(outline_of(areas, 0).rings.empty());
    const FilledOutline last = outline_of(areas, 2);
    EXPECT_EQ(last.color, (DrawingColor{3, 0, 0}));
    ASSERT_EQ(last.rings.size(), 1U);
    EXPECT_EQ(last.rings[0], (std::vector<DrawingPoint>{{0, 0}, {4, 4}, {0, 4}}));
}

} // namespace
} // namespace vera
