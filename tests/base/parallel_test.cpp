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

TEST(ParallelRanges, DoNothingForAnEmptyRange) {
    parallel_ranges(0, 64, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelRanges, PassOnAnException) {
    EXPECT_THROW(
        parallel_ranges(100, 1, [](std::size_t, std::size_t) { throw Cancelled(); }), Cancelled);
}

} // namespace
} // namespace vera
