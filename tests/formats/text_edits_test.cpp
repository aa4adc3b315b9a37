// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/statement_words.h"
#include "vera/formats/text_edits.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(TextEdits, ReplaceInsertAndLeaveOut) {
    const std::vector<TextEdit> edits =
        in_order({{6, 5, "sea"}, {0, 0, "Oh "}, {5, 1, "-"}, {7, 1, "x"}});
    EXPECT_EQ(edits.size(), 3U); // the last lies within another
    EXPECT_EQ(edited("hello world!", edits), "Oh hello-sea!");
    EXPECT_EQ(edited("abc", {}), "abc");
}

TEST(UnifiedDiff, ShowsThreeLinesAroundAndJoinsWhatIsNear) {
    const std::string text = "1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n11\n12\n13\n14\n15\n";
    EXPECT_EQ(unified_diff(text, {}, "a", "b"), "");
    EXPECT_EQ(
        unified_diff(text, {{8, 1, "five"}}, "a", "b"),
        "--- a\n+++ b\n@@ -2,7 +2,7 @@\n 2\n 3\n 4\n-5\n+five\n 6\n 7\n 8\n");
    EXPECT_EQ(
        unified_diff(text, {{0, 2, ""}, {30, 0, "new\n"}}, "a", "b"),
        "--- a\n+++ b\n@@ -1,4 +1,3 @@\n-1\n 2\n 3\n 4\n@@ -11,5 +10,6 @@\n 11\n 12\n 13\n+new\n "
        "14\n 15\n");
    EXPECT_EQ(
        unified_diff("a\nb", {{2, 1, "c"}}, "x", "y"),
        "--- x\n+++ y\n@@ -1,2 +1,2 @@\n a\n-b\n\\ No newline at end of file\n+c\n\\ No newline at "
        "end of file\n");
    EXPECT_EQ(unified_diff("a\n", {{0, 1, "b"}}, "x", "y"), "--- x\n+++ y\n@@ -1 +1 @@\n-a\n+b\n");
    EXPECT_EQ(unified_diff("", {{0, 0, "b\n"}}, "x", "y"), "--- x\n+++ y\n@@ -0,0 +1 @@\n+b\n");
    EXPECT_EQ(
        unified_diff("a\nb\nc\n", {{0, 1, "d"}, {2, 1, "e"}}, "x", "y"),
        "--- x\n+++ y\n@@ -1,3 +1,3 @@\n-a\n-b\n+d\n+e\n c\n");
}

std::string read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(UnifiedDiff, IsWhatPatchMakesTheEditedTextOf) {
    const std::filesystem::path folder = testing::TempDir();
    std::mt19937 random(6);
    for (int round = 0; round < 30; ++round) {
        std::string text;
        for (std::size_t i = random() % 40; i > 0; --i)
            text += random() % 3 == 0 ? "\n" : random() % 2 == 0 ? "a b\n" : "c\n";
        if (round % 3 == 0)
            text += "end";
        std::vector<TextEdit> edits;
        for (std::size_t i = random() % 5; i > 0; --i) {
            const std::size_t offset = random() % (text.size() + 1);
            edits.push_back(
                {offset,
                 std::min<std::size_t>(random() % 9, text.size() - offset),
                 random() % 2 == 0       ? ""
                     : random() % 2 == 0 ? "x\ny"
                                         : "z"});
        }
        edits = in_order(edits);
        std::ofstream(folder / "before", std::ios::binary) << text;
        std::ofstream(folder / "diff", std::ios::binary)
            << unified_diff(text, edits, "before", "before");
        const std::string command = "cd '" + folder.string()
            + "' && rm -f after before.orig && cp before after && { [ ! -s diff ] || patch -s -f "
              "after diff; }";
        ASSERT_EQ(std::system(command.c_str()), 0) << round << '\n' << read(folder / "diff");
        const std::string after =
            std::filesystem::exists(folder / "after") ? read(folder / "after") : "";
        ASSERT_EQ(after, edited(text, edits)) << round << '\n' << read(folder / "diff");
    }
}

TEST(StatementWords, KnowWordsCommentsAndSections) {
    const std::string text = "(* SP *) IP 1 2(* a\n *)3\nSCENE a SP 0 0 0 1\n  MESH \"P3 x\" SC 2\n"
                             "LI 1 1 1 1 1 1 1 IP 4 5 6 SCENE b IP 7 8 9 (* open";
    const std::vector<StatementWords> statements = statement_words(text);
    std::string seen;
    for (const StatementWords& statement : statements) {
        seen += std::to_string(statement.line) + "/" + std::to_string(statement.section) + ":";
        for (const WordSpan word : statement.words)
            seen += text.substr(word.offset, word.length) + ",";
        seen += ' ';
    }
    EXPECT_EQ(
        seen,
        "1/0:IP,1,2,3, 3/1:SCENE,a, 3/1:SP,0,0,0,1, 4/1:MESH,\"P3 x\",SC,2, 5/0:LI,1,1,1,1,1,1,1, "
        "5/0:IP,4,5,6, 5/2:SCENE,b, 5/2:IP,7,8,9, ");
}

} // namespace
} // namespace vera
