// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include "vera/base/output_file.h"

#include <atomic>
#include <csignal>
#include <string_view>

#include <unistd.h>

namespace vera {

namespace {

Console* interrupted_console = nullptr;
std::atomic<bool> work_looks_at_the_flag = false;
static_assert(std::atomic<bool>::is_always_lock_free, "the signal handler reads it");

void on_signal(int) {
    CancelFlag& cancel = interrupted_console->cancel;
    if (work_looks_at_the_flag && !cancel.raised()) {
        cancel.raise();
        return;
    }
    remove_partial_files();
    constexpr std::string_view message = "vera: interrupted\n";
    if (!interrupted_console->quiet) {
        [[maybe_unused]] const ssize_t written =
            write(STDERR_FILENO, message.data(), message.size());
    }
    _exit(static_cast<int>(ExitCode::interrupted));
}

} // namespace

void stop_on_interrupt(Console& console) {
    interrupted_console = &console;
    struct sigaction action = {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
    // A reader that goes away is a failed write, told like any other.
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, nullptr);
}

CancellableWork::CancellableWork() {
    work_looks_at_the_flag = true;
}

CancellableWork::~CancellableWork() {
    work_looks_at_the_flag = false;
}

} // namespace vera
