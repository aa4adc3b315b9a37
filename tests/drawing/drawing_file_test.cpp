// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <system_error>
#include <vector>

#include "base/scratch_folder.h"
#include "drawing/sample_drawing.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::HasSubstr;

TEST(WriteDrawing, WritesTheSameBytesTwice) {
    const ScratchFolder folder;
    const std::pair<DrawingFormat, std::string> expected[] = {
        {DrawingFormat::svg, written(write_svg, sample_drawing())},
        {DrawingFormat::pdf, written(write_pdf, sample_drawing())},
        {DrawingFormat::eps, written(write_eps, sample_drawing())},
        {DrawingFormat::dxf, written(write_dxf, sample_drawing())}};
    for (const auto& [format, bytes] : expected) {
        write_drawing(sample_drawing(), folder.path() / "a", format);
        EXPECT_EQ(folder.read("a"), bytes);
    }
}

TEST(WriteDrawing, WritesAnSvgOfManyAreasIntoAFilePartByPart) {
    Drawing drawing = sample_drawing();
    drawing.areas.places = {{0, 0}, {4, 0}, {4, 4}, {0.001, 0}};
    for (std::uint32_t i = 0; i < 100'000; ++i) {
        // Nothing is left of every third.
        for (const std::uint32_t place : {0U, 1U, i % 3 == 0 ? 3U : 2U})
            drawing.areas.corners.push_back(place);
        drawing.areas.ring_ends.push_back(3 * (i + 1));
        drawing.areas.area_ends.push_back(i + 1);
        drawing.areas.colors.push_back({static_cast<std::uint8_t>(i), 0, 0});
    }
    const ScratchFolder folder;
    write_drawing(drawing, folder.path() / "a", DrawingFormat::svg);
    const std::string found = folder.read("a");
    EXPECT_TRUE(found == written(write_svg, drawing));
    EXPECT_GT(found.size(), std::size_t{1} << 21U);
}

/// Thousands of squares and lines, so that all loops look at the flag several times.
Drawing large_drawing() {
    Drawing drawing = drawing_of_gradients();
    for (int i = 0; i < 3000; ++i) {
        const double x = 0.01 * i;
        drawing.fills.push_back({.rings = {{{x, 1}, {x + 3, 1}, {x + 3, 4}, {x, 4}}}});
        drawing.strokes.push_back({.points = {{x, 0}, {x, 9}}});
        drawing.strokes.push_back({.line_class = LineClass::crease, .points = {{x, 0}, {9, x}}});
    }
    return drawing;
}

TEST(WriteDrawing, TellsHowFarItIsAndEndsWhereverItIsToldTo) {
    const Drawing drawing = large_drawing();
    for (const Writer write : {&write_svg, &write_pdf, &write_eps, &write_dxf}) {
        std::vector<double> told;
        std::string whole;
        write(
            drawing, {}, whole, [&](double done) { told.push_back(done); }, nullptr);
        ASSERT_GT(told.size(), 20U);
        EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
        EXPECT_LE(told.back(), 1);
        for (std::size_t last = 0; last + 1 < told.size(); ++last) {
            CancelFlag cancel;
            std::size_t call = 0;
            const auto progress = [&](double) {
                EXPECT_LE(call, last + 3);
                if (call++ == last)
                    cancel.raise();
            };
            std::string bytes;
            EXPECT_THROW(write(drawing, {}, bytes, progress, &cancel), Cancelled)
                << "raised in call " << last << " of " << told.size();
        }
    }
}

TEST(WriteDrawing, NamesTheFileThatCannotBeWritten) {
    try {
        write_drawing(sample_drawing(), "/nowhere/a.svg", DrawingFormat::svg);
        FAIL();
    } catch (const std::system_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("/nowhere/a.svg"));
    }
}

TEST(DrawingFormats, AreKnownByExtensionAndNameInAnyCase) {
    EXPECT_EQ(drawing_format_from_extension("a/b.svg"), DrawingFormat::svg);
    EXPECT_EQ(drawing_format_from_extension("b.PDF"), DrawingFormat::pdf);
    EXPECT_EQ(drawing_format_from_extension("b.x.Eps"), DrawingFormat::eps);
    for (const char* other : {"svg", "a.sv", "a.svgz", "-", "", "a.", ".svg"})
        EXPECT_EQ(drawing_format_from_extension(other), std::nullopt) << other;
    EXPECT_EQ(drawing_format_from_name("Svg"), DrawingFormat::svg);
    EXPECT_EQ(drawing_format_from_name(""), std::nullopt);
    EXPECT_EQ(drawing_format_names(), "svg, pdf, eps, dxf");
}

} // namespace
} // namespace vera
