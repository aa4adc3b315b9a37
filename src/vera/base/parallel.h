// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <stdexcept>

namespace vera {

/// Limits, while it lives, how many threads the whole process computes with. 0 means one for each
/// processor that the process may use.
class ThreadLimit {
public:
    explicit ThreadLimit(std::size_t threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    void* control_;
};

/// Calls turn(first, last) for consecutive ranges that together cover [0, count), at most grain
/// long, on all threads. A turn must write only what is its own. An exception from a turn is thrown
/// here.
void parallel_ranges(
    std::size_t count,
    std::size_t grain,
    const std::function<void(std::size_t first, std::size_t last)>& turn);

/// Thrown by long work after its CancelFlag was raised.
class Cancelled : public std::runtime_error {
public:
    Cancelled()
        : std::runtime_error("interrupted") {}
};

/// Lets another thread, or a signal handler, stop long work.
class CancelFlag {
public:
    void raise() noexcept { raised_.store(true, std::memory_order_relaxed); }

    bool raised() const noexcept { return raised_.load(std::memory_order_relaxed); }

    void throw_if_raised() const {
        if (raised())
            throw Cancelled();
    }

private:
    std::atomic<bool> raised_ = false;
    static_assert(std::atomic<bool>::is_always_lock_free, "raise() is called in signal handlers");
};

/// How long work tells how far it is: called now and then, from any thread but never from two at
/// once, with the part that is done, from 0 to 1, never less than before.
using Progress = std::function<void(double done)>;

} // namespace vera
