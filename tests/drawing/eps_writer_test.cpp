// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "drawing/sample_drawing.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

TEST(WriteEps, SaysWhatItNeedsAndHowLargeItIs) {
    const std::string text = written(write_eps, sample_drawing());
    EXPECT_THAT(
        text,
        StartsWith("%!PS-Adobe-3.0 EPSF-3.0\n"
                   "%%BoundingBox: 0 0 30 23\n"
                   "%%HiResBoundingBox: 0 0 30 22.5\n"
                   "%%Title: Two & more\n"
                   "%%LanguageLevel: 2\n"
                   "%%EndComments\n"));
    EXPECT_THAT(
        text, HasSubstr("\n0 0 30 22.5 rectclip\nq\n.0075 0 0 -.0075 0 22.5 cm\n1 1 1 rg\n"));
    EXPECT_THAT(text, HasSubstr("\n% Hidden lines\n50 w 0 J 1 j [300 200] 0 d\n0 0 0 RG\n0 0 m\n"));
    EXPECT_THAT(text, EndsWith("S\nQ\ngrestore\nend\n%%EOF\n"));
}

TEST(WriteEps, SetsTheColorOfALineAfterFillsOfAnother) {
    Drawing drawing = sample_drawing();
    drawing.fills[0].color = {0, 0, 0}; // its seam too
    EXPECT_THAT(
        written(write_eps, drawing),
        HasSubstr("f\n% Hidden lines\n50 w 0 J 1 j [300 200] 0 d\n0 0 0 RG\n"));
}

TEST(WriteEps, DefinesGradientsAsPatternsOfLevelThree) {
    const std::string text = written(write_eps, drawing_of_gradients());
    EXPECT_THAT(text, HasSubstr("%%LanguageLevel: 3\n"));
    EXPECT_THAT(
        text, HasSubstr("/cs{pop}def/CS{pop}def/scn{load setpattern}def/SCN{scn}def\n%%EndProlog"));
    EXPECT_THAT(
        text,
        HasSubstr("\n/P0 <</PatternType 2/Shading<</ShadingType 2/ColorSpace/DeviceRGB"
                  "/Coords[0 0 1 0]/Extend[true true]/Function<</FunctionType 2/Domain[0 1]"
                  "/C0[1 0 0]/C1[0 0 1]/N 1>>>>>>[7.5 0 0 -7.5 .75 21.75]makepattern def\n"));
    EXPECT_THAT(text, HasSubstr("\n/Pattern cs /P0 scn\n1 1 m\n"));
}

TEST(WriteEps, BreaksLinesOfGradientsOfManyColours) {
    Drawing drawing = drawing_of_gradients();
    std::vector<GradientStop>& stops = drawing.fills[0].gradient->stops;
    stops.clear();
    for (int i = 0; i <= 60; ++i)
        stops.push_back({i / 60.0, {static_cast<std::uint8_t>(4 * i), 100, 200}});
    std::istringstream lines(written(write_eps, drawing));
    std::size_t longest = 0;
    std::size_t functions = 0;
    for (std::string line; std::getline(lines, line);) {
        longest = std::max(longest, line.size());
        for (std::size_t at = 0; (at = line.find("/N", at)) != std::string::npos; ++at)
            ++functions;
    }
    EXPECT_LE(longest, 255U);
    EXPECT_GT(longest, 240U);
    EXPECT_GE(functions, 60U); // no word is broken
}

TEST(WriteEps, IsAWholeFileForAnEmptyDrawing) {
    EXPECT_THAT(
        written(write_eps, {}),
        EndsWith("\nq\n.0075 0 0 -.0075 0 .75 cm\nQ\ngrestore\nend\n%%EOF\n"));
}

} // namespace
} // namespace vera
