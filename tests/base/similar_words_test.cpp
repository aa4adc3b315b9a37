// SPDX-License-Identifier: Apache-2.0
#include "vera/base/similar_words.h"

#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsChangesAndSwaps) {
    EXPECT_EQ(edit_distance("", ""), 0U);
    EXPECT_EQ(edit_distance("grey", ""), 4U);
    EXPECT_EQ(edit_distance("grey", "gray"), 1U);
    EXPECT_EQ(edit_distance("gery", "grey"), 1U);
    EXPECT_EQ(edit_distance("gry", "grey"), 1U);
    EXPECT_EQ(edit_distance("MIRROR", "mirror"), 0U);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(MostSimilar, FindsAMistypedWordAndLeavesStrangersAlone) {
    const std::vector<std::string> words = {"PROJECTION", "PARALLEL", "LI", "SP", "SSC"};
    EXPECT_EQ(most_similar("PROJETCION", words), "PROJECTION");
    EXPECT_EQ(most_similar("sp", words), "SP");
    EXPECT_EQ(most_similar("SSP", words), "SP");
    EXPECT_EQ(most_similar("banana", words), std::nullopt);
    EXPECT_EQ(most_similar("X", words), std::nullopt);
    EXPECT_EQ(most_similar("", words), std::nullopt);
}

} // namespace
} // namespace vera
