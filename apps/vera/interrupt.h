// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "command.h"

namespace vera {

/// Makes SIGINT (Ctrl-C), SIGTERM and SIGHUP end the process at once, with no partial file left.
/// During cancellable work the first one raises the console's flag instead. Signals that tell of
/// failed writes are ignored: the writes tell of it as well. The console must live to the end of
/// the process.
void stop_on_interrupt(Console& console);

/// Whether such work runs.
bool work_looks_at_the_flag() noexcept;

/// Ends the process now, with the message as an error and no partial file left. From any thread.
[[noreturn]] void
end_process(std::string_view message, ExitCode code, const Console& console) noexcept;

/// While it lives, work runs that looks at the console's flag and ends soon after it is raised.
class CancellableWork {
public:
    CancellableWork();
    ~CancellableWork();
    CancellableWork(const CancellableWork&) = delete;
    CancellableWork& operator=(const CancellableWork&) = delete;
};

} // namespace vera
