// SPDX-License-Identifier: Apache-2.0
// Counts what a program takes by new, and lets it run out. It replaces operator new, and so is
// linked only into programs of their own that ask for it.
#pragma once

#include <cstddef>
#include <new>

#include <gtest/gtest.h>

namespace vera::testing {

/// From when it is made on. One at a time.
class MemoryWatch {
public:
    MemoryWatch();

    /// The most bytes that were held at once beside those of before.
    std::size_t most_bytes() const;

    /// The bytes that are held now beside those of before.
    std::size_t bytes() const;

private:
    std::size_t before_;
};

/// The most bytes that were held at once beside those of before, while the work ran.
template <typename Work>
double most_bytes_of(const Work& work) {
    const MemoryWatch watch;
    work();
    return static_cast<double>(watch.most_bytes());
}

/// Blocks of memory that were given and not given back.
std::size_t held_blocks();

/// While it lives, no more than so many blocks are given.
class MemoryShortage {
public:
    explicit MemoryShortage(std::size_t blocks);
    ~MemoryShortage();
    MemoryShortage(const MemoryShortage&) = delete;
    MemoryShortage& operator=(const MemoryShortage&) = delete;
};

/// Lets memory run out at the first block, and then each time later, while work() makes something
/// and gives it back; next(given) is after how many blocks the next time. Returns how many it takes
/// for all, or more.
template <typename Work, typename Next>
std::size_t expect_nothing_left_behind(const Work& work, const Next& next) {
    work(); // what is made once in a process is made
    const std::size_t before = held_blocks();
    for (std::size_t given = 0;; given = next(given)) {
        bool is_done = false;
        try {
            const MemoryShortage shortage(given);
            work();
            is_done = true;
        } catch (const std::bad_alloc&) { // NOLINT(bugprone-empty-catch)
        }
        EXPECT_EQ(held_blocks(), before) << "memory for " << given << " blocks";
        if (is_done || held_blocks() != before)
            return given;
    }
}

} // namespace vera::testing
