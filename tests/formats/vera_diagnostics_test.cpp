// SPDX-License-Identifier: Apache-2.0
#include "formats/read_text.h"
#include <gtest/gtest.h>

namespace vera {

namespace {

/// A text with something wrong, within a scene where it stands in line 2 and nothing else is wrong,
/// and all that is said of it.
struct Mistake {
    const char* name;
    std::string text;
    std::string said;
};

const std::vector<Mistake>& mistakes() {
    // clang-format off
    static const std::vector<Mistake> list = {
    {"ANumberThatIsNoNumber",
     "SP 0 0 blue 1",
     "test.vera:2:8: error: expected the z of the sphere's center, found 'blue'\n"
     "    SP 0 0 blue 1\n"
     "           ^~~~\n"},
    {"ALetterInPlaceOfADigit",
     "RS 0 0 0 P 0 0 1 AN O O GE 1 O",
     "test.vera:2:21: error: expected a number, found 'O'; did you mean 0?\n"
     "    RS 0 0 0 P 0 0 1 AN O O GE 1 O\n"
     "                        ^\n"
     "  it is the r where the contour begins\n"},
    {"ADecimalComma",
     "SP 1,5 2 3 1",
     "test.vera:2:4: error: expected a number, found '1,5'; did you mean 1.5?\n"
     "    SP 1,5 2 3 1\n"
     "       ^~~\n"
     "  it is the x of the sphere's center\n"},
    {"ANumberThatIsTooLarge",
     "SP 1 2 3 1e999",
     "test.vera:2:10: error: the number '1e999' is too large\n"
     "    SP 1 2 3 1e999\n"
     "             ^~~~~\n"
     "  the largest number is about 1.8e308\n"},
    {"InfinityAndNoNumber",
     "SP inf 0 0 1\n"
            "SP nan 0 0 1",
     "test.vera:2:4: error: expected the x of the sphere's center, found 'inf'\n"
     "    SP inf 0 0 1\n"
     "       ^~~\n"
     "test.vera:3:4: error: expected the x of the sphere's center, found 'nan'\n"
     "    SP nan 0 0 1\n"
     "       ^~~\n"},
    {"AStatementThatEndsTooSoon",
     "P4 0 0 0 1 0 0 1 1 0\n"
            "P3 0 0 0 1 0 0 0 1 0",
     "test.vera:3:1: error: expected the x of the fourth corner, found 'P3'\n"
     "    P3 0 0 0 1 0 0 0 1 0\n"
     "    ^~\n"},
    {"TooManyNumbers",
     "SP 0 0 0 1 5 6",
     "test.vera:2:12: error: expected a statement, found '5'\n"
     "    SP 0 0 0 1 5 6\n"
     "               ^\n"
     "  the SP before it is complete\n"},
    {"AMisspeltKeyword",
     "SPH 0 0 0 1",
     "test.vera:2:1: error: expected a statement, found 'SPH'; did you mean 'SP'?\n"
     "    SPH 0 0 0 1\n"
     "    ^~~\n"},
    {"AKeywordInSmallLetters",
     "sp 0 0 0 1\n"
            "SP 0 0 0 x\n"
            "p3 0 0 0 1 0 0 0 1 0",
     "test.vera:2:1: error: expected a statement, found 'sp'; did you mean 'SP'?\n"
     "    sp 0 0 0 1\n"
     "    ^~\n"
     "test.vera:3:10: error: expected the sphere's radius, found 'x'\n"
     "    SP 0 0 0 x\n"
     "             ^\n"
     "test.vera:4:1: error: expected a statement, found 'p3'; did you mean 'P3'?\n"
     "    p3 0 0 0 1 0 0 0 1 0\n"
     "    ^~\n"},
    {"AMisspeltKeywordBehindAnotherMistake",
     "SP 0 0 0 x\n"
            "SPP 0 0 0 1\n"
            "P4 0 0 0 y\n"
            "9 9 9 DRF\n"
            "DRF 1 1 1",
     "test.vera:2:10: error: expected the sphere's radius, found 'x'\n"
     "    SP 0 0 0 x\n"
     "             ^\n"
     "test.vera:3:1: error: expected a statement, found 'SPP'; did you mean 'SP'?\n"
     "    SPP 0 0 0 1\n"
     "    ^~~\n"
     "test.vera:4:10: error: expected the x of the second corner, found 'y'\n"
     "    P4 0 0 0 y\n"
     "             ^\n"},
    {"APartOfAnotherStatement",
     "SP 0 0 0 1 DRF 1 1 1",
     "test.vera:2:12: error: expected a statement, found 'DRF'\n"
     "    SP 0 0 0 1 DRF 1 1 1\n"
     "               ^~~\n"
     "  DRF is a part of other statements\n"},
    {"KeywordsOfControlFiles",
     "RASTER 5 5 SHADOWS\n"
            "SKY 1 1 1",
     "test.vera:2:1: error: expected a statement, found 'RASTER'\n"
     "    RASTER 5 5 SHADOWS\n"
     "    ^~~~~~\n"
     "  RASTER belongs in the control file (-c FILE)\n"
     "test.vera:3:1: error: expected a statement, found 'SKY'\n"
     "    SKY 1 1 1\n"
     "    ^~~\n"
     "  SKY belongs in the control file (-c FILE)\n"},
    {"AMisspeltProperty",
     "MA other DRF 1 1 1 DFR 1 1 1",
     "test.vera:2:20: error: expected a statement, found 'DFR'; did you mean 'DRF'?\n"
     "    MA other DRF 1 1 1 DFR 1 1 1\n"
     "                       ^~~\n"},
    {"AMisspeltPieceOfAContour",
     "RS 0 0 0 V 0 0 1 AN 0 0 GE 1 0 ge 1 1",
     "test.vera:2:32: error: expected a statement, found 'ge'; did you mean 'GE'?\n"
     "    RS 0 0 0 V 0 0 1 AN 0 0 GE 1 0 ge 1 1\n"
     "                                   ^~\n"},
    {"ABadRadius",
     "SP 0 0 0 -1 SP 0 0 0 0",
     "test.vera:2:10: error: the sphere's radius is -1, but must be positive\n"
     "    SP 0 0 0 -1 SP 0 0 0 0\n"
     "             ^~\n"
     "  write it without its sign: the surface is the same\n"
     "test.vera:2:22: error: the sphere's radius is 0, but must be positive\n"
     "    SP 0 0 0 -1 SP 0 0 0 0\n"
     "                         ^\n"},
    {"AnUndefinedMaterial",
     "CM mm",
     "test.vera:2:4: error: there is no material 'mm'; did you mean 'm'?\n"
     "    CM mm\n"
     "       ^~\n"
     "  define it, anywhere in the text, by MA mm\n"},
    {"AnUndefinedSubscene",
     "SSC base SCENE bass SP 0 0 0 1 LI 0 0 0 1 1 1 1",
     "test.vera:2:5: error: there is no subscene 'base'; did you mean 'bass'?\n"
     "    SSC base SCENE bass SP 0 0 0 1 LI 0 0 0 1 1 1 1\n"
     "        ^~~~\n"
     "  define it, anywhere in the text, by SCENE base\n"},
    {"AMaterialDefinedTwice",
     "MA m DRF 1 1 1",
     "test.vera:2:4: error: material 'm' is defined twice\n"
     "    MA m DRF 1 1 1\n"
     "       ^\n"
     "  the first definition is at test.vera:1\n"},
    {"ASubsceneDefinedTwice",
     "SSC s SCENE s SP 0 0 0 1 SCENE s SP 0 0 0 2 LI 0 0 0 1 1 1 1",
     "test.vera:2:32: error: subscene 's' is defined twice\n"
     "    SSC s SCENE s SP 0 0 0 1 SCENE s SP 0 0 0 2 LI 0 0 0 1 1 1 1\n"
     "                                   ^\n"
     "  the first definition is at test.vera:2\n"},
    {"APropertyGivenTwice",
     "MA n DRF 1 1 1\n"
            "SPC 1 DRF 1 1 1 CM n",
     "test.vera:3:7: error: DRF is given twice for material 'n'\n"
     "    SPC 1 DRF 1 1 1 CM n\n"
     "          ^~~\n"
     "  the first stands in line 2\n"},
    {"AnUnusedMaterial",
     "MA n DRF 1 1 1",
     "test.vera:2:4: warning: material 'n' is never used\n"
     "    MA n DRF 1 1 1\n"
     "       ^\n"},
    {"AMaterialThatNoSurfaceHas",
     "CM n\n"
            "CM m SP 0 0 0 1\n"
            " MA n DRF 1 1 1",
     "test.vera:4:5: warning: material 'n' is never used\n"
     "     MA n DRF 1 1 1\n"
     "        ^\n"
     "  no surface follows the CM at test.vera:2\n"},
    {"AnUnusedSubscene",
     "SCENE s SP 0 0 0 1 LI 0 0 0 1 1 1 1",
     "test.vera:2:7: warning: subscene 's' is never used\n"
     "    SCENE s SP 0 0 0 1 LI 0 0 0 1 1 1 1\n"
     "          ^\n"},
    {"AnImpossibleCosine",
     "MA n SPC 1.5 CM n",
     "test.vera:2:10: error: SPC is 1.5, but is a cosine, from -1 to 1\n"
     "    MA n SPC 1.5 CM n\n"
     "             ^~~\n"
     "  near 1 the highlight is small and sharp\n"},
    {"AnImpossibleIndexOfRefraction",
     "MA n REF 0 CM n",
     "test.vera:2:10: error: REF is 0, but an index of refraction is positive\n"
     "    MA n REF 0 CM n\n"
     "             ^\n"
     "  glass has about 1.5, water 1.33\n"},
    {"AKeywordForAName",
     "CM SP 0 0 0 1 MA DRF DRF 1 1 1",
     "test.vera:2:4: error: expected the name of a material, found 'SP'\n"
     "    CM SP 0 0 0 1 MA DRF DRF 1 1 1\n"
     "       ^~\n"
     "  that is a word of the language; names of small letters never are\n"
     "test.vera:2:18: error: expected the name of the material, found 'DRF'\n"
     "    CM SP 0 0 0 1 MA DRF DRF 1 1 1\n"
     "                     ^~~\n"
     "  that is a word of the language; names of small letters never are\n"},
    {"AWordThatIsNoName",
     "CM 9a",
     "test.vera:2:4: error: expected the name of a material, found '9a'\n"
     "    CM 9a\n"
     "       ^~\n"
     "  names are a letter, then letters, digits, '_' and '-'\n"},
    {"ProjectionGivenTwice",
     "PROJECTION 0 0 9 -1 -1 0 1 -1 0 -1 1 0",
     "test.vera:2:1: error: PROJECTION is given twice\n"
     "    PROJECTION 0 0 9 -1 -1 0 1 -1 0 -1 1 0\n"
     "    ^~~~~~~~~~\n"
     "  a scene has one view; the first is at test.vera:1\n"},
    {"ProjectionAndParallel",
     "PARALLEL 0 0 1 -1 -1 0 1 -1 0 -1 1 0",
     "test.vera:2:1: error: PROJECTION and PARALLEL are both given\n"
     "    PARALLEL 0 0 1 -1 -1 0 1 -1 0 -1 1 0\n"
     "    ^~~~~~~~\n"
     "  a scene has one view; the first is at test.vera:1\n"},
    {"APictureOnOneLine",
     "PARALLEL 0 0 1 0 0 0 1 0 0 2 0 0",
     "test.vera:2:1: error: the corners of the picture are on one line\n"
     "    PARALLEL 0 0 1 0 0 0 1 0 0 2 0 0\n"
     "    ^~~~~~~~\n"
     "  the picture is what lies between the lower left, lower right and upper left corners\n"},
    {"AViewPointInThePicture",
     "PROJECTION 0.1 0.1 0 -1 -1 0 1 -1 0 -1 1 0",
     "test.vera:2:1: error: the view point lies in the plane of the picture\n"
     "    PROJECTION 0.1 0.1 0 -1 -1 0 1 -1 0 -1 1 0\n"
     "    ^~~~~~~~~~\n"
     "  move it to the front, away from the picture\n"},
    {"RaysWithinThePicture",
     "PARALLEL 1 1 0 -1 -1 0 1 -1 0 -1 1 0\n"
            "PARALLEL 0 0 0 -1 -1 0 1 -1 0 -1 1 0",
     "test.vera:2:1: error: the view rays run in the plane of the picture\n"
     "    PARALLEL 1 1 0 -1 -1 0 1 -1 0 -1 1 0\n"
     "    ^~~~~~~~\n"
     "  the direction leads from the viewer through the picture\n"
     "test.vera:3:1: error: the direction of the view rays is 0 0 0\n"
     "    PARALLEL 0 0 0 -1 -1 0 1 -1 0 -1 1 0\n"
     "    ^~~~~~~~\n"
     "  the direction leads from the viewer through the picture\n"},
    {"CrossingSides",
     "P4 0 0 0 1 1 0 1 0 0 0 1 0",
     "test.vera:2:1: error: the sides from corner 1 to 2 and from corner 3 to 4 cross\n"
     "    P4 0 0 0 1 1 0 1 0 0 0 1 0\n"
     "    ^~\n"
     "  give the corners in their order round the face\n"},
    {"CrossingSidesOfAPolygon",
     "PN 5 0 0 0 2 0 0 0 1 0 1 2 0 1 -1 0",
     "test.vera:2:1: error: the sides from corner 1 to 2 and from corner 4 to 5 cross\n"
     "    PN 5 0 0 0 2 0 0 0 1 0 1 2 0 1 -1 0\n"
     "    ^~\n"
     "  give the corners in their order round the polygon\n"},
    {"APolygonThatIsNotPlane",
     "PN 4 0 0 0 1 0 0 1 1 0.1 0 1 0",
     "test.vera:2:1: error: the polygon's corners are not in one plane\n"
     "    PN 4 0 0 0 1 0 0 1 1 0.1 0 1 0\n"
     "    ^~\n"
     "  they may be off it by a millionth of the polygon's size; split it into plane ones\n"},
    {"TooFewCorners",
     "PN 2 0 0 0 1 0 0",
     "test.vera:2:4: error: expected the number of corners, a whole number from 3 to 4294967295, found '2'\n"
     "    PN 2 0 0 0 1 0 0\n"
     "       ^\n"},
    {"PartOfACorner",
     "PN 3.5 0 0 0 1 0 0",
     "test.vera:2:4: error: expected the number of corners, a whole number from 3 to 4294967295, found '3.5'\n"
     "    PN 3.5 0 0 0 1 0 0\n"
     "       ^~~\n"},
    {"AQuadrangleThatIsNotPlane",
     "P4 0 0 0 1 0 0 1 1 1 0 1 0",
     "test.vera:2:1: warning: the corners are not in one plane: split into p1 p2 p3 and p1 p3 p4\n"
     "    P4 0 0 0 1 0 0 1 1 1 0 1 0\n"
     "    ^~\n"
     "  write two P3 to say where the fold is\n"},
    {"FacesWithoutArea",
     "P3 0 0 0 1 1 1 2 2 2\n"
            "P4 0 0 0 1 0 0 2 0 0 3 0 0\n"
            "PN 3 0 0 0 0 0 0 1 1 1\n"
            "PA 0 0 0 0 0 0 0 0 0 0 0 1 0 0 1 0 0 1",
     "test.vera:2:1: warning: this triangle has no area and is left out\n"
     "    P3 0 0 0 1 1 1 2 2 2\n"
     "    ^~\n"
     "test.vera:3:1: warning: this quadrangle has no area and is left out\n"
     "    P4 0 0 0 1 0 0 2 0 0 3 0 0\n"
     "    ^~\n"
     "test.vera:4:1: warning: this polygon has no area and is left out\n"
     "    PN 3 0 0 0 0 0 0 1 1 1\n"
     "    ^~\n"
     "test.vera:5:1: warning: this patch has no area and is left out\n"
     "    PA 0 0 0 0 0 0 0 0 0 0 0 1 0 0 1 0 0 1\n"
     "    ^~\n"},
    {"AnInnerPointInTheFace",
     "IP 5 5 0 P3 0 0 0 1 0 0 0 1 0",
     "test.vera:2:10: warning: the inner point lies in the plane of this face and is ignored\n"
     "    IP 5 5 0 P3 0 0 0 1 0 0 0 1 0\n"
     "             ^~\n"
     "  give IP a point inside the solid, off all its faces\n"},
    {"AnInnerPointOnTheWrongSide",
     "IP -1 0 0 P3 0 0 0 0 1 0 0 0 1\n"
            "P3 0 0 0 1 0 0 0 1 0",
     "test.vera:2:11: warning: the inner point is on the wrong side of this face: all other faces with the same inner point are on the other side\n"
     "    IP -1 0 0 P3 0 0 0 0 1 0 0 0 1\n"
     "              ^~\n"
     "  move IP to the inside of the solid\n"
     "test.vera:3:1: warning: the inner point lies in the plane of this face and is ignored\n"
     "    P3 0 0 0 1 0 0 0 1 0\n"
     "    ^~\n"
     "  give IP a point inside the solid, off all its faces\n"},
    {"AnAxisWithoutDirection",
     "RS 1 2 3 P 1 2 3 AN 0 0 GE 1 0\n"
            "RS 1 2 3 V 0 0 0 AN 0 0 GE 1 0",
     "test.vera:2:10: error: the tip of the axis is its base, so that it has no direction\n"
     "    RS 1 2 3 P 1 2 3 AN 0 0 GE 1 0\n"
     "             ^\n"
     "  the tip only gives the direction: any other point of the axis will do\n"
     "test.vera:3:10: error: the direction of the axis is 0 0 0\n"
     "    RS 1 2 3 V 0 0 0 AN 0 0 GE 1 0\n"
     "             ^\n"},
    {"AnAxisWithoutPOrV",
     "RS 1 2 3 4 5 6 AN 0 0 GE 1 0",
     "test.vera:2:10: error: expected P and the tip of the axis, or V and its direction, found '4'\n"
     "    RS 1 2 3 4 5 6 AN 0 0 GE 1 0\n"
     "             ^\n"},
    {"AContourWithoutBeginning",
     "RS 1 2 3 V 0 0 1 GE 1 0",
     "test.vera:2:18: error: expected AN, which begins the contour, found 'GE'\n"
     "    RS 1 2 3 V 0 0 1 GE 1 0\n"
     "                     ^~\n"},
    {"AContourOfOnePoint",
     "RS 1 2 3 V 0 0 1 AN 1 0",
     "test.vera:2:18: warning: this contour has no pieces, so that there is no surface\n"
     "    RS 1 2 3 V 0 0 1 AN 1 0\n"
     "                     ^~\n"
     "  go on with GE, KR, KE or KU\n"},
    {"PiecesWithoutArea",
     "RS 1 2 3 V 0 0 1 AN 1 0 GE 1 0 GE 0 0 GE 0 5 GE 1 5",
     "test.vera:2:25: warning: this piece of the contour has no area and is left out\n"
     "    RS 1 2 3 V 0 0 1 AN 1 0 GE 1 0 GE 0 0 GE 0 5 GE 1 5\n"
     "                            ^~\n"
     "  a contour need not be closed along the axis\n"
     "test.vera:2:39: warning: this piece of the contour has no area and is left out\n"
     "    RS 1 2 3 V 0 0 1 AN 1 0 GE 1 0 GE 0 0 GE 0 5 GE 1 5\n"
     "                                          ^~\n"
     "  a contour need not be closed along the axis\n"},
    {"ANegativeDistanceFromTheAxis",
     "RS 0 0 0 V 0 0 1 AN -1 0 GE 1 1",
     "test.vera:2:21: error: the r where the contour begins is -1, but distances from the axis are not negative\n"
     "    RS 0 0 0 V 0 0 1 AN -1 0 GE 1 1\n"
     "                        ^~\n"
     "  the contour is one half of the outline; the other half follows from it\n"},
    {"AnArcThroughPointsOnALine",
     "RS 0 0 0 V 0 0 1 AN 0 0 KR 1 1 2 2",
     "test.vera:2:25: error: the arc's three points are on one line, so that no circle passes through them\n"
     "    RS 0 0 0 V 0 0 1 AN 0 0 KR 1 1 2 2\n"
     "                            ^~\n"
     "  write GE for a straight line; make a whole circle of two arcs\n"},
    {"AWeightThatIsNotPositive",
     "RS 0 0 0 V 0 0 1 AN 1 0 KE 2 1 0 1 2",
     "test.vera:2:32: error: the weight of the control point is 0, but must be positive\n"
     "    RS 0 0 0 V 0 0 1 AN 1 0 KE 2 1 0 1 2\n"
     "                                   ^\n"
     "  below 1 the arc is part of an ellipse, at 1 a parabola, above 1 a hyperbola\n"},
    {"AControlPointOnTheChord",
     "RS 0 0 0 V 0 0 1 AN 1 0 KE 1 1 1 1 2",
     "test.vera:2:25: error: the arc's control point is on one line with its ends\n"
     "    RS 0 0 0 V 0 0 1 AN 1 0 KE 1 1 1 1 2\n"
     "                            ^~\n"
     "  write GE for a straight line\n"},
    {"ACurveThatCrossesTheAxis",
     "RS 0 0 0 V 0 0 1 AN 1 0 KU -9 1 -9 2 1 3\n"
            "RS 0 0 0 V 0 0 1 AN 1 0 KE -9 1 1 1 3\n"
            "RS 0 0 0 V 0 0 1 AN 1 0 KR 0 0.1 1 3",
     "test.vera:2:25: error: the curve crosses the axis: r is negative along a part of it\n"
     "    RS 0 0 0 V 0 0 1 AN 1 0 KU -9 1 -9 2 1 3\n"
     "                            ^~\n"
     "  end it at r = 0, or move its inner points away from the axis\n"
     "test.vera:3:25: error: the curve crosses the axis: r is negative along a part of it\n"
     "    RS 0 0 0 V 0 0 1 AN 1 0 KE -9 1 1 1 3\n"
     "                            ^~\n"
     "  end it at r = 0, or move its inner points away from the axis\n"
     "test.vera:4:25: error: the curve crosses the axis: r is negative along a part of it\n"
     "    RS 0 0 0 V 0 0 1 AN 1 0 KR 0 0.1 1 3\n"
     "                            ^~\n"
     "  end it at r = 0, or move its inner points away from the axis\n"},
    {"ASingularTransformation",
     "SSC s SC 0\n"
            "SSC s TR 1 1 1 MX 1 0 0 0 1 0 0 0 0 0 1 0\n"
            "SCENE s SP 0 0 0 1 LI 0 0 0 1 1 1 1",
     "test.vera:2:7: error: singular transformation: it flattens everything\n"
     "    SSC s SC 0\n"
     "          ^~\n"
     "  no factor of scaling and no row or column of a matrix may vanish\n"
     "test.vera:3:16: error: singular transformation: it flattens everything\n"
     "    SSC s TR 1 1 1 MX 1 0 0 0 1 0 0 0 0 0 1 0\n"
     "                   ^~\n"
     "  no factor of scaling and no row or column of a matrix may vanish\n"},
    {"ASubsceneThatCallsItself",
     "SSC a SCENE a SP 0 0 0 1 SSC a LI 0 0 0 1 1 1 1",
     "test.vera:2:1: error: subscene 'a' calls itself\n"
     "    SSC a SCENE a SP 0 0 0 1 SSC a LI 0 0 0 1 1 1 1\n"
     "    ^~~\n"},
    {"ASubsceneThatCallsItselfThroughOthers",
     "SSC a SCENE a SSC b\n"
            "SCENE b SSC c TR 1 0 0\n"
            "SCENE c SSC a LI 0 0 0 1 1 1 1",
     "test.vera:4:9: error: subscene 'a' calls itself through 'b' and 'c'\n"
     "    SCENE c SSC a LI 0 0 0 1 1 1 1\n"
     "            ^~~\n"},
    {"ACommentWithinAComment",
     "(* a (* b *)",
     "test.vera:2:6: warning: '(*' inside the comment that begins in line 2\n"
     "    (* a (* b *)\n"
     "         ^~\n"
     "  comments do not nest: both end at the next '*)'\n"},
    {"ACommentThatIsNeverClosed",
     "SP 0 0 (* the radius",
     "test.vera:2:8: error: this comment is never closed\n"
     "    SP 0 0 (* the radius\n"
     "           ^~\n"
     "  write '*)' where it ends\n"},
    {"AFileThatIsNotThere",
     "INCLUDE \"no-such-file.vera\"",
     "test.vera:2:9: error: there is no file 'no-such-file.vera'\n"
     "    INCLUDE \"no-such-file.vera\"\n"
     "            ^~~~~~~~~~~~~~~~~~~\n"
     "  files are looked for in the folder of the file that names them\n"},
    {"AFileNameWithoutQuotes",
     "MESH bunny.ply",
     "test.vera:2:6: error: expected a file name in double quotes, found 'bunny.ply'\n"
     "    MESH bunny.ply\n"
     "         ^~~~~~~~~\n"
     "  for example \"bunny.ply\"\n"},
    {"AFileNameThatIsNotClosed",
     "INCLUDE \"a.vera",
     "test.vera:2:9: error: this file name is never closed\n"
     "    INCLUDE \"a.vera\n"
     "            ^~~~~~~\n"
     "  write '\"' behind it, in the same line\n"},
    {"AFileNameOfNothing",
     "INCLUDE \"\"",
     "test.vera:2:9: error: expected the name of a file, found none between the quotes\n"
     "    INCLUDE \"\"\n"
     "            ^~\n"},
    {"BinaryJunk",
     std::string("\x01\x02\xff\xfe\x00 SP 0 0 0 \x80\x81", 17),
     "test.vera:2:1: error: expected a statement, found '\\x01\\x02\\xff\\xfe\\x00'\n"
     "    ????? SP 0 0 0 ??\n"
     "    ^~~~~\n"
     "  the MA before it is complete\n"
     "test.vera:2:16: error: expected the sphere's radius, found '\\x80\\x81'\n"
     "    ????? SP 0 0 0 ??\n"
     "                   ^~\n"},
    };
    // clang-format on
    return list;
}

TEST(VeraDiagnostics, SayOnceWhereAndWhatIsWrongAndReadOn) {
    for (const Mistake& mistake : mistakes())
        EXPECT_EQ(said_of(within_scene(mistake.text)), mistake.said) << mistake.name;
}

TEST(VeraDiagnostics, TellOfThingsWithoutMaterialOnce) {
    EXPECT_EQ(
        said_of("SP 0 0 0 1\nSP 0 0 0 2 SSC s\nSCENE s CM m SP 0 0 0 1 SCENE t SP 0 0 0 1\n"
                "MA m SP 0 0 0 3 SSC t CM m SP 0 0 0 1"),
        "test.vera:1:1: warning: this and 3 more statements have no material and get DRF 0.7 0.7 "
        "0.7\n"
        "    SP 0 0 0 1\n"
        "    ^~\n"
        "  write CM and the name of a material before it\n");
    EXPECT_EQ(
        said_of("(* x *) SP 0 0 0 1"),
        "test.vera:1:9: warning: this has no material and gets DRF 0.7 0.7 0.7\n"
        "    (* x *) SP 0 0 0 1\n"
        "            ^~\n"
        "  write CM and the name of a material before it\n");
}

TEST(VeraDiagnostics, TellOfAnEmptyScene) {
    EXPECT_EQ(
        said_of(" (* nothing *) "),
        "test.vera: warning: the scene has no geometry: there is nothing to be seen\n");
}

TEST(VeraDiagnostics, EndAfterFiftyErrors) {
    std::string text;
    for (int i = 0; i < 1000; ++i)
        text += "SP 0 0 x 1\n";
    try {
        read_text(text);
        FAIL();
    } catch (const InputError& error) {
        ASSERT_EQ(error.diagnostics().size(), 51U);
        EXPECT_EQ(error.diagnostics().back().severity, Severity::note);
        EXPECT_EQ(error.diagnostics().back().problem, "reading ended after 50 errors");
        EXPECT_EQ(error.diagnostics()[49].place.line, 50U);
    }
}

TEST(VeraDiagnostics, CountManyWarningsOfAKind) {
    std::string text;
    for (int i = 0; i < 1000; ++i)
        text += "P3 0 0 0 1 1 1 2 2 2\n";
    const SceneFile file = read_text(within_scene(text));
    ASSERT_EQ(file.warnings.size(), 11U);
    EXPECT_EQ(to_text(file.warnings.back()), "test.vera: warning: 990 more faces without area\n");
}

TEST(VeraDiagnostics, SeeCrossingsThroughCorners) {
    // Corner 5 lies on the side from 1 to 2, and the polygon goes on to its other side.
    EXPECT_NE(
        said_of(within_scene("PN 6 0 0 0 4 0 0 4 3 0 2 3 0 2 0 0 1 -2 0")).find("cross"),
        std::string::npos);
    // It only touches the side, and goes back.
    EXPECT_EQ(said_of(within_scene("PN 6 0 0 0 4 0 0 4 3 0 2 3 0 2 0 0 1 3 0")), "");
    // Two ways through the same corner, crossing and not.
    EXPECT_NE(
        said_of(within_scene("PN 6 0 0 0 1 1 0 2 2 0 2 0 0 1 1 0 0 2 0")).find("cross"),
        std::string::npos);
    EXPECT_EQ(said_of(within_scene("PN 6 0 0 0 2 0 0 1 1 0 2 2 0 0 2 0 1 1 0")), "");
}

TEST(VeraDiagnostics, FindCrossingsInPolygonsOfManySidesInTime) {
    std::string corners;
    constexpr int teeth = 20'000;
    for (int i = 0; i < teeth; ++i)
        corners += std::to_string(i) + " 1 0 " + std::to_string(i) + ".5 2 0\n";
    const std::string closed = corners + std::to_string(teeth) + " 0 0 0 0 0";
    EXPECT_EQ(said_of(within_scene("PN " + std::to_string(2 * teeth + 2) + " " + closed)), "");
    const std::string crossing = corners + std::to_string(teeth) + " 0 0 0 1.5 0";
    EXPECT_NE(
        said_of(within_scene("PN " + std::to_string(2 * teeth + 2) + " " + crossing)).find("cross"),
        std::string::npos);
}

TEST(VeraDiagnostics, EndPolygonsWhoseCheckWouldTakeTooLong) {
    // A zigzag along a diagonal: every side overlaps every other along both axes, and none cross.
    const std::string text =
        "PN 8  -9 -9 0  0.1 -0.1 0  9.2 8.8 0  0.3 -0.3 0  9.4 8.6 0  0.5 -0.5 0  "
        "9.6 8.4 0  0.7 -0.7 0";
    EXPECT_EQ(said_of(within_scene(text)), "");
    EXPECT_EQ(
        said_of(within_scene(text), {.side_pairs = 10}),
        "test.vera:2:1: error: so many of the polygon's sides lie side by side that checking "
        "whether they cross takes too long\n"
        "    "
            + text
            + "\n"
              "    ^~\n"
              "  split it into several\n");
}

TEST(VeraDiagnostics, TellOfMoreThanASceneCanNumber) {
    EXPECT_EQ(said_of(within_scene("SP 0 0 0 2"), {.items = 2}), "");
    EXPECT_EQ(
        said_of(within_scene("SP 0 0 0 2\n SP 0 0 0 3"), {.items = 2}),
        "test.vera:4:1: error: more than 2 primitives or corners in one scene or subscene\n"
        "    SP 0 0 0 1\n"
        "    ^~\n"
        "  move parts of it into subscenes and call them\n");
    EXPECT_EQ(
        said_of(within_scene("P4 0 0 0 1 0 0 1 1 0 0 1 0"), {.items = 3}),
        "test.vera:2:1: error: more than 3 primitives or corners in one scene or subscene\n"
        "    P4 0 0 0 1 0 0 1 1 0 0 1 0\n"
        "    ^~\n"
        "  move parts of it into subscenes and call them\n"
        "test.vera:3:1: error: more than 3 primitives or corners in one scene or subscene\n"
        "    SP 0 0 0 1\n"
        "    ^~\n"
        "  move parts of it into subscenes and call them\n");
    EXPECT_EQ(SceneLimits().items, 4'294'967'294U);
}

TEST(VeraDiagnostics, JudgeInnerPointsTheSameInAnyUnitOfLength) {
    for (const char* unit : {"e-30", "", "e30"}) {
        std::string text = "IP 0.25U 0.25U 1U P3 0 0 0 1U 0 0 0 1U 0\n"
                           "P3 0 0 0 0 0 -1U 1U 0 0 P3 0 0 0 0 1U 0 0 0 -1U";
        for (std::size_t at = text.find('U'); at != std::string::npos; at = text.find('U'))
            text.replace(at, 1, unit);
        EXPECT_NE(said_of(within_scene(text)).find("2:"), std::string::npos) << unit;
        EXPECT_NE(said_of(within_scene(text)).find("wrong side"), std::string::npos) << unit;
    }
}

} // namespace
} // namespace vera
