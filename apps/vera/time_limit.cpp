// SPDX-License-Identifier: Apache-2.0
#include "time_limit.h"

#include <chrono>
#include <utility>

#include "interrupt.h"

namespace vera {

TimeLimit::TimeLimit(double seconds, std::string message, Console& console)
    : message_(std::move(message)) {
    if (seconds > 0)
        thread_ = std::thread([this, seconds, &console] { watch(seconds, console); });
}

TimeLimit::~TimeLimit() {
    end();
}

void TimeLimit::end() {
    {
        const std::lock_guard lock(mutex_);
        is_done_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable())
        thread_.join();
}

void TimeLimit::watch(double seconds, Console& console) {
    std::unique_lock lock(mutex_);
    const auto is_done = [this] { return is_done_; };
    if (changed_.wait_for(lock, std::chrono::duration<double>(seconds), is_done))
        return;
    is_over_ = true;
    console.cancel.raise();
    // Work that looks at the flag may end before it sees it, and other work follow.
    do {
        if (!work_looks_at_the_flag())
            end_process(message_, ExitCode::machine_failed, console);
    } while (!changed_.wait_for(lock, std::chrono::milliseconds(20), is_done));
}

} // namespace vera
