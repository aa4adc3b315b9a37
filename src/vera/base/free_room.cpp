// SPDX-License-Identifier: Apache-2.0
#include "vera/base/free_room.h"

#include <atomic>
#include <cstddef>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace vera {

namespace {

constexpr int mebibyte = 1 << 20;

std::atomic<bool> gives_back_blocks = false;
std::atomic<bool> spares_memory = false;

} // namespace

void give_back_freed_blocks() {
    gives_back_blocks = true;
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 2 * mebibyte); // which ends that it grows
#endif
}

void spare_memory() {
    if (spares_memory.exchange(true))
        return;
#ifdef __GLIBC__
    if (!gives_back_blocks)
        return;
    mallopt(M_TRIM_THRESHOLD, 4 * mebibyte);
    mallopt(M_TOP_PAD, 4 * mebibyte);
    malloc_trim(0); // what is behind the last block was room for small work
#endif
}

void give_back_freed_memory() {
#ifdef __GLIBC__
    if (spares_memory && mallinfo2().fordblks > (std::size_t{16} << 20U))
        malloc_trim(0);
#endif
}

} // namespace vera
