// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"

namespace vera {

/// Makes SIGINT (Ctrl-C), SIGTERM and SIGHUP raise the flag. A second one ends the process at once,
/// with no partial file left. The flag must live to the end of the process.
void raise_on_interrupt(CancelFlag& flag);

} // namespace vera
