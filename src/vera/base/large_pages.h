// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace vera {

/// What of the bytes is in memory already.
enum class Written { all, nothing };

/// Asks the system to keep these bytes in large pages, so that the processor finds them faster
/// where they are read all over the place, and fewer pages are handed out where they are first
/// written. Nothing but speed follows from it, and it may not be granted. Bytes that are written
/// already are moved; those that are not take memory only when they are.
void prefer_large_pages(const void* first, std::size_t bytes, Written written) noexcept;

/// For a program to call first: lets the heap go on at the start of a large page, with room for
/// fifteen, each of which is taken when it is first written. Otherwise a page of 4 KiB is taken at
/// a time, and to be handed a few hundred of them is a large part of the time of a small picture.
/// Blocks of less than 2 MiB come from there; larger ones are given back to the system as soon as
/// they are freed. Nothing is done where the C library is not GNU's.
void begin_heap_in_large_pages() noexcept;

/// For threads that ask for few blocks, before they start: a thread that finds the heap taken waits
/// for it, where it would otherwise begin one of its own, in small pages. Four threads share one at
/// least.
void share_heap_among_threads() noexcept;

/// Asks for large pages for a block that malloc() has just made: for a program's operator new. Of a
/// smaller block than 2 MiB they are asked for the heap that it lies in, where that is a thread's
/// or has grown.
void prefer_large_pages_for_block(const void* block, std::size_t bytes) noexcept;

} // namespace vera
