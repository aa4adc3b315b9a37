// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "drawing/sample_drawing.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

using Group = std::pair<int, std::string>;

std::vector<Group> groups_of(const std::string& text) {
    std::istringstream lines(text);
    std::vector<Group> groups;
    std::string code;
    std::string value;
    while (std::getline(lines, code) && std::getline(lines, value))
        groups.emplace_back(std::stoi(code), value);
    return groups;
}

/// The groups of each entity, from its kind on to before the next one.
std::vector<std::vector<Group>> entities_of(const std::string& text) {
    std::vector<std::vector<Group>> entities;
    bool is_inside = false;
    for (const Group& group : groups_of(text)) {
        if (group == Group{2, "ENTITIES"})
            is_inside = true;
        else if (is_inside && group == Group{0, "ENDSEC"})
            break;
        else if (is_inside && group.first == 0)
            entities.push_back({group});
        else if (is_inside)
            entities.back().push_back(group);
    }
    return entities;
}

/// The values of that code in their order, one behind the other.
std::vector<std::string> values(const std::vector<Group>& groups, int code) {
    std::vector<std::string> found;
    for (const Group& group : groups)
        if (group.first == code)
            found.push_back(group.second);
    return found;
}

TEST(WriteDxf, HasEverySectionAndTableInOrder) {
    const std::vector<Group> groups = groups_of(written(write_dxf, sample_drawing()));
    std::vector<std::string> names;
    for (std::size_t i = 0; i + 1 < groups.size(); ++i)
        if (groups[i] == Group{0, "SECTION"} || groups[i] == Group{0, "TABLE"})
            names.push_back(groups[i + 1].second);
    EXPECT_THAT(
        names,
        ElementsAre(
            "HEADER",
            "CLASSES",
            "TABLES",
            "VPORT",
            "LTYPE",
            "LAYER",
            "STYLE",
            "VIEW",
            "UCS",
            "APPID",
            "DIMSTYLE",
            "BLOCK_RECORD",
            "BLOCKS",
            "ENTITIES",
            "OBJECTS"));
    EXPECT_EQ(groups.back(), (Group{0, "EOF"}));
    EXPECT_THAT(values(groups, 999), ElementsAre("Two & more", "squares"));
}

TEST(WriteDxf, GivesEveryObjectAHandleOfItsOwnAndNamesNoneThatIsNotThere) {
    const std::vector<Group> groups = groups_of(written(write_dxf, sample_drawing()));
    std::set<unsigned long> handles;
    unsigned long seed = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        if (groups[i].first != 5 && groups[i].first != 105)
            continue;
        const unsigned long handle = std::stoul(groups[i].second, nullptr, 16);
        if (groups[i - 1] == Group{9, "$HANDSEED"})
            seed = handle;
        else
            EXPECT_TRUE(handles.insert(handle).second) << groups[i].second;
    }
    EXPECT_GT(seed, *handles.rbegin());
    for (const Group& group : groups)
        if ((group.first == 330 && group.second != "0") || group.first == 350) {
            EXPECT_TRUE(handles.count(std::stoul(group.second, nullptr, 16)) == 1) << group.second;
        }
}

TEST(WriteDxf, MakesALayerOfEachClassWithItsLineTypeWidthAndColor) {
    DrawingSettings settings;
    settings.page_width_millimeters = 80; // 2 to the pixel
    settings.line_styles = {
        {.line_class = LineClass::hidden,
         .color = {250, 10, 0},
         .width = 0.1,
         .dashes = {3, 2, 1}}};
    const std::string text = written(write_dxf, sample_drawing(), settings);
    EXPECT_THAT(text, HasSubstr("2\nhidden\n70\n0\n62\n1\n6\nDASHED\n370\n20\n"));
    EXPECT_THAT(text, HasSubstr("2\nsilhouette\n70\n0\n62\n7\n6\nContinuous\n370\n200\n"));
    // A gap where the first time was a dash.
    EXPECT_THAT(
        text,
        HasSubstr(
            "2\nDASHED\n70\n0\n3\n_ _ _ _\n72\n65\n73\n6\n40\n24\n49\n6\n74\n0\n49\n-4\n74\n0\n"
            "49\n2\n74\n0\n49\n-6\n74\n0\n49\n4\n74\n0\n49\n-2\n74\n0\n"));
    EXPECT_THAT(text, HasSubstr("$INSUNITS\n70\n4\n"));
    EXPECT_THAT(text, HasSubstr("$EXTMAX\n10\n80\n20\n60\n30\n0\n"));
}

