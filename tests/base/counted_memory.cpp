// SPDX-License-Identifier: Apache-2.0
#include "base/counted_memory.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace {

std::atomic<std::size_t> taken = 0;
std::atomic<std::size_t> most_taken = 0;

} // namespace

// Not inlined: the compiler would see that what new gives was not made by new.
[[gnu::noinline]] void* operator new(std::size_t size) {
    void* memory = std::malloc(size);
    if (memory == nullptr)
        throw std::bad_alloc();
    const std::size_t now = taken += malloc_usable_size(memory);
    std::size_t most = most_taken;
    while (now > most && !most_taken.compare_exchange_weak(most, now)) {
    }
    return memory;
}

[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    try {
        return operator new(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

[[gnu::noinline]] void operator delete(void* memory) noexcept {
    if (memory != nullptr)
        taken -= malloc_usable_size(memory);
    std::free(memory);
}

void operator delete(void* memory, std::size_t /*size*/) noexcept {
    operator delete(memory);
}

namespace vera::testing {

MemoryWatch::MemoryWatch()
    : before_(taken) {
    most_taken = before_;
}

std::size_t MemoryWatch::most_bytes() const {
    return most_taken - before_;
}

} // namespace vera::testing
