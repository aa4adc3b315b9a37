// SPDX-License-Identifier: Apache-2.0
// Groups of a drawing in PDF, where they are layers, and in EPS, where they are comments: each
// outline lies within the marks of its groups, and of no others.
#include "vera/drawing/page_content.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "drawing/pdf_text.h"
#include "drawing/sample_drawing.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::HasSubstr;
using testing::Not;

using Group = std::shared_ptr<const DrawingGroup>;

Group group_within(const Group& parent, const std::string& name) {
    return std::make_shared<const DrawingGroup>(
        DrawingGroup{.id = "id-" + name, .name = name, .parent = parent});
}

/// A square of a colour that no other number has.
FilledOutline square(std::size_t number, const Group& group) {
    const auto x = static_cast<double>(number % 30);
    const auto y = static_cast<double>(number / 30 % 30);
    return {
        .group = group,
        .color =
            {static_cast<std::uint8_t>(number >> 16U),
             static_cast<std::uint8_t>(number >> 8U),
             static_cast<std::uint8_t>(number)},
        .rings = {{{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}}};
}

Drawing drawing_of(const std::vector<Group>& groups) {
    Drawing drawing;
    drawing.width = drawing.height = 32;
    for (const Group& group : groups)
        drawing.fills.push_back(square(drawing.fills.size() + 1, group));
    return drawing;
}

/// "outer/inner", of the outermost group first.
std::string way_of(const Group& group) {
    if (!group)
        return "";
    return way_of(group->parent) + "/" + group->name;
}

/// The text in parentheses that begins at a place in a PDF, or that in UTF-16 as it stands there.
std::string name_in(const std::string& object) {
    const std::size_t begin = object.find("/Name") + 5;
    return object.substr(begin, object.size() - 2 - begin);
}

/// Whatever stands behind a name of a PDF's dictionary up to the next name or end of it.
std::string entry(const std::string& dictionary, const std::string& name) {
    const std::size_t begin = dictionary.find(name);
    EXPECT_NE(begin, std::string::npos) << name << " in " << dictionary;
    const std::size_t value = begin + name.size();
    return dictionary.substr(value, dictionary.find_first_of("/>", value) - value);
}

/// Of each filled outline of a PDF's page the names of its layers but for that of all outlines, as
/// way_of() has them.
std::vector<std::string> ways_in_pdf(const std::string& pdf) {
    const std::vector<std::string> found = objects_by_stream(pdf);
    const std::string properties =
        found[std::stoul(found[2].substr(found[2].find("/Properties ") + 12)) - 1];
    std::vector<std::string> ways;
    std::vector<std::string> open;
    std::istringstream lines(inflated(found[3]));
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("/OC /")) {
            const std::string called = line.substr(4, line.find(' ', 4) - 4);
            const std::string object = found[std::stoul(entry(properties, called + " ")) - 1];
            EXPECT_TRUE(object.starts_with("<</Type/OCG/Name"));
            open.push_back(name_in(object));
        } else if (line == "EMC") {
            EXPECT_FALSE(open.empty());
            open.pop_back();
        } else if (line == "f") {
            EXPECT_EQ(open.front(), "(Fills)");
            std::string way;
            for (std::size_t i = 1; i < open.size(); ++i)
                way += "/" + open[i].substr(1, open[i].size() - 2);
            ways.push_back(way);
        }
    }
    EXPECT_TRUE(open.empty());
    return ways;
}

std::vector<std::string> ways_in_eps(const std::string& eps) {
    std::vector<std::string> ways;
    std::vector<std::string> open;
    const std::string begin = "%%BeginObject: ";
    std::istringstream lines(eps);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(begin)) {
            open.push_back(line.substr(begin.size()));
        } else if (line == "%%EndObject") {
            EXPECT_FALSE(open.empty());
            open.pop_back();
        } else if (line == "f") {
            std::string way;
            for (const std::string& name : open)
                way += "/" + name;
            ways.push_back(way);
        }
    }
    EXPECT_TRUE(open.empty());
    return ways;
}

TEST(PageGroups, AreRoundTheirOutlinesAlone) {
    std::mt19937 random(12);
    std::size_t deep = 0;
    for (int round = 0; round < 60; ++round) {
        std::vector<Group> groups = {
            nullptr, group_within(nullptr, "a"), group_within(nullptr, "b")};
        for (int i = 0; i < 5; ++i)
            groups.push_back(
                group_within(groups[random() % groups.size()], random() % 2 == 0 ? "a" : "c"));
        std::vector<Group> of_fills = {groups.back()};
        std::vector<std::string> expected = {way_of(groups.back())};
        for (int i = 0; i < 12; ++i) {
            of_fills.push_back(groups[random() % groups.size()]);
            expected.push_back(way_of(of_fills.back()));
            deep += std::ranges::count(expected.back(), '/') > 2 ? 1 : 0;
        }
        const Drawing drawing = drawing_of(of_fills);
        EXPECT_EQ(ways_in_pdf(written(write_pdf, drawing)), expected);
        EXPECT_EQ(ways_in_eps(written(write_eps, drawing)), expected);
    }
    EXPECT_GT(deep, 50U);
}

