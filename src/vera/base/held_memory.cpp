// SPDX-License-Identifier: Apache-2.0
#include "vera/base/held_memory.h"

#include <fstream>

#include <unistd.h>

namespace vera {

std::uint64_t held_memory() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t address_space = 0;
    std::uint64_t pages = 0;
    statm >> address_space >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

} // namespace vera
