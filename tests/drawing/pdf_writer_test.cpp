// SPDX-License-Identifier: Apache-2.0
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

/// Without gradients and groups there is a plain table.
Drawing ungrouped_drawing() {
    Drawing drawing = sample_drawing();
    for (FilledOutline& fill : drawing.fills) {
        fill.group = nullptr;
        fill.id.clear();
    }
    return drawing;
}

TEST(WritePdf, HasATableThatLeadsToEveryObject) {
    const std::vector<std::string> found = objects(written(write_pdf, ungrouped_drawing()));
    ASSERT_EQ(found.size(), 9U);
    EXPECT_EQ(
        found[0],
        "<</Type/Catalog/Pages 2 0 R/Metadata 9 0 R/OCProperties<</OCGs[6 0 R 7 0 R 8 0 R]"
        "/D<</Order[6 0 R 7 0 R 8 0 R]/ON[6 0 R 7 0 R 8 0 R]>>>>>>");
    EXPECT_EQ(found[1], "<</Type/Pages/Kids[3 0 R]/Count 1>>");
    EXPECT_EQ(
        found[2],
        "<</Type/Page/Parent 2 0 R/MediaBox[0 0 30 22.5]/Resources<</Properties"
        "<</L0 6 0 R/L1 7 0 R/L2 8 0 R>>>>/Contents 4 0 R>>");
    EXPECT_EQ(found[4], "<</Producer(VERA)/Title(Two & more)/Subject(squares)>>");
    EXPECT_EQ(found[5], "<</Type/OCG/Name(Fills)>>");
    EXPECT_EQ(found[6], "<</Type/OCG/Name(Hidden lines)>>");
    EXPECT_EQ(found[7], "<</Type/OCG/Name(Silhouette lines)>>");
}

TEST(WritePdf, TellsOfItselfInAPacketOfXmp) {
    Drawing drawing = ungrouped_drawing();
    drawing.description = "caf\xC3\xA9 \xFF]]>";
    const std::string object = objects(written(write_pdf, drawing)).back();
    const std::string packet =
        "<?xpacket begin=\"\xEF\xBB\xBF\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n"
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n"
        "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n"
        "<rdf:Description rdf:about=\"\"\n"
        " xmlns:dc=\"http://purl.org/dc/elements/1.1/\"\n"
        " xmlns:pdf=\"http://ns.adobe.com/pdf/1.3/\"\n"
        " xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\">\n"
        "<dc:format>application/pdf</dc:format>\n"
        "<dc:title><rdf:Alt><rdf:li xml:lang=\"x-default\">Two &amp; more</rdf:li></rdf:Alt>"
        "</dc:title>\n"
        "<dc:description><rdf:Alt><rdf:li xml:lang=\"x-default\">caf\xC3\xA9 \xEF\xBF\xBD]]&gt;"
        "</rdf:li></rdf:Alt></dc:description>\n"
        "<xmp:CreatorTool>VERA</xmp:CreatorTool>\n"
        "<pdf:Producer>VERA</pdf:Producer>\n"
        "</rdf:Description>\n"
        "</rdf:RDF>\n"
        "</x:xmpmeta>\n"
        "<?xpacket end=\"r\"?>";
    EXPECT_EQ(
        object,
        fmt::format(
            "<</Type/Metadata/Subtype/XML/Length {}>>\nstream\n{}\nendstream",
            packet.size(),
            packet));
}

TEST(WritePdf, LeavesOutOfThePacketWhatItDoesNotKnow) {
    const std::string object = objects(written(write_pdf, {})).back();
    EXPECT_THAT(object, HasSubstr("<pdf:Producer>VERA</pdf:Producer>"));
    EXPECT_THAT(object, Not(HasSubstr("dc:title")));
    EXPECT_THAT(object, Not(HasSubstr("dc:description")));
}

TEST(WritePdf, PaintsInWholeNumbers) {
    const std::vector<std::string> found = objects(written(write_pdf, ungrouped_drawing()));
    ASSERT_EQ(found.size(), 9U);
    EXPECT_EQ(inflated(found[3]), R"(q
.0075 0 0 -.0075 0 22.5 cm
1 1 1 rg
0 0 4000 3000 re
f
/OC /L0 BDC
200 w 0 J 1 j [] 0 d
1 0 0 rg
100 100 m
1100 100 l
1100 1100 l
100 1100 l
h
200 200 m
200 350 l
325 350 l
h
f
1 0 0 RG
1100 100 m
1100 1100 l
S
.071 .204 .337 rg
1100 100 m
2100 100 l
2100 1100 l
1100 1100 l
h
f
0 0 1 rg
50 -25 m
75 50 l
150 75 l
h
f
EMC
/OC /L1 BDC
50 w 0 J 1 j [300 200] 0 d
0 0 0 RG
0 0 m
1000 500 l
S
500 500 m
500 1000 l
S
EMC
/OC /L2 BDC
150 w 1 J 1 j [] 0 d
100 100 m
2100 100 l
2100 1100 l
100 1100 l
h
S
EMC
Q
)");
}

