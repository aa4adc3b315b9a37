// SPDX-License-Identifier: Apache-2.0
#include "vera/base/free_room.h"

#include <cstddef>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace vera {

void give_back_freed_blocks() {
#ifdef __GLIBC__
    constexpr int mebibyte = 1 << 20;
    mallopt(M_MMAP_THRESHOLD, 2 * mebibyte); // which ends that it grows
    mallopt(M_TRIM_THRESHOLD, 4 * mebibyte);
#endif
}

void give_back_freed_memory() {
#ifdef __GLIBC__
    constexpr std::size_t little = std::size_t{16} << 20U;
    if (mallinfo2().fordblks > little)
        malloc_trim(0);
#endif
}

} // namespace vera
