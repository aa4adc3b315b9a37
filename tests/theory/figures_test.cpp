// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/figures.h"

#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using ::testing::HasSubstr;

TEST(Figures, AreTheSameFromRunToRun) {
    for (const Figure& figure : figures()) {
        const std::string svg = figure.drawn().svg;
        EXPECT_EQ(svg, figure.drawn().svg) << figure.name;
        EXPECT_THAT(svg, HasSubstr("<title>Figure " + figure.name)) << figure.name;
        EXPECT_EQ(svg.find("nan"), std::string::npos) << figure.name;
        EXPECT_TRUE(svg.ends_with("</svg>\n")) << figure.name;
    }
}

TEST(Figures, AreThoseOfTheDocuments) {
    for (const Figure& figure : figures()) {
        const std::string path =
            std::string(VERA_SOURCE_DIR "/docs/images/figure-") + figure.name + ".svg";
        std::ifstream file(path, std::ios::binary);
        const std::string shown{
            std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        EXPECT_EQ(shown, figure.drawn().svg) << "tools/bounds.sh draws " << path << " anew";
    }
}

TEST(Figures, OfTheConnectionGraphHasTheSceneAndTheDrainsOfThePaper) {
    const DrawnFigure figure = figure_of_connection_graph();
    EXPECT_EQ(figure.count("polygons"), 14U);
    EXPECT_EQ(figure.count("edges of polygons"), 50U);
    // The drains are a tree: from every vertex but the root one leads on.
    EXPECT_EQ(
        figure.count("natural drains") + figure.count("drain lines") + 1, figure.count("vertices"));
    EXPECT_GT(figure.count("drain lines"), 2U);
    EXPECT_GT(figure.count("crossings"), 5U);
    // Every crossing cuts two segments.
    EXPECT_EQ(figure.count("edges"), figure.count("segments") + 2 * figure.count("crossings"));
    EXPECT_EQ(figure.count("regions seen"), 14U);
    EXPECT_THAT(figure.svg, HasSubstr("14 polygons with 50 edges"));
}

TEST(Figures, OfTheTraversalPassesEveryEdgeAndGoesOnFromTheDrain) {
    const DrawnFigure figure = figure_of_traversal();
    EXPECT_EQ(figure.count("passed"), figure.count("edges"));
    EXPECT_EQ(figure.count("edges to V"), 3U);
    EXPECT_EQ(figure.count("edges from V"), 3U);
    EXPECT_GE(figure.count("number of the drain"), 1U);
}

TEST(Figures, OfTheConjugationTreeCountsItsNodes) {
    const DrawnFigure figure = figure_of_conjugation_tree();
    EXPECT_EQ(figure.count("points"), 64U);
    EXPECT_EQ(figure.count("nodes"), 63U);
    // Each node at which the search goes on has two children that it looks at.
    EXPECT_EQ(
        figure.count("inside") + figure.count("outside") + figure.count("looked at"),
        figure.count("going on") + 1);
    EXPECT_GT(figure.count("inside"), 2U);
    EXPECT_GT(figure.count("outside"), 2U);
    EXPECT_GT(figure.count("looked at"), 0U);
    EXPECT_GT(figure.count("in the half-plane"), 10U);
    EXPECT_LT(figure.count("in the half-plane"), 54U);
}

TEST(Figures, OfDualSpacePassesTheSameBeforeAndAfter) {
    const DrawnFigure figure = figure_of_dual_space();
    EXPECT_EQ(figure.count("lines"), 2 * figure.count("rectangles"));
    EXPECT_EQ(figure.count("passed"), figure.count("passed when moved"));
    EXPECT_GT(figure.count("passed"), 0U);
    EXPECT_LE(figure.count("comparisons"), 12U);
}

TEST(Figures, OfTheSegmentTreeHoldsEachRayOnceOnAPath) {
    const DrawnFigure figure = figure_of_segment_tree();
    EXPECT_EQ(figure.count("rays"), 4U);
    EXPECT_EQ(figure.count("crossings"), 6U);
    EXPECT_EQ(figure.count("pieces"), 16U);
    EXPECT_GE(figure.count("entries"), figure.count("pieces"));
    EXPECT_EQ(figure.count("on the path"), figure.count("rays"));
    EXPECT_EQ(figure.count("met"), 3U);
}

TEST(Figures, OfTheCubeFindsThePolygonThatTheRayMeets) {
    const DrawnFigure figure = figure_of_cube();
    EXPECT_EQ(figure.count("faces"), 6U);
    EXPECT_EQ(figure.count("polygons"), 12U);
    EXPECT_GE(figure.count("regions"), 12U);
    EXPECT_EQ(figure.count("polygon of the query"), 4U); // the triangle that hangs in front
}

TEST(Figures, OfTheWindowsHideMostOfWhatCrosses) {
    const DrawnFigure figure = figure_of_windows();
    EXPECT_EQ(figure.count("rectangles"), 32U);
    EXPECT_GT(figure.count("crossings"), 2 * figure.count("corners seen"));
    EXPECT_LT(figure.count("rectangles seen"), figure.count("rectangles"));
    EXPECT_GT(figure.count("rings"), figure.count("rectangles seen"));
    EXPECT_EQ(figure.count("holes"), 1U);
}

} // namespace
} // namespace vera
