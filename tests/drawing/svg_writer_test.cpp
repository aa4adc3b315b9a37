// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <memory>
#include <utility>

#include "drawing/sample_drawing.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::HasSubstr;
using testing::Not;

const char head[] = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                    "<svg xmlns=\"http://www.w3.org/2000/svg\" "
                    "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" ";

TEST(WriteSvg, HasLayersGroupsSeamsAndLines) {
    EXPECT_EQ(
        written(write_svg, sample_drawing()),
        std::string(head) + R"(width="40" height="30" viewBox="0 0 40 30">
<title>Two &amp; more</title>
<desc>squares</desc>
<style>
.seam{fill:none;stroke-width:2;stroke-linejoin:round}
.line{fill:none;stroke-linecap:round;stroke-linejoin:round}
.hidden-lines{stroke:#000;stroke-width:.5;stroke-linecap:butt;stroke-dasharray:3 2}
.silhouette-lines{stroke:#000;stroke-width:1.5}
</style>
<rect id="background" width="40" height="30" fill="#fff"/>
<g id="fills" inkscape:groupmode="layer" inkscape:label="Fills">
<g id="squares" inkscape:label="squares">
<title>squares</title>
<path id="left" fill="#f00" d="m1 1h10v10h-10zm1 1v1.5h1.25z"><title>a &lt;square&gt;</title></path>
<path class="seam" stroke="#f00" d="m11 1v10"/>
<path fill="#123456" d="m11 1h10v10h-10z"/>
</g>
<path fill="#00f" d="m.5-.25.25.75.75.25z"/>
</g>
<g id="hidden-lines" class="line hidden-lines" inkscape:groupmode="layer" inkscape:label="Hidden lines">
<path d="m0 0 10 5"/>
<path d="m5 5v5"/>
</g>
<g id="silhouette-lines" class="line silhouette-lines" inkscape:groupmode="layer" inkscape:label="Silhouette lines">
<path d="m1 1h20v10h-20z"/>
</g>
</svg>
)");
}

TEST(WriteSvg, DefinesEachGradientOnce) {
    EXPECT_EQ(
        written(write_svg, drawing_of_gradients()),
        std::string(head) + R"svg(width="40" height="30" viewBox="0 0 40 30">
<style>
.seam{fill:none;stroke-width:2;stroke-linejoin:round}
</style>
<defs>
<linearGradient id="g1" gradientUnits="userSpaceOnUse" x1="1" y1="1" x2="11" y2="1"><stop offset="0" stop-color="#f00"/><stop offset="1" stop-color="#00f"/></linearGradient>
<radialGradient id="g2" gradientUnits="userSpaceOnUse" cx="0" cy="0" r="1" gradientTransform="matrix(4 3 -1.5 2 10 20)"><stop offset=".25" stop-color="#fff"/><stop offset=".5" stop-color="#0f0"/><stop offset="1" stop-color="#000"/></radialGradient>
</defs>
<g id="fills" inkscape:groupmode="layer" inkscape:label="Fills">
<path fill="url(#g1)" d="m1 1h5v10h-5z"/>
<path class="seam" stroke="url(#g1)" d="m6 1v10"/>
<path fill="url(#g1)" d="m6 1h5v10h-5z"/>
<path fill="url(#g2)" d="m5 15h10v10h-10z"/>
</g>
</svg>
)svg");
}

TEST(WriteSvg, GivesGradientsADigitMoreThanOutlines) {
    Drawing drawing = drawing_of_gradients();
    drawing.fills[0].gradient->start.x = 1.23456;
    EXPECT_THAT(written(write_svg, drawing), HasSubstr(R"(x1="1.235" y1="1" x2="11.235" y2="1")"));
    EXPECT_THAT(
        written(write_svg, drawing, {.precision = 0.1}),
        HasSubstr(R"(x1="1.23" y1="1" x2="11.23" y2="1")"));
}

TEST(WriteSvg, LeavesNoTraceOfAGradientOfWhichNothingIsLeft) {
    Drawing drawing = drawing_of_gradients();
    drawing.fills.resize(1);
    drawing.fills[0].rings = {{{0, 0}, {1, 0}, {0.5, 0.1}}};
    EXPECT_EQ(
        written(write_svg, drawing, {.precision = 1}),
        written(write_svg, {.width = 40, .height = 30}));
}

TEST(WriteSvg, IsAWholeFileForAnEmptyDrawing) {
    EXPECT_EQ(
        written(write_svg, {}),
        std::string(head) + "width=\"1\" height=\"1\" viewBox=\"0 0 1 1\">\n</svg>\n");
}

TEST(WriteSvg, GivesThePageASizeInMillimetersAndLeavesThePixels) {
    EXPECT_THAT(
        written(write_svg, sample_drawing(), {.page_width_millimeters = 210}),
        HasSubstr("width=\"210mm\" height=\"157.5mm\" viewBox=\"0 0 40 30\""));
}

TEST(WriteSvg, RoundsToThePrecision) {
    EXPECT_THAT(
        written(write_svg, sample_drawing(), {.precision = 0.1}),
        HasSubstr("d=\"m1 1h10v10h-10zm1 1v1.5h1.3z\""));
}

TEST(WriteSvg, LeavesSeamsOpenWhenAsked) {
    EXPECT_THAT(
        written(write_svg, sample_drawing(), {.cover_seams = false}), Not(HasSubstr("seam")));
}

TEST(WriteSvg, LeavesNoTraceOfAGroupOfWhichNothingIsLeft) {
    Drawing drawing;
    drawing.fills = {
        {.id = "a",
         .group = group_named("gone"),
         .rings = {{{0, 0}, {1, 0}, {0.5, 0.1}}},
         .seams = {{{0, 0}, {1, 0}}}}};
    drawing.strokes = {{.line_class = LineClass::hidden, .points = {{0, 0}}}};
    EXPECT_EQ(written(write_svg, drawing, {.precision = 1}), written(write_svg, {}));
}

TEST(WriteSvg, GivesEveryElementAnIdOfItsOwn) {
    Drawing drawing = sample_drawing();
    for (FilledOutline& fill : drawing.fills)
        fill.id = "fills";
    drawing.fills[1].group = group_named("fills");
    const std::string text = written(write_svg, drawing);
    for (const char* id : {"fills", "fills-2", "fills-3", "fills-4", "fills-5"})
        EXPECT_THAT(text, HasSubstr("id=\"" + std::string(id) + "\"")) << id;
    EXPECT_THAT(text, HasSubstr("<g id=\"fills\" inkscape:groupmode"));
}

TEST(WriteSvg, NestsGroupsAndTellsTheirMaterials) {
    const auto car = std::make_shared<const DrawingGroup>(DrawingGroup{.id = "car"});
    const auto part = [&](const char* id, const char* material) {
        return std::make_shared<const DrawingGroup>(DrawingGroup{
            .id = id,
            .name = "a <part>",
            .material = std::make_shared<const DrawingMaterial>(
                DrawingMaterial{.name = material, .css_class = "material-x"}),
            .parent = car});
    };
    const auto square = [](std::shared_ptr<const DrawingGroup> group) {
        return FilledOutline{
            .group = std::move(group), .rings = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}};
    };
    Drawing drawing;
    // Two that are equal are one, though they are not the same.
    drawing.fills = {
        square(part("hood", "red & blue")),
        square(part("hood", "red & blue")),
        square(part("wheel", "")),
        square(car),
        square(part("wheel", "")),
        square({}),
        square(car)};
    const std::string path = "<path fill=\"#000\" d=\"m0 0h1v1h-1z\"/>\n";
    const std::string wheel = " class=\"material-x\" inkscape:label=\"a &lt;part&gt;\">\n"
                              "<title>a &lt;part&gt;</title>\n";
    EXPECT_THAT(
        written(write_svg, drawing),
        HasSubstr(
            "<g id=\"car\">\n<g id=\"hood\" class=\"material-x\" data-material=\"red &amp; blue\" "
            "inkscape:label=\"a &lt;part&gt;\">\n<title>a &lt;part&gt;</title>\n"
            + path + path + "</g>\n<g id=\"wheel\"" + wheel + path + "</g>\n" + path
            + "<g id=\"wheel-2\"" + wheel + path + "</g>\n</g>\n" + path + "<g id=\"car-2\">\n"
            + path + "</g>\n</g>\n</svg>\n"));
}

TEST(WriteSvg, TellsScriptsTheNamesThatGroupsWereGiven) {
    Drawing drawing = sample_drawing();
    drawing.fills[0].group = std::make_shared<const DrawingGroup>(
        DrawingGroup{.id = "object-1", .name = "chair, red", .given = "caf\xC3\xA9 \"\xE9\""});
    EXPECT_THAT(
        written(write_svg, drawing),
        HasSubstr("<g id=\"object-1\" data-name=\"caf\xC3\xA9 &quot;\xEF\xBF\xBD&quot;\" "
                  "inkscape:label=\"chair, red\">\n<title>chair, red</title>\n"));
}

TEST(WriteSvg, PaintsClassesInTheirOrderAndThoseWithoutAStyleAnyhow) {
    Drawing drawing;
    drawing.strokes = {
        {.line_class = LineClass::silhouette, .points = {{0, 0}, {1, 2}}},
        {.line_class = LineClass::crease, .points = {{0, 0}, {1, 1}}},
        {.line_class = LineClass::hidden, .points = {{0, 0}, {2, 1}}}};
    const std::string text = written(
        write_svg,
        drawing,
        {.line_styles = {{.line_class = LineClass::crease, .color = {255, 0, 0}, .width = 3}}});
    EXPECT_THAT(text, HasSubstr(".silhouette-lines{stroke:#000;stroke-width:1}\n"));
    EXPECT_THAT(text, HasSubstr(".crease-lines{stroke:#f00;stroke-width:3}\n"));
    const std::size_t hidden = text.find("<g id=\"hidden-lines\"");
    const std::size_t crease = text.find("<g id=\"crease-lines\"");
    const std::size_t silhouette = text.find("<g id=\"silhouette-lines\"");
    EXPECT_LT(hidden, crease);
    EXPECT_LT(crease, silhouette);
    EXPECT_NE(silhouette, std::string::npos);
}

TEST(WriteSvgDeathTest, RefusesNumbersThatAreNotFinite) {
    Drawing drawing = sample_drawing();
    drawing.fills[0].rings[0][0].x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_DEATH(written(write_svg, drawing), "drawing/snapped_path");
    EXPECT_DEATH(written(write_svg, {.width = 0}), "drawing.width > 0");
    Drawing colorless = drawing_of_gradients();
    colorless.fills[0].gradient->stops.clear();
    EXPECT_DEATH(written(write_svg, colorless), "stops.empty");
}

} // namespace
} // namespace vera
