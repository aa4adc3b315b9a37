// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include "vera/base/output_file.h"

#include <csignal>

#include <unistd.h>

namespace vera {

namespace {

CancelFlag* flag_to_raise = nullptr;

void on_signal(int) {
    constexpr int interrupted = 130;
    if (flag_to_raise->raised()) {
        remove_partial_files();
        _exit(interrupted);
    }
    flag_to_raise->raise();
}

} // namespace

void raise_on_interrupt(CancelFlag& flag) {
    flag_to_raise = &flag;
    struct sigaction action = {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
    // A reader that goes away is a failed write, told like any other.
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, nullptr);
}

} // namespace vera
