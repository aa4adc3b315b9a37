// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace vera::detail {

void check_failed(const char* condition, const char* file, int line) {
    std::fprintf(
        stderr,
        "vera: internal error: %s:%d: this must hold and does not: %s\n"
        "Please report this with the scene that led to it.\n",
        file,
        line,
        condition);
    std::abort();
}

} // namespace vera::detail
