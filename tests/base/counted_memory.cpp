// SPDX-License-Identifier: Apache-2.0
#include "base/counted_memory.h"

#include <atomic>
#include <cstdlib>

#include <malloc.h>

namespace {

constexpr long without_end = -1;

/// How many more blocks are given.
std::atomic<long> blocks_left = without_end;
std::atomic<std::size_t> blocks = 0;
std::atomic<std::size_t> taken = 0;
std::atomic<std::size_t> most_taken = 0;

bool may_be_given() {
    long left = blocks_left;
    while (left > 0 && !blocks_left.compare_exchange_weak(left, left - 1)) {
    }
    return left != 0;
}

/// Nothing where there is none.
void* block_of(std::size_t size, std::size_t alignment) noexcept {
    // aligned_alloc wants whole multiples, and there are no blocks of no bytes.
    const std::size_t whole =
        (size / alignment + (size % alignment != 0 || size == 0 ? 1 : 0)) * alignment;
    void* const block = may_be_given() ? std::aligned_alloc(alignment, whole) : nullptr;
    if (block == nullptr)
        return nullptr;
    ++blocks;
    const std::size_t now = taken += malloc_usable_size(block);
    std::size_t most = most_taken;
    while (now > most && !most_taken.compare_exchange_weak(most, now)) {
    }
    return block;
}

// Not inlined: the compiler would see that what new gives was not made by new.
[[gnu::noinline]] void* block_or_throw(std::size_t size, std::size_t alignment) {
    void* const block = block_of(size, alignment);
    if (block == nullptr)
        throw std::bad_alloc();
    return block;
}

[[gnu::noinline]] void give_back(void* block) noexcept {
    if (block == nullptr)
        return;
    --blocks;
    taken -= malloc_usable_size(block);
    std::free(block); // NOLINT
}

constexpr std::size_t usual_alignment = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

} // namespace

// All forms that are used: those that are left out may not call these, under AddressSanitizer.
void* operator new(std::size_t size) {
    return block_or_throw(size, usual_alignment);
}

void* operator new[](std::size_t size) {
    return block_or_throw(size, usual_alignment);
}

void* operator new(std::size_t size, std::align_val_t alignment) {
    return block_or_throw(size, static_cast<std::size_t>(alignment));
}

void* operator new[](std::size_t size, std::align_val_t alignment) {
    return block_or_throw(size, static_cast<std::size_t>(alignment));
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return block_of(size, usual_alignment);
}

void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return block_of(size, usual_alignment);
}

void operator delete(void* block) noexcept {
    give_back(block);
}

void operator delete[](void* block) noexcept {
    give_back(block);
}

void operator delete(void* block, std::size_t) noexcept {
    give_back(block);
}

void operator delete[](void* block, std::size_t) noexcept {
    give_back(block);
}

void operator delete(void* block, std::align_val_t) noexcept {
    give_back(block);
}

void operator delete[](void* block, std::align_val_t) noexcept {
    give_back(block);
}

void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
    give_back(block);
}

void operator delete[](void* block, std::size_t, std::align_val_t) noexcept {
    give_back(block);
}

void operator delete(void* block, const std::nothrow_t&) noexcept {
    give_back(block);
}

void operator delete[](void* block, const std::nothrow_t&) noexcept {
    give_back(block);
}

namespace vera::testing {

MemoryWatch::MemoryWatch()
    : before_(taken) {
    most_taken = before_;
}

std::size_t MemoryWatch::most_bytes() const {
    return most_taken - before_;
}

std::size_t MemoryWatch::bytes() const {
    return taken - before_;
}

std::size_t held_blocks() {
    return blocks;
}

MemoryShortage::MemoryShortage(std::size_t blocks) {
    blocks_left = static_cast<long>(blocks);
}

MemoryShortage::~MemoryShortage() {
    blocks_left = without_end;
}

} // namespace vera::testing
