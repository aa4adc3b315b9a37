// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "drawing/sample_drawing.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(WriteDrawing, WritesTheSameBytesTwice) {
    std::string name = (fs::temp_directory_path() / "vera-drawing-XXXXXX").native();
    const fs::path folder = mkdtemp(name.data());
    const std::pair<DrawingFormat, std::string> expected[] = {
        {DrawingFormat::svg, written(write_svg, sample_drawing())},
        {DrawingFormat::pdf, written(write_pdf, sample_drawing())},
        {DrawingFormat::eps, written(write_eps, sample_drawing())},
        {DrawingFormat::dxf, written(write_dxf, sample_drawing())}};
    for (const auto& [format, bytes] : expected) {
        write_drawing(sample_drawing(), folder / "a", format);
        std::ifstream file(folder / "a", std::ios::binary);
        EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), bytes);
    }
    fs::remove_all(folder);
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
