// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace vera {

/// Raises the flag when so many seconds have gone by, unless it is gone before; 0: never.
class TimeLimit {
public:
    TimeLimit(double seconds, CancelFlag& cancel);
    ~TimeLimit();
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;

    /// Whether it was this that raised the flag.
    bool is_over() const { return is_over_; }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool is_done_ = false;
    std::atomic<bool> is_over_ = false;
    std::thread thread_;
};

} // namespace vera
