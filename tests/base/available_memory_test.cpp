// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/base/held_memory.h"

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "base/memory_is_watched.h"
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vera {
namespace {

TEST(AvailableMemory, IsSomethingBetweenAMegabyteAndThePhysicalMemory) {
    const auto available = available_memory();
    ASSERT_TRUE(available);
    EXPECT_GT(*available, 1'000'000U);
    EXPECT_LE(
        *available,
        static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES))
            * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)));
}

TEST(AvailableMemory, IsLimitedByTheAddressSpace) {
    constexpr int not_kept = 2;
    const pid_t child = fork();
    if (child == 0) {
        std::uint64_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
        constexpr std::uint64_t room = 16 << 20;
        const rlimit limit = {used + room, RLIM_INFINITY};
        setrlimit(RLIMIT_AS, &limit);
        rlimit kept = {};
        if (getrlimit(RLIMIT_AS, &kept) != 0 || kept.rlim_cur != limit.rlim_cur)
            _exit(not_kept);
        const std::uint64_t available = available_memory().value_or(0);
        _exit(available > 0 && available <= room ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == not_kept)
        GTEST_SKIP() << "limits of the address space are not kept here, as under qemu";
    EXPECT_EQ(status, 0);
}

TEST(AvailableMemory, IsLimitedToWhatIsLeftOfAGivenSize) {
    const std::uint64_t whole = available_memory().value_or(0);
    {
        const MemoryLimit little(1);
        EXPECT_EQ(available_memory(), 0U);
        {
            const MemoryLimit all(~std::uint64_t{0});
            EXPECT_GT(available_memory(), 0U);
        }
        EXPECT_EQ(available_memory(), 0U);
    }
    EXPECT_GT(available_memory().value_or(0), whole / 2);
    constexpr std::uint64_t large = std::uint64_t{1} << 30U;
    const MemoryLimit limit(large);
    EXPECT_LT(available_memory(), large) << "what is held already counts";
}

TEST(AvailableMemory, IsWhatIsFreedAsWellBeforeAnythingIsRefused) {
    if (memory_is_watched())
        GTEST_SKIP() << "a sanitizer keeps memory for itself";
    constexpr std::size_t block = 50'000;
    constexpr std::size_t blocks = 800;
    std::vector<std::unique_ptr<std::vector<char>>> kept;
    for (std::size_t i = 0; i <= blocks; ++i)
        kept.push_back(std::make_unique<std::vector<char>>(block, 'a'));
    for (std::size_t i = 0; i < blocks; ++i) // the last one lies behind all that are freed
        kept[i].reset();
    const MemoryLimit limit(held_memory() + (std::uint64_t{16} << 20U));
    EXPECT_NO_THROW(require_memory(0x1p25, "twice what the limit leaves", "nothing"));
}

TEST(AvailableMemory, IsRequiredWithTheFiguresAndTheRemedy) {
    require_memory(3e6, 3'000'000, "a thing", "take less");
    require_memory(1e300, std::nullopt, "a thing", "take less");
    try {
        require_memory(3.5 * 0x1p20, std::uint64_t{1} << 21U, "a thing", "take less");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(
            error.what(),
            "a thing takes about 4 MiB of memory, and 3 MiB are available: take less");
    }
    const MemoryLimit little(1);
    require_memory(1000, "a trifle", "take less");
    EXPECT_THROW(require_memory(1e8, "a thing", "take less"), std::runtime_error);
}

} // namespace
} // namespace vera
