// SPDX-License-Identifier: Apache-2.0
// The program's operator new: to be handed pages of 4 KiB one by one is a large part of the time of
// a drawing, whose stages each fill lists of their own.
#include "vera/base/large_pages.h"

#include <cstddef>
#include <cstdlib>
#include <new>

void* operator new(std::size_t bytes) {
    const std::size_t least = bytes == 0 ? 1 : bytes; // no two blocks have one address
    void* block = std::malloc(least);
    while (block == nullptr) {
        const std::new_handler make_room = std::get_new_handler();
        if (make_room == nullptr)
            throw std::bad_alloc();
        make_room();
        block = std::malloc(least);
    }
    vera::prefer_large_pages_for_block(block, bytes);
    return block;
}

void operator delete(void* block) noexcept {
    std::free(block);
}

void operator delete(void* block, std::size_t) noexcept {
    std::free(block);
}
