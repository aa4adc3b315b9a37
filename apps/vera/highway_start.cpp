// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include <hwy/nanobenchmark.h>

/// Takes the place, in this program alone, of the function in Highway's library, which that calls
/// when a program starts, for measurements that nobody here makes, and is longer at it than at
/// loading the library.
std::uint64_t hwy::platform::TimerResolution() {
    return 1;
}