TEST(PageGroups, AreListedWithinTheLayerOfOutlines) {
    const Group a = group_within(nullptr, "a");
    const Group b = group_within(a, "b (1)\\");
    const Group c = group_within(a, "caf\xC3\xA9 \xF0\x9F\x8C\xB3");
    const Group d = group_within(nullptr, "d");
    const Group e = group_within(d, "");
    const Group f = group_within(e, "f");
    Drawing drawing = drawing_of({b, c, f, nullptr, d});
    drawing.strokes = {{.points = {{0, 0}, {9, 9}}}};
    const std::vector<std::string> found = objects_by_stream(written(write_pdf, drawing));
    ASSERT_EQ(found.size(), 19U);
    EXPECT_EQ(found[0], "<</Type/Catalog/Pages 2 0 R/Metadata 8 0 R/OCProperties 17 0 R>>");
    EXPECT_THAT(found[2], HasSubstr("/Resources<</Properties 16 0 R>>/Contents"));
    EXPECT_EQ(found[5], "<</Type/OCG/Name(Fills)>>");
    EXPECT_EQ(found[6], "<</Type/OCG/Name(Silhouette lines)>>");
    EXPECT_EQ(found[8], "<</Type/OCG/Name(a)>>");
    EXPECT_EQ(found[9], "<</Type/OCG/Name(b \\(1\\)\\\\)>>");
    EXPECT_EQ(found[10], "<</Type/OCG/Name<FEFF00630061006600E90020D83CDF33>>>");
    EXPECT_EQ(found[12], "<</Type/OCG/Name(id-)>>");
    EXPECT_EQ(found[13], "<</Type/OCG/Name(f)>>");
    EXPECT_EQ(found[14], "<</Type/OCG/Name(d)>>"); // again, as what is in none lies between
    EXPECT_EQ(
        found[15],
        "<</L0 6 0 R/L1 7 0 R/G0 9 0 R/G1 10 0 R/G2 11 0 R/G3 12 0 R/G4 13 0 R/G5 14 0 R"
        "/G6 15 0 R>>");
    EXPECT_EQ(
        found[16],
        "<</OCGs[6 0 R 7 0 R 9 0 R 10 0 R 11 0 R 12 0 R 13 0 R 14 0 R 15 0 R]/D<</Order[6 0 R["
        "9 0 R[10 0 R 11 0 R]12 0 R[13 0 R[14 0 R]]15 0 R]7 0 R]/ON[6 0 R 7 0 R]>>>>");
}

/// Objects with two parts each.
Drawing drawing_of_parts(std::size_t objects) {
    std::vector<Group> groups;
    for (std::size_t i = 0; i < objects; ++i) {
        const Group object = group_within(nullptr, fmt::format("o{}", i));
        groups.push_back(group_within(object, "p"));
        groups.push_back(group_within(object, "q"));
    }
    return drawing_of(groups);
}

TEST(PageGroups, AreToldToTheDepthToWhichTheyAreFew) {
    const std::size_t most = detail::most_page_groups;
    const auto all = ways_in_eps(written(write_eps, drawing_of_parts(most / 3)));
    EXPECT_EQ(all[2 * (most / 3) - 1], fmt::format("/o{}/q", most / 3 - 1));
    for (const std::size_t objects : {most / 3 + 1, most}) {
        const auto outer = ways_in_eps(written(write_eps, drawing_of_parts(objects)));
        EXPECT_EQ(outer[0], "/o0");
        EXPECT_EQ(outer[2 * objects - 1], fmt::format("/o{}", objects - 1));
        EXPECT_EQ(ways_in_pdf(written(write_pdf, drawing_of_parts(objects))), outer);
    }
    const std::string eps = written(write_eps, drawing_of_parts(most + 1));
    EXPECT_THAT(eps, Not(HasSubstr("%%BeginObject")));
    EXPECT_THAT(eps, Not(HasSubstr("%%EndObject")));
    EXPECT_THAT(
        objects(written(write_pdf, drawing_of_parts(most + 1)))[0],
        HasSubstr("/OCProperties<</OCGs[6 0 R]/D<</Order[6 0 R]/ON[6 0 R]>>>>"));
}

TEST(PageGroups, StandForOutlinesThatHaveNoneByTheirIds) {
    Drawing drawing = drawing_of({nullptr, nullptr, nullptr, group_within(nullptr, "a")});
    drawing.fills[0].id = drawing.fills[1].id = "underlay";
    const std::vector<std::string> expected = {"/underlay", "/underlay", "", "/a"};
    const std::string pdf = written(write_pdf, drawing);
    EXPECT_EQ(ways_in_pdf(pdf), expected);
    EXPECT_EQ(ways_in_eps(written(write_eps, drawing)), expected);
    EXPECT_EQ(objects_by_stream(pdf)[7], "<</Type/OCG/Name(underlay)>>");
    EXPECT_EQ(objects_by_stream(pdf)[8], "<</Type/OCG/Name(a)>>");
}

TEST(PageGroups, HaveNamesOfOneLineInEps) {
    const std::string eps =
        written(write_eps, drawing_of({group_within(nullptr, "caf\xC3\xA9\n%%EOF")}));
    EXPECT_THAT(eps, HasSubstr("\n%%BeginObject: caf??%%EOF\n"));
}

} // namespace
} // namespace vera
