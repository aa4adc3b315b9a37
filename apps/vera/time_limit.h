// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "command.h"

namespace vera {

/// When so many seconds have gone by, unless it is gone before, raises the console's flag; 0:
/// never. Where nothing looks at that, as while a scene is read, it ends the process with the
/// message.
class TimeLimit {
public:
    TimeLimit(double seconds, std::string message, Console& console);
    ~TimeLimit();
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;

    /// Whether it was this that raised the flag.
    bool is_over() const { return is_over_; }

    const std::string& message() const { return message_; }

    /// From now on there is none.
    void end();

private:
    void watch(double seconds, Console& console);

    std::string message_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool is_done_ = false;
    std::atomic<bool> is_over_ = false;
    std::thread thread_;
};

} // namespace vera
