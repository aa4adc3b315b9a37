// SPDX-License-Identifier: Apache-2.0
#include "vera/base/large_pages.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <thread>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace vera {

namespace {

constexpr std::uintptr_t large_page = std::uintptr_t{1} << 21U;

#if defined(__GLIBC__) && defined(__linux__)

/// From the page in which the first byte lies on, also where no large one is whole: beside what
/// was asked for before, it may be.
void prefer_large_pages_between(std::uintptr_t first, std::uintptr_t last) {
    static const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    first -= first % page;
    const int error_before = errno;
    madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
    errno = error_before;
}

#endif

} // namespace

void prefer_large_pages(const void* first, std::size_t bytes, Written written) noexcept {
#ifdef __linux__
    const auto address = reinterpret_cast<std::uintptr_t>(first);
    const std::uintptr_t before =
        (large_page - address % large_page) % large_page; // up to the first whole one
    if (bytes < before + large_page)
        return;
    const std::size_t whole = (bytes - before) / large_page * large_page;
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

void begin_heap_in_large_pages() noexcept {
#ifdef __GLIBC__
    constexpr int room = 16 * static_cast<int>(large_page);
    constexpr int more_room = 4 * static_cast<int>(large_page);
    constexpr int usual_room = 1 << 17;
    mallopt(M_MMAP_THRESHOLD, static_cast<int>(large_page));
    mallopt(M_TRIM_THRESHOLD, 2 * room); // or the room would be given back with the first block
    mallopt(M_TOP_PAD, room);
    // What lies before the first large page is never written. The first block is more than there is
    // room for yet, so that the second lies behind it. Both are kept, for what looks for lost ones;
    // volatile, or compilers would leave out what is never read. What the heap writes beside both
    // lies before the page as well: a page that is written to before it is asked for stays small.
    constexpr std::uintptr_t beside_both = 32;
    static void* volatile unused = nullptr;
    static void* volatile unused_too = nullptr;
    unused = std::malloc(usual_room);
    const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(unused) + usual_room + beside_both;
    unused_too = std::malloc(large_page - end % large_page);
    if (unused_too != nullptr)
        prefer_large_pages(unused_too, room, Written::nothing);
    mallopt(M_TOP_PAD, more_room); // or it, and the heaps of threads, would grow by small pages
#endif
}

void share_heap_among_threads() noexcept {
#ifdef __GLIBC__
    constexpr unsigned threads_for_a_heap = 4;
    const unsigned heaps = std::thread::hardware_concurrency() / threads_for_a_heap;
    mallopt(M_ARENA_MAX, static_cast<int>(std::max(heaps, 1U)));
#endif
}

void prefer_large_pages_for_block(const void* block, std::size_t bytes) noexcept {
#if defined(__GLIBC__) && defined(__linux__)
    const auto first = reinterpret_cast<std::uintptr_t>(block);
    const std::uintptr_t last = first + bytes;
    // The heap that the process began with lies below all others. It may have become shorter, and
    // be asked again now and then.
    static std::atomic<std::uintptr_t> known_end = 0;
    constexpr std::size_t small = std::size_t{1} << 16U; // these are many
    if (bytes < small && last <= known_end.load(std::memory_order_relaxed))
        return;
    if (bytes >= large_page)
        return prefer_large_pages_between(first, last);
    const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0)); // which asks no system
    if (first < end) {
        const std::uintptr_t before = known_end.exchange(end, std::memory_order_relaxed);
        if (before != 0 && before < end)
            prefer_large_pages_between(before, end);
        return;
    }
    // Heaps of threads; a block of one may be used again by another thread.
    constexpr std::uintptr_t heap_room = std::uintptr_t{1} << 26U; // of GNU's library
    static std::array<std::atomic<std::uintptr_t>, 64> known_heaps = {};
    const std::uintptr_t heap = first / heap_room;
    std::atomic<std::uintptr_t>& known = known_heaps[heap % known_heaps.size()];
    if (known.load(std::memory_order_relaxed) == heap)
        return;
    known.store(heap, std::memory_order_relaxed);
    prefer_large_pages_between(first, (heap + 1) * heap_room);
#else
    (void)block;
    (void)bytes;
#endif
}

} // namespace vera
