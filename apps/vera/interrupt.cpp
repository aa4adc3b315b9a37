// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include "vera/base/output_file.h"

#include <atomic>
#include <csignal>
#include <string_view>

#include "messages.h"
#include <unistd.h>

namespace vera {

namespace {

Console* interrupted_console = nullptr;
std::atomic<bool> is_looked_at = false;
static_assert(std::atomic<bool>::is_always_lock_free, "the signal handler reads it");

void on_signal(int) {
    CancelFlag& cancel = interrupted_console->cancel;
    if (is_looked_at && !cancel.raised()) {
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
    // A reader that goes away and a file that outgrows its limit are failed writes, told like any
    // other.
    action.sa_handler = SIG_IGN;
    for (const int signal : {SIGPIPE, SIGXFSZ})
        sigaction(signal, &action, nullptr);
}

bool work_looks_at_the_flag() noexcept {
    return is_looked_at;
}

void end_process(std::string_view message, ExitCode code, const Console& console) noexcept {
    remove_partial_files();
    print_error(message, console);
    _exit(static_cast<int>(code));
}

CancellableWork::CancellableWork() {
    is_looked_at = true;
}

CancellableWork::~CancellableWork() {
    is_looked_at = false;
}

} // namespace vera
