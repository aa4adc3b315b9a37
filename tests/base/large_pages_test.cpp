// SPDX-License-Identifier: Apache-2.0
#include "vera/base/large_pages.h"

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <thread>
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

TEST(LargePages, OfBlocksLeaveWhatTheBlocksHold) {
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{70'000}, std::size_t{5'000'000}}) {
        const std::unique_ptr<char, decltype(&std::free)> block(
            static_cast<char*>(std::malloc(bytes + 1)), &std::free);
        for (std::size_t i = 0; i < bytes; ++i)
            block.get()[i] = static_cast<char>(i % 100);
        errno = 5;
        prefer_large_pages_for_block(block.get(), bytes);
        EXPECT_EQ(errno, 5);
        for (std::size_t i = 0; i < bytes; ++i)
            ASSERT_EQ(block.get()[i], static_cast<char>(i % 100));
    }
}

#ifdef __GLIBC__
/// What the system knows of the pages around the address, as /proc/self/smaps tells it; or nothing.
std::string flags_of_pages_at(const void* place) {
    const auto address = reinterpret_cast<std::uintptr_t>(place);
    std::ifstream pages("/proc/self/smaps");
    bool is_here = false;
    for (std::string line; std::getline(pages, line);) {
        std::istringstream words(line);
        std::uintptr_t first = 0;
        std::uintptr_t last = 0;
        char dash = 0;
        if (words >> std::hex >> first >> dash >> last && dash == '-')
            is_here = first <= address && address < last;
        if (is_here && line.starts_with("VmFlags:"))
            return line + " ";
    }
    return {};
}

TEST(LargePages, AreAskedForWhereABlockIsLarge) {
    if (memory_is_watched())
        GTEST_SKIP() << "a sanitizer has a heap of its own";
    if (!std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"))
        GTEST_SKIP() << "this system has no large pages";
    constexpr std::size_t bytes = std::size_t{40} << 20U; // never a part of the heap
    const std::unique_ptr<void, decltype(&std::free)> block(std::malloc(bytes), &std::free);
    prefer_large_pages_for_block(block.get(), bytes);
    const std::string flags = flags_of_pages_at(block.get());
    if (flags.empty())
        GTEST_SKIP() << "this system does not tell";
    EXPECT_NE(flags.find(" hg "), std::string::npos) << flags;
}

TEST(LargePages, AreAskedForWhereAThreadHasAHeap) {
    if (memory_is_watched())
        GTEST_SKIP() << "a sanitizer has a heap of its own";
    if (!std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"))
        GTEST_SKIP() << "this system has no large pages";
    const auto flags_behind_block = [] {
        constexpr std::size_t bytes = 1000;
        const std::unique_ptr<char, decltype(&std::free)> block(
            static_cast<char*>(std::malloc(bytes)), &std::free);
        prefer_large_pages_for_block(block.get(), bytes);
        return flags_of_pages_at(block.get() + bytes + 4096);
    };
    std::string flags;
    std::thread([&] { flags = flags_behind_block(); }).join();
    if (flags.empty())
        GTEST_SKIP() << "this system does not tell";
    EXPECT_NE(flags.find(" hg "), std::string::npos) << flags;
}

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
