// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace vera {

/// Empties a vector and gives its memory back, which clear() and = {} do not.
template <typename T, typename Allocator>
void free_room(std::vector<T, Allocator>& vector) {
    std::vector<T, Allocator>().swap(vector);
}

/// From now on the whole process gives back to the system each block of 2 MiB or more as soon as it
/// is freed. (The C library of GNU, if left alone, comes to keep blocks of up to 32 MiB, between
/// others that are in use, for the next ones that fit.)
void give_back_freed_blocks();

/// For work that takes so much memory that it is worth time, before it: give_back_freed_memory()
/// gives something back from now on, and where the process has called give_back_freed_blocks(), no
/// more than 4 MiB are kept behind the last block in use.
void spare_memory();

/// After spare_memory(): gives what was freed, but is kept to be used again, back to the system
/// where it is more than 16 MiB: less is soon used again, and large pages of which a part is given
/// back become small ones. For the moment after much was freed in small blocks, and before much is
/// needed in large ones.
void give_back_freed_memory();

} // namespace vera
