// SPDX-License-Identifier: Apache-2.0
#include "vera/base/large_pages.h"

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <vector>

#include "base/memory_is_watched.h"
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

#ifdef __GLIBC__
TEST(LargePages, AreWhereTheHeapGoesOn) {
    if (memory_is_watched())
        GTEST_SKIP() << "a sanitizer has a heap of its own";
    begin_heap_in_large_pages();
    // More than other tests may have left free.
    constexpr std::size_t size = 1'500'000;
    constexpr std::uintptr_t large_page = std::uintptr_t{1} << 21;
    const auto block = std::make_unique<std::vector<char>>(size, 'a');
    EXPECT_LT(reinterpret_cast<std::uintptr_t>(block->data()) % large_page, 4096U);
    // There is room for both, so that they lie side by side.
    const auto next = std::make_unique<std::vector<char>>(size, 'b');
    EXPECT_NEAR(static_cast<double>(next->data() - block->data()), size, 4096);
}
#endif

} // namespace
} // namespace vera
