// SPDX-License-Identifier: Apache-2.0
#include "vera/base/large_pages.h"

#include <cerrno>
#include <cstddef>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(LargePages, KeepWhatTheBytesHold) {
    constexpr std::size_t numbers = std::size_t{3} << 19U; // twelve megabytes
    std::vector<std::size_t> written(numbers);
    std::iota(written.begin(), written.end(), std::size_t{1});
    const std::vector<std::size_t> copy = written;
    errno = 5;
    prefer_large_pages(written.data(), written.size() * sizeof(std::size_t), Written::all);
    EXPECT_EQ(errno, 5);
    EXPECT_EQ(written, copy);
}

TEST(LargePages, AreNotAskedForWhereNoneFits) {
    std::vector<int> few(10, 3);
    prefer_large_pages(few.data(), few.size() * sizeof(int), Written::all);
    prefer_large_pages(few.data(), 0, Written::nothing);
    prefer_large_pages(nullptr, 0, Written::nothing);
    EXPECT_EQ(few, std::vector<int>(10, 3));
}

} // namespace
} // namespace vera
