// SPDX-License-Identifier: Apache-2.0
#include "time_limit.h"

#include <chrono>

namespace vera {

TimeLimit::TimeLimit(double seconds, CancelFlag& cancel) {
    if (seconds <= 0)
        return;
    thread_ = std::thread([this, seconds, &cancel] {
        std::unique_lock lock(mutex_);
        const std::chrono::duration<double> time(seconds);
        if (changed_.wait_for(lock, time, [this] { return is_done_; }))
            return;
        is_over_ = true;
        cancel.raise();
    });
}

TimeLimit::~TimeLimit() {
    {
        const std::lock_guard lock(mutex_);
        is_done_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable())
        thread_.join();
}

} // namespace vera
