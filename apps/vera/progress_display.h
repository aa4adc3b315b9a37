// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "command.h"

namespace vera {

/// Shows on stderr how far a stage of long work is: a bar with the time that is left, on a
/// terminal, or JSON lines for programs. The bar appears only when the stage takes longer than half
/// a second, and is gone when the display is.
class ProgressDisplay {
public:
    ProgressDisplay(const Console& console, std::string stage);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    /// What the work calls. Empty when nothing is to be shown.
    Progress callback();

private:
    using Clock = std::chrono::steady_clock;

    void show(double done);
    void show_bar(double done, double elapsed_seconds) const;
    void show_json(double done, double elapsed_seconds) const;

    std::string stage_;
    Console::ProgressStyle style_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_ = start_;
    bool shown_ = false;
};

/// A duration for people: "0.8 s", "42 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

} // namespace vera
