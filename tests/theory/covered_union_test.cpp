// SPDX-License-Identifier: Apache-2.0
// What CoveredUnion foretells of its own growth. What it answers is tested by RectangleView.
#include "vera/theory/covered_union.h"
#include "vera/theory/whole_below.h"

#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

PlaceRange any_range(std::int32_t cells, std::mt19937_64& random) {
    const std::int32_t begin = whole_below(cells, random);
    return {begin, begin + 1 + whole_below(cells - begin, random)};
}

TEST(CoveredUnion, GrowsAndReturnsAtMostWhatItForetells) {
    std::mt19937_64 random(7);
    std::size_t times_all_edges = 0;
    std::size_t times_more_than_twice = 0;
    for (int round = 0; round < 400; ++round) {
        const std::int32_t columns = 1 + whole_below(12, random);
        const std::int32_t rows = 1 + whole_below(12, random);
        WindowCounts counts;
        // A coordinate more than cells.
        CoveredUnion covered(columns + 1, rows + 1, counts);
        for (int i = 0; i < 12; ++i) {
            const PlaceRange in_columns = any_range(columns, random);
            const PlaceRange in_rows = any_range(rows, random);
            const BoxMeeting meeting = covered.meeting({{in_columns, in_rows}});
            const std::size_t before = covered.entry_count();
            const std::size_t most = before + covered.most_new_entries(meeting);
            const std::size_t edges = covered.cover(meeting).size();
            ASSERT_LE(edges, meeting.most_edges());
            ASSERT_LE(covered.entry_count(), most);
            times_all_edges += edges > 0 && edges == meeting.most_edges() ? 1 : 0;
            times_more_than_twice += before > 0 && covered.entry_count() > 2 * before ? 1 : 0;
        }
    }
    EXPECT_GT(times_all_edges, 100U);
    EXPECT_GT(times_more_than_twice, 0U); // what is asked for by doubling alone is too little
}

} // namespace
} // namespace vera
