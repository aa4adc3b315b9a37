// SPDX-License-Identifier: Apache-2.0
#include "vera/base/large_pages.h"

#include <cerrno>
#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace vera {

void prefer_large_pages(const void* first, std::size_t bytes) noexcept {
#ifdef __linux__
    constexpr std::uintptr_t page = std::uintptr_t{1} << 21U;
    const auto begin = (reinterpret_cast<std::uintptr_t>(first) + page - 1) & ~(page - 1);
    const auto end = (reinterpret_cast<std::uintptr_t>(first) + bytes) & ~(page - 1);
    if (begin >= end)
        return;
    void* const place = reinterpret_cast<void*>(begin);
    const int error_before = errno; // where it is not granted, nobody need know
    if (madvise(place, end - begin, MADV_HUGEPAGE) == 0) {
        // What was written already is moved at once where the system is new enough for that.
        constexpr int collapse = 25; // MADV_COLLAPSE, of Linux 6.1
        (void)madvise(place, end - begin, collapse);
    }
    errno = error_before;
#else
    (void)first;
    (void)bytes;
#endif
}

} // namespace vera