TEST(WritePdf, HasShadingsAsPatterns) {
    const std::vector<std::string> found =
        objects_by_stream(written(write_pdf, drawing_of_gradients()));
    ASSERT_EQ(found.size(), 11U);
    EXPECT_THAT(found[2], HasSubstr("/Pattern<</P0 8 0 R/P1 9 0 R>>"));
    EXPECT_EQ(inflated(found[3]), R"(q
.75 0 0 -.75 0 22.5 cm
/OC /L0 BDC
2 w 0 J 1 j [] 0 d
/Pattern cs /P0 scn
1 1 m
6 1 l
6 11 l
1 11 l
h
f
/Pattern CS /P0 SCN
6 1 m
6 11 l
S
6 1 m
11 1 l
11 11 l
6 11 l
h
f
/Pattern cs /P1 scn
5 15 m
15 15 l
15 25 l
5 25 l
h
f
EMC
Q
)");
    EXPECT_EQ(
        found[7],
        "<</PatternType 2/Shading<</ShadingType 2/ColorSpace/DeviceRGB/Coords[0 0 1 0]"
        "/Extend[true true]/Function<</FunctionType 2/Domain[0 1]/C0[1 0 0]/C1[0 0 1]/N 1>>>>"
        "/Matrix[7.5 0 0 -7.5 .75 21.75]>>");
    EXPECT_EQ(
        found[8],
        "<</PatternType 2/Shading<</ShadingType 3/ColorSpace/DeviceRGB/Coords[0 0 0 0 0 1]"
        "/Extend[true true]/Function<</FunctionType 3/Domain[0 1]/Functions["
        "<</FunctionType 2/Domain[0 1]/C0[1 1 1]/C1[1 1 1]/N 1>>"
        "<</FunctionType 2/Domain[0 1]/C0[1 1 1]/C1[0 1 0]/N 1>>"
        "<</FunctionType 2/Domain[0 1]/C0[0 1 0]/C1[0 0 0]/N 1>>]"
        "/Bounds[.25 .5]/Encode[0 1 0 1 0 1]>>>>/Matrix[3 -2.25 -1.125 -1.5 7.5 7.5]>>");
}

// Poppler paints no gradient where a page is scaled to less than a thousandth.
TEST(WritePdf, ScalesPagesWithGradientsTheSameAtEveryPrecision) {
    Drawing drawing = drawing_of_gradients();
    drawing.fills[0].rings[0][1] = {6.12345678, -0.5};
    const std::string text =
        inflated(objects_by_stream(written(write_pdf, drawing, {.precision = 1e-6}))[3]);
    EXPECT_THAT(text, HasSubstr("q\n.75 0 0 -.75 0 22.5 cm\n"));
    EXPECT_THAT(text, HasSubstr("\n1 1 m\n6.123457 -.5 l\n6 11 l\n"));
}

TEST(WritePdf, IsAWholeFileForAnEmptyDrawing) {
    const std::vector<std::string> found = objects(written(write_pdf, {}));
    ASSERT_EQ(found.size(), 6U);
    EXPECT_EQ(found[0], "<</Type/Catalog/Pages 2 0 R/Metadata 6 0 R>>");
    EXPECT_EQ(inflated(found[3]), "q\n.0075 0 0 -.0075 0 .75 cm\nQ\n");
    EXPECT_EQ(found[4], "<</Producer(VERA)>>");
}

TEST(WritePdf, GivesThePageASizeInMillimeters) {
    const std::vector<std::string> found =
        objects(written(write_pdf, ungrouped_drawing(), {.page_width_millimeters = 25.4}));
    ASSERT_EQ(found.size(), 9U);
    EXPECT_THAT(found[2], HasSubstr("/MediaBox[0 0 72 54]"));
    EXPECT_THAT(inflated(found[3]), HasSubstr("\n.018 0 0 -.018 0 54 cm\n"));
}

TEST(WritePdf, CountsFromItsOwnBeginning) {
    std::string bytes = "before";
    write_pdf(sample_drawing(), {}, bytes);
    EXPECT_EQ(bytes.substr(6), written(write_pdf, sample_drawing()));
}

TEST(WritePdf, HasAnIdOfItsContent) {
    const auto id = [](const std::string& pdf) { return pdf.substr(pdf.find("/ID[<") + 5, 32); };
    const std::string pdf = written(write_pdf, sample_drawing());
    EXPECT_EQ(id(pdf), id(written(write_pdf, sample_drawing())));
    Drawing other = sample_drawing();
    other.fills[0].rings[0][0].x = 0;
    EXPECT_NE(id(pdf), id(written(write_pdf, other)));
    EXPECT_THAT(pdf, Not(HasSubstr("Date")));
}

} // namespace
} // namespace vera
