// SPDX-License-Identifier: Apache-2.0
#include "vera/base/parallel.h"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(ParallelRanges, CoverEveryIndexOnceForAnyNumberOfThreads) {
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const ThreadLimit limit(threads);
        std::vector<int> visits(10'007);
        parallel_ranges(visits.size(), 64, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                ++visits[i];
        });
        EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), 10'007);
    }
}

TEST(ParallelRanges, LetOneLoopSeeWhatTheLastOneWrote) {
    const ThreadLimit limit(7);
    std::vector<std::size_t> values(1000);
    std::vector<std::size_t> copies(1000);
    for (std::size_t round = 0; round < 50; ++round) {
        parallel_ranges(values.size(), 16, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                values[i] = copies[values.size() - 1 - i] + 1;
        });
        parallel_ranges(values.size(), 16, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                copies[i] = values[values.size() - 1 - i];
        });
    }
    EXPECT_EQ(copies, std::vector<std::size_t>(1000, 50));
}

TEST(ParallelRanges, DoNothingForAnEmptyRange) {
    parallel_ranges(0, 64, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelRanges, PassOnAnException) {
    EXPECT_THROW(
        parallel_ranges(100, 1, [](std::size_t, std::size_t) { throw Cancelled(); }), Cancelled);
}

} // namespace
} // namespace vera