TEST(WriteDxf, CountsUpwardFromTheLowerBorder) {
    const auto entities = entities_of(written(write_dxf, sample_drawing()));
    ASSERT_EQ(entities.size(), 3U);
    EXPECT_EQ(entities[0][0].second, "LINE");
    EXPECT_THAT(values(entities[0], 8), ElementsAre("hidden"));
    EXPECT_THAT(values(entities[0], 10), ElementsAre("0"));
    EXPECT_THAT(values(entities[0], 20), ElementsAre("30"));
    EXPECT_THAT(values(entities[0], 11), ElementsAre("10"));
    EXPECT_THAT(values(entities[0], 21), ElementsAre("25"));
    EXPECT_EQ(entities[2][0].second, "LWPOLYLINE");
    EXPECT_THAT(values(entities[2], 8), ElementsAre("silhouette"));
    EXPECT_THAT(values(entities[2], 90), ElementsAre("4"));
    EXPECT_THAT(values(entities[2], 70), ElementsAre("1"));
    EXPECT_THAT(values(entities[2], 10), ElementsAre("1", "21", "21", "1"));
    EXPECT_THAT(values(entities[2], 20), ElementsAre("29", "29", "19", "19"));
}

TEST(WriteDxf, WritesArcsWholeAndWhatIsBetweenAsLines) {
    Drawing drawing;
    drawing.width = drawing.height = 100;
    const DrawingEllipse circle = {{50, 50}, {10, 0}, {0, 10}};
    const DrawingEllipse ellipse = {{20, 30}, {0, 10}, {-5, 0}};
    drawing.strokes = {
        {.points = {{60, 50}}, .closed = true, .arcs = {{0, circle, 0, 360}}},
        // A quarter from the right to below, there and back.
        {.points = {{60, 50}, {50, 60}}, .arcs = {{0, circle, 0, 90}}},
        {.points = {{50, 60}, {60, 50}}, .arcs = {{0, circle, 90, 0}}},
        {.points = {{0, 0}, {5, 30}, {15, 30}, {25, 30}},
         .closed = true,
         .arcs = {{2, ellipse, 90, -90}}}};
    const auto entities = entities_of(written(write_dxf, drawing));
    std::vector<std::string> kinds;
    for (const auto& entity : entities)
        kinds.push_back(entity[0].second);
    ASSERT_THAT(kinds, ElementsAre("CIRCLE", "ARC", "ARC", "LWPOLYLINE", "ELLIPSE", "LINE"));
    EXPECT_THAT(values(entities[0], 40), ElementsAre("10"));
    for (const int i : {1, 2}) {
        EXPECT_THAT(values(entities[static_cast<std::size_t>(i)], 50), ElementsAre("270"));
        EXPECT_THAT(values(entities[static_cast<std::size_t>(i)], 51), ElementsAre("0"));
    }
    EXPECT_THAT(values(entities[3], 10), ElementsAre("0", "5", "15"));
    EXPECT_THAT(values(entities[4], 10), ElementsAre("20"));
    EXPECT_THAT(values(entities[4], 20), ElementsAre("70"));
    EXPECT_THAT(values(entities[4], 11), ElementsAre("0"));
    EXPECT_THAT(values(entities[4], 21), ElementsAre("-10"));
    EXPECT_THAT(values(entities[4], 40), ElementsAre("0.5"));
    EXPECT_THAT(values(entities[4], 41), ElementsAre("4.71238898"));
    EXPECT_THAT(values(entities[4], 42), ElementsAre("7.853981634"));
    EXPECT_THAT(values(entities[5], 10), ElementsAre("25"));
    EXPECT_THAT(values(entities[5], 11), ElementsAre("0"));
}

TEST(WriteDxf, LeavesOutFillsAndIsWholeForAnEmptyDrawing) {
    Drawing drawing = sample_drawing();
    drawing.strokes.clear();
    EXPECT_TRUE(entities_of(written(write_dxf, drawing)).empty());
    const std::string text = written(write_dxf, {});
    EXPECT_THAT(text, HasSubstr("0\nSECTION\n2\nENTITIES\n0\nENDSEC\n"));
    EXPECT_THAT(text, Not(HasSubstr("DASHED")));
}

} // namespace
} // namespace vera
