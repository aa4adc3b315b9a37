// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/document_text.h"

#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace vera::detail {
namespace {

using namespace std::string_literals;

TEST(XmlText, EscapesWhatMeansSomething) {
    EXPECT_EQ(xml_text("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; 'd'");
    EXPECT_EQ(xml_text("a\tb\n"), "a&#9;b&#10;"); // an attribute keeps them so
    EXPECT_EQ(xml_text("J\xc3\xb6rg \xf0\x9f\x8e\xa8"), "J\xc3\xb6rg \xf0\x9f\x8e\xa8");
}

TEST(XmlText, ReplacesWhatXmlForbids) {
    const std::string replacement = "\xef\xbf\xbd";
    EXPECT_EQ(xml_text("\0\x1b\r"s), replacement + replacement + replacement);
    for (const std::string& one : {"\xf6"s, "\x80"s, "\xef\xbf\xbf"s, "\xff"s, replacement})
        EXPECT_EQ(xml_text("a" + one + "b"), "a" + replacement + "b");
    for (const std::string& two : {"\xc0\x80"s, "\xc1\xbf"s}) // overlong
        EXPECT_EQ(xml_text(two), replacement + replacement);
    EXPECT_EQ(xml_text("\xed\xa0\x80"), replacement + replacement + replacement); // a surrogate
    EXPECT_EQ(xml_text("\xc3"), replacement);                                     // cut short
    EXPECT_EQ(xml_text("\xc3<"), replacement + "&lt;");
}

TEST(PdfString, IsPlainOrUtf16) {
    EXPECT_EQ(pdf_string("a (b) \\c"), "(a \\(b\\) \\\\c)");
    EXPECT_EQ(pdf_string(""), "()");
    EXPECT_EQ(pdf_string("\xc3\xb6\n"), "<FEFF00F6000A>");
    EXPECT_EQ(pdf_string("\xf0\x9f\x8e\xa8"), "<FEFFD83CDFA8>");
}

TEST(PlainLine, IsOneShortLineOfAscii) {
    EXPECT_EQ(plain_line("a\nb\xc3\xb6"), "a?b?");
    EXPECT_EQ(plain_line(std::string(300, 'x')), std::string(200, 'x'));
}

TEST(UniqueIds, AreNamesAndAreGivenOnce) {
    UniqueIds ids;
    EXPECT_EQ(ids.take("tea pot"), "tea-pot");
    EXPECT_EQ(ids.take("tea-pot"), "tea-pot-2");
    EXPECT_EQ(ids.take("tea-pot-2"), "tea-pot-2-2");
    EXPECT_EQ(ids.take("tea\"pot"), "tea-pot-3");
    EXPECT_EQ(ids.take("7"), "_7");
    EXPECT_EQ(ids.take(""), "_");
    EXPECT_EQ(ids.take("A_1.x"), "A_1.x");
}

TEST(UniqueIds, AreTheFirstThatNoOtherHas) {
    std::mt19937 random(1);
    UniqueIds ids;
    std::set<std::string> given;
    for (int i = 0; i < 2000; ++i) {
        std::string wanted = "a";
        for (auto parts = random() % 3; parts > 0; --parts)
            wanted.append("-").append(std::to_string(2 + random() % 40));
        std::string expected = wanted;
        for (int number = 2; given.contains(expected); ++number)
            expected = std::string(wanted).append("-").append(std::to_string(number));
        EXPECT_EQ(ids.take(wanted), expected);
        given.insert(expected);
    }
}

} // namespace
} // namespace vera::detail
