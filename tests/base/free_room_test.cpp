// SPDX-License-Identifier: Apache-2.0
#include "vera/base/free_room.h"

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <vector>

#include "base/memory_is_watched.h"
#include <gtest/gtest.h>
#include <unistd.h>

namespace vera {
namespace {

TEST(FreeRoom, LeavesNoRoomInAVector) {
    std::vector<int> vector(1000);
    vector = {};
    EXPECT_EQ(vector.capacity(), 1000U) << "that is why";
    free_room(vector);
    EXPECT_EQ(vector.capacity(), 0U);
}

/// Bytes of memory that this process has.
double held_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t address_space = 0;
    std::uint64_t pages = 0;
    statm >> address_space >> pages;
    return static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

TEST(FreeRoom, OfFreedBlocksBetweenOthersIsGivenBack) {
    if (memory_is_watched())
        GTEST_SKIP() << "a sanitizer keeps memory for itself";
    give_back_freed_blocks();
    constexpr std::size_t block = std::size_t{1} << 22;
    constexpr std::size_t blocks = 20;
    std::vector<std::unique_ptr<std::vector<char>>> kept;
    for (std::size_t i = 0; i < blocks; ++i) // C libraries learn from what is freed
        kept.push_back(std::make_unique<std::vector<char>>(block, 'a'));
    kept.clear();
    const double before = held_bytes();
    for (std::size_t i = 0; i < blocks; ++i)
        kept.push_back(std::make_unique<std::vector<char>>(block, 'a'));
    EXPECT_GT(held_bytes() - before, 0.9 * blocks * block);
    for (std::size_t i = 0; i < blocks; i += 2)
        kept[i].reset();
    EXPECT_LT(held_bytes() - before, 0.6 * blocks * block);
}

TEST(FreeRoom, OfManySmallBlocksIsGivenBackWhereMemoryIsSpared) {
    if (memory_is_watched())
        GTEST_SKIP() << "a sanitizer keeps memory for itself";
    spare_memory();
    constexpr std::size_t block = 50'000;
    constexpr std::size_t blocks = 800;
    const double before = held_bytes();
    std::vector<std::unique_ptr<std::vector<char>>> kept;
    for (std::size_t i = 0; i <= blocks; ++i)
        kept.push_back(std::make_unique<std::vector<char>>(block, 'a'));
    for (std::size_t i = 0; i < blocks; ++i) // the last one lies behind all that are freed
        kept[i].reset();
    EXPECT_GT(held_bytes() - before, 0.9 * blocks * block);
    give_back_freed_memory();
    EXPECT_LT(held_bytes() - before, 0.1 * blocks * block);
}

} // namespace
} // namespace vera
