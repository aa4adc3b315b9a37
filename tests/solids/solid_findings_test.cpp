// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/scene.h"
#include "vera/solids/solid_findings.h"

#include <string>

#include "formats/read_text.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// "line 3: crossing ...": what is found, with the line of the item.
std::vector<std::string> found_in(const std::string& text) {
    SceneFile file = read_text(text);
    number_primitives(file.scene);
    std::vector<std::string> found;
    for (const SolidFinding& finding : solid_findings(file.scene)) {
        const Item& item = finding.geometry(file.scene).items[finding.item];
        found.push_back(
            (finding.severity == Severity::warning ? "warning " : "note ")
            + std::to_string(item.line) + ": " + finding.problem);
    }
    return found;
}

const std::string material = "MA m DRF 1 1 1 MA glass TAB 1 1 1 CM m ";

/// The unit cube's faces in lines 2 to 7, their normals outwards.
const std::string cube = "\nP4 0 0 0  0 1 0  1 1 0  1 0 0\nP4 0 0 1  1 0 1  1 1 1  0 1 1"
                         "\nP4 0 0 0  1 0 0  1 0 1  0 0 1\nP4 0 1 0  0 1 1  1 1 1  1 1 0"
                         "\nP4 0 0 0  0 0 1  0 1 1  0 1 0\nP4 1 0 0  1 1 0  1 1 1  1 0 1\n";

TEST(SolidFindings, AreNoneInAGoodCube) {
    EXPECT_THAT(found_in(material + cube), IsEmpty());
    EXPECT_THAT(found_in(material + "IP 0.5 0.5 0.5" + cube), IsEmpty());
    EXPECT_THAT(found_in(material + "SCENE a" + cube + "LI 1 1 1 1 1 1 1 SSC a"), IsEmpty());
}

TEST(SolidFindings, NameSpheresThatPassThroughSomething) {
    // Line 8: through two faces and an edge; 9 rests on one; 10 touches 9, and 11 cuts it; 12 is
    // within the cube.
    EXPECT_THAT(
        found_in(
            material + cube
            + "SP 1 1 0.5  0.2\nSP 0.5 1.5 0.5  0.5\nSP 0.5 2.25 0.5  0.25\nSP 0.5 2 0.5  0.3\n"
              "SP 0.5 0.5 0.5  0.25\n"),
        ElementsAre(
            "note 8: this sphere passes through the face or mesh of line 5 and 1 more",
            "note 11: this sphere passes through that of line 9 and 1 more"));
    EXPECT_THAT(
        found_in(material + "\nSP 0 0 0 1\nP3 0 0 0  9 0 0  0 9 0\n"),
        ElementsAre("note 3: this face or mesh passes through the sphere of line 2"));
    EXPECT_THAT(found_in(material + "\nSP 0 0 0 1 SP 1 0 0 1\n"), IsEmpty());
    EXPECT_THAT(found_in("CM m MA m DRF 1 1 1\nMK shells turns 1\n"), IsEmpty());
}

TEST(SolidFindings, NameTheEdgesOfAHole) {
    const std::string lid = "\nP4 0 1 0  0 1 1  1 1 1  1 1 0";
    std::string open = cube;
    open.erase(open.find(lid), lid.size());
    EXPECT_THAT(found_in(material + open), IsEmpty()); // nobody said that it is a solid
    EXPECT_THAT(
        found_in(material + "IP 0.5 0.5 0.5" + open),
        ElementsAre("note 2: this solid is open: 4 of its 12 edges belong to one face alone: in "
                    "line 2 from (0 1 0) to (1 1 0), in line 3 from (1 1 1) to (0 1 1), in line 5 "
                    "from (0 1 1) to (0 1 0) and 1 more"));
}

TEST(SolidFindings, NameFacesWithTheInnerPointOutside) {
    EXPECT_THAT(
        found_in(material + "IP 0.5 2 0.5" + cube),
        ElementsAre("warning 5: the inner point is on the outer side of this face of its "
                    "solid"));
}

TEST(SolidFindings, KnowTheInsideOfAConvexSolidWithAHole) {
    const std::string lid = "\nP4 0 1 0  0 1 1  1 1 1  1 1 0";
    std::string open = cube;
    open.erase(open.find(lid), lid.size());
    EXPECT_THAT(
        found_in(material + "IP 0.5 0.5 -2" + open),
        ElementsAre(
            "warning 2: the inner point is on the outer side of this face of its solid",
            HasSubstr("note 2: this solid is open: 4 of its 12 edges")));
}

TEST(SolidFindings, NameFacesThatAreTurned) {
    std::string turned = cube;
    const std::string lid = "P4 0 1 0  0 1 1  1 1 1  1 1 0";
    turned.replace(turned.find(lid), lid.size(), "P4 0 1 0  1 1 0  1 1 1  0 1 1");
    EXPECT_THAT(
        found_in(material + turned),
        ElementsAre("note 5: the normal of this face points to the inside of its closed solid"));
    EXPECT_THAT(
        found_in(material + "CM glass" + turned),
        ElementsAre("warning 5: the normal of this face points to the inside of its closed solid"));
}

TEST(SolidFindings, TellsOfARoomOnceAndAsANote) {
    const std::string room = "\nP3 0 0 0 1 0 0 0 1 0\nP3 0 0 0 0 0 1 1 0 0\nP3 0 0 0 0 1 0 0 0 1"
                             "\nP3 1 0 0 0 0 1 0 1 0\n";
    EXPECT_THAT(
        found_in(material + room),
        ElementsAre("note 2: the normals of all 4 faces of this closed solid point inwards"));
}

TEST(SolidFindings, NameWhatStandsTwice) {
    EXPECT_THAT(
        found_in(
            material
            + "\nP3 0 0 0 1 0 0 0 1 0\nP4 0 0 5 1 0 5 1 1 5 0 1 5\nP3 1 0 0 0 1 0 -0 0 0"
              "\nP4 1 1 5 1 0 5 0 0 5 0 1 5\nSP 1 2 3 4\nSP 1 2 3 5\nSP 1 2 3 4"),
        ElementsAre(
            "warning 4: the same face stands in line 2 already",
            "note 5: the same face stands in line 3 already",
            "warning 8: the same sphere stands in line 6 already"));
}

TEST(SolidFindings, NameWhatPassesThroughAndWhatCoincidesInPart) {
    EXPECT_THAT(
        found_in(
            material
            + "\nP4 -2 0 -2  -2 0 2  2 0 2  2 0 -2\nP3 0 -1 0  1 1 0  -1 1 0"
              "\nP4 -1 0 -1  -1 0 1  1 0 1  1 0 -1"),
        ElementsAre(
            "note 3: this face or mesh passes through that of line 2",
            "note 4: this face or mesh passes through that of line 3",
            "note 4: a part of this face or mesh coincides with that of line 2"));
}

TEST(SolidFindings, AreNotMadeOfFacesThatTouch) {
    const std::string beside = "\nP4 1 0.5 0  1 0.5 1  2 0.5 1  2 0.5 0";
    EXPECT_THAT(found_in(material + cube + beside), IsEmpty());
    // Beside each other: the common face stands twice, and is of two solids.
    const std::string next = "\nP3 1 0 0  2 0.5 0.5  1 0 1";
    EXPECT_THAT(found_in(material + cube + next), IsEmpty());
}

TEST(SolidFindings, ReportProgressAndCanBeStopped) {
    SceneFile file = read_text(material + cube);
    number_primitives(file.scene);
    double last = 0;
    solid_findings(file.scene, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(solid_findings(file.scene, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
