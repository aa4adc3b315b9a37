// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"

#include <algorithm>
#include <cstddef>
#include <ctime>

namespace vera {

/// How long something takes. On one thread it is the processor's time, so that what else the
/// machine does matters less; on several it is the clock's.
class Stopwatch {
public:
    explicit Stopwatch(std::size_t threads)
        : clock_(threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC)
        , start_(now()) {}

    double seconds() const { return now() - start_; }

private:
    double now() const {
        timespec time = {};
        clock_gettime(clock_, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }

    clockid_t clock_;
    double start_;
};

/// The generation that is all rays there are; with several threads, eight for each of them.
constexpr std::size_t whole_generation = 0;

/// Calls turn(first, count) for generations of so many rays that together are all of them, on so
/// many threads: how both sides are asked.
template <typename Turn>
void for_each_generation(
    std::size_t rays, std::size_t generation, std::size_t threads, const Turn& turn) {
    std::size_t size = generation;
    if (generation == whole_generation) {
        // A multiple of the widest packet.
        const std::size_t parts = threads == 1 ? 1 : 8 * threads;
        size = (rays / parts / 16 + 1) * 16;
    }
    const std::size_t turns = (rays + size - 1) / size;
    const auto take_turns = [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            turn(i * size, std::min(size, rays - i * size));
    };
    if (threads == 1)
        take_turns(0, turns);
    else
        parallel_ranges(turns, 1, take_turns);
}

} // namespace vera
