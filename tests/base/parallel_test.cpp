// SPDX-License-Identifier: Apache-2.0
#include "vera/base/parallel.h"

#include <algorithm>
#include <numeric>
#include <thread>
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

TEST(ParallelRanges, AreTheSameForOneThreadAsForMany) {
    const auto ranges = [](std::size_t threads, std::size_t count, std::size_t grain) {
        const ThreadLimit limit(threads);
        std::vector<std::size_t> ends(count);
        parallel_ranges(
            count, grain, [&](std::size_t first, std::size_t last) { ends[first] = last; });
        return ends;
    };
    for (const std::size_t count : {1U, 2U, 63U, 64U, 65U, 1000U, 4097U})
        for (const std::size_t grain : {1U, 3U, 64U, 4096U})
            EXPECT_EQ(ranges(1, count, grain), ranges(2, count, grain)) << count << " " << grain;
}

TEST(ParallelRanges, KeepToTheSmallestOfTwoLimits) {
    const ThreadLimit one(1);
    const ThreadLimit several(7);
    std::vector<std::thread::id> threads(1000);
    parallel_ranges(threads.size(), 1, [&](std::size_t first, std::size_t) {
        threads[first] = std::this_thread::get_id();
    });
    EXPECT_EQ(
        std::count(threads.begin(), threads.end(), std::this_thread::get_id()),
        static_cast<std::ptrdiff_t>(threads.size()));
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
