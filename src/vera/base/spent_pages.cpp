// SPDX-License-Identifier: Apache-2.0
#include "vera/base/spent_pages.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace vera {

#ifdef __linux__

void give_back_pages(void* begin, void* end) {
    static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const auto address = [](const void* pointer) {
        return reinterpret_cast<std::uintptr_t>(pointer);
    };
    const std::size_t skipped = (page - address(begin) % page) % page;
    const std::size_t bytes = address(end) - address(begin);
    if (bytes < skipped + page)
        return;
    // Other systems' calls of that name may leave what stood there, or take it back later.
    madvise(static_cast<char*>(begin) + skipped, (bytes - skipped) / page * page, MADV_DONTNEED);
}

#else

void give_back_pages(void*, void*) {}

#endif

} // namespace vera
