// SPDX-License-Identifier: Apache-2.0
#include "progress_display.h"

#include <algorithm>
#include <cmath>

#include "messages.h"
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace vera {

namespace {

Console::ProgressStyle resolved(const Console& console) {
    if (console.progress != Console::ProgressStyle::automatic)
        return console.progress;
    return !console.quiet && isatty(STDERR_FILENO) == 1 ? Console::ProgressStyle::bar
                                                        : Console::ProgressStyle::none;
}

std::size_t terminal_width() {
    winsize size = {};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
        return 80;
    return size.ws_col;
}

} // namespace

std::string duration_text(double seconds) {
    if (seconds < 9.95)
        return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<long long>(std::round(seconds));
    if (whole < 60)
        return fmt::format("{} s", whole);
    if (whole < 3600)
        return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

ProgressDisplay::ProgressDisplay(const Console& console, std::string stage)
    : stage_(std::move(stage))
    , style_(resolved(console)) {}

ProgressDisplay::~ProgressDisplay() {
    if (shown_ && style_ == Console::ProgressStyle::bar)
        print_message("\r\x1b[K");
}

Progress ProgressDisplay::callback() {
    if (style_ == Console::ProgressStyle::none)
        return {};
    return [this](double done) { show(done); };
}

void ProgressDisplay::show(double done) {
    using namespace std::chrono_literals;
    const auto now = Clock::now();
    const bool last_step = done >= 1;
    const auto wait = style_ == Console::ProgressStyle::json ? 250ms : shown_ ? 100ms : 500ms;
    if (now - last_ < wait && !(last_step && style_ == Console::ProgressStyle::json))
        return;
    last_ = now;
    shown_ = true;
    const double elapsed_seconds = std::chrono::duration<double>(now - start_).count();
    if (style_ == Console::ProgressStyle::json)
        show_json(done, elapsed_seconds);
    else
        show_bar(done, elapsed_seconds);
}

void ProgressDisplay::show_bar(double done, double elapsed_seconds) const {
    const double part = std::clamp(done, 0.0, 1.0);
    std::string left;
    if (part > 0.01)
        left = fmt::format(", {} left", duration_text(elapsed_seconds * (1 - part) / part));
    const std::string text = fmt::format(" {:3.0f} %{}", 100 * part, left);
    const std::size_t columns = terminal_width();
    const std::size_t used = stage_.size() + text.size() + 4;
    const std::size_t room = columns > used ? std::min<std::size_t>(columns - used, 40) : 0;
    const auto filled = static_cast<std::size_t>(part * static_cast<double>(room));
    print_message(fmt::format(
        "\r{} [{}{}]{}\x1b[K",
        stage_,
        std::string(filled, '='),
        std::string(room - filled, ' '),
        text));
}

void ProgressDisplay::show_json(double done, double elapsed_seconds) const {
    const double part = std::clamp(done, 0.0, 1.0);
    const std::string left =
        part > 0 ? fmt::format("{:.2f}", elapsed_seconds * (1 - part) / part) : "null";
    print_message(fmt::format(
        R"({{"version": 1, "stage": "{}", "done": {:.4f}, "elapsed_seconds": {:.2f}, "seconds_left": {}}})"
        "\n",
        stage_,
        part,
        elapsed_seconds,
        left));
}

} // namespace vera
