// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/reserve_room.h"

#include <cstdint>

#include <sys/mman.h>
#include <unistd.h>

namespace vera {

void prefer_large_pages(void* memory, std::size_t size) {
    // The last large page may stay empty but for a few bytes: at most an eighth of the whole.
    constexpr std::size_t worth_it = 16'000'000;
    if (size < worth_it)
        return;
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(memory) % page) % page;
    // A wish: what becomes of it shows in nothing but time.
    madvise(static_cast<char*>(memory) + before, (size - before) / page * page, MADV_HUGEPAGE);
}

} // namespace vera
