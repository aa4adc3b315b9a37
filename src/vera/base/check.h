// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vera::detail {
[[noreturn]] void check_failed(const char* condition, const char* file, int line);
} // namespace vera::detail

/// Aborts, in every build, when an invariant of our own is broken. Never for wrong input.
#define VERA_CHECK(condition)                                                                      \
    do {                                                                                           \
        if (!(condition))                                                                          \
            ::vera::detail::check_failed(#condition, __FILE__, __LINE__);                          \
    } while (false)
