// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(Diagnostic, ShowsPlaceLineCaretAndRemedy) {
    const Diagnostic diagnostic = {
        .severity = Severity::error,
        .place = {"still_life.vera", 2, 9},
        .problem = "expected the z of the sphere's center, found 'blue'",
        .remedy = "write a number",
        .line = "SP 55 25 blue",
        .length = 4};
    EXPECT_EQ(
        to_text(diagnostic),
        "still_life.vera:2:9: error: expected the z of the sphere's center, found 'blue'\n"
        "    SP 55 25 blue\n"
        "            ^~~~\n"
        "  write a number\n");
}

TEST(Diagnostic, NamesOnlyTheFileWhenNoLineIsMeant) {
    const Diagnostic diagnostic = {
        .severity = Severity::warning, .place = {"a.vera"}, .problem = "no light"};
    EXPECT_EQ(to_text(diagnostic), "a.vera: warning: no light\n");
}

TEST(Diagnostic, ShowsAVeryLongLineInPartAndNoControlCharacters) {
    Diagnostic diagnostic = {
        .place = {"a", 1, 5000}, .problem = "p", .line = std::string(9000, '1')};
    diagnostic.line[4999] = '\x1b';
    const std::string text = to_text(diagnostic);
    EXPECT_LT(text.size(), 400U);
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

TEST(Diagnostic, PutsTheCaretBelowTheWordAfterTextThatIsNotAscii) {
    const Diagnostic diagnostic = {
        .place = {"a", 1, 22}, .problem = "p", .line = "(* Schöne äöü *) blüht", .length = 6};
    EXPECT_EQ(
        to_text(diagnostic),
        "a:1:22: error: p\n"
        "    (* Schöne äöü *) blüht\n"
        "                     ^~~~~\n");
}

TEST(Diagnostic, CutsNoCharacterOfALongLineInTwo) {
    Diagnostic diagnostic = {.place = {"a", 1, 0}, .problem = "p"};
    for (int i = 0; i < 200; ++i)
        diagnostic.line += "€";
    for (const std::uint64_t column : {301U, 302U, 303U}) {
        diagnostic.place.column = column;
        const std::string text = to_text(diagnostic);
        const std::size_t begin = text.find("\n    ") + 5;
        const std::string shown = text.substr(begin, text.find('\n', begin) - begin);
        EXPECT_EQ(shown.substr(0, 3), "€") << column;
        EXPECT_EQ(shown.substr(shown.size() - 3), "€") << column;
        EXPECT_EQ(shown.size() % 3, 0U) << column;
    }
}

TEST(InputError, SaysTheFirstErrorAndKeepsAll) {
    const InputError error(
        {{.severity = Severity::warning, .place = {"a", 1, 1}, .problem = "w"},
         {.severity = Severity::error, .place = {"a", 2, 3}, .problem = "e"}});
    EXPECT_STREQ(error.what(), "a:2:3: e");
    EXPECT_EQ(error.diagnostics().size(), 2U);
}

} // namespace
} // namespace vera
