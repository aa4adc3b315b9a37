// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"

#include <cstddef>
#include <mutex>
#include <utility>

namespace vera {

/// Throws Cancelled where there is a flag that is raised.
inline void stop_if_raised(const CancelFlag* cancel) {
    if (cancel != nullptr)
        cancel->throw_if_raised();
}

/// A loop in one thread that takes long: looks at the flag, and tells how far it is, once in so
/// many turns. That is cheap where a turn is: keep `every` a power of two.
class LongLoop {
public:
    explicit LongLoop(
        std::size_t turns,
        Progress progress = {},
        const CancelFlag* cancel = nullptr,
        std::size_t every = 1024)
        : turns_(turns)
        , every_(every)
        , progress_(std::move(progress))
        , cancel_(cancel) {}

    /// At the beginning of each turn, in their order. Throws Cancelled.
    void turn(std::size_t number) const {
        if (number % every_ == 0)
            look(number);
    }

private:
    void look(std::size_t number) const {
        stop_if_raised(cancel_);
        if (progress_)
            progress_(static_cast<double>(number) / static_cast<double>(turns_));
    }

    std::size_t turns_;
    std::size_t every_;
    Progress progress_;
    const CancelFlag* cancel_;
};

/// The same of all threads: calls turn(number) for each number below the count, `every` of which in
/// a row are one thread's. Throws Cancelled.
template <typename Turn>
void long_parallel_loop(
    std::size_t turns,
    const Progress& progress,
    const CancelFlag* cancel,
    std::size_t every,
    const Turn& turn) {
    std::mutex mutex;
    std::size_t done = 0;
    parallel_ranges(turns, every, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t number = first; number < last; ++number)
            turn(number);
        if (!progress)
            return;
        const std::lock_guard lock(mutex);
        done += last - first;
        progress(static_cast<double>(done) / static_cast<double>(turns));
    });
}

} // namespace vera
