// SPDX-License-Identifier: Apache-2.0
#include "vera/base/large_pages.h"

#include <cerrno>
#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace vera {

void prefer_large_pages(const void* first, std::size_t bytes, Written written) noexcept {
#ifdef __linux__
    constexpr std::uintptr_t page = std::uintptr_t{1} << 21U;
    const auto address = reinterpret_cast<std::uintptr_t>(first);
    const std::uintptr_t before = (page - address % page) % page; // up to the first whole one
    if (bytes < before + page)
        return;
    const std::size_t whole = (bytes - before) / page * page;
    void* const place = static_cast<char*>(const_cast<void*>(first)) + before;
    const int error_before = errno; // where it is not granted, nobody need know
    if (madvise(place, whole, MADV_HUGEPAGE) == 0 && written == Written::all) {
        // Moved at once where the system is new enough for that.
        constexpr int collapse = 25; // MADV_COLLAPSE, of Linux 6.1
        (void)madvise(place, whole, collapse);
    }
    errno = error_before;
#else
    (void)first;
    (void)bytes;
    (void)written;
#endif
}

} // namespace vera
