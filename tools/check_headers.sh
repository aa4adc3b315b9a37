#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_headers.sh
# Compiles each header alone: it must include what it needs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
check() {
    g++ -std=c++20 -fsyntax-only -x c++ -Isrc -Itests -Ibuild/generated -ffp-contract=off -Wall \
        -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Werror \
        '-DVERA_SOURCE_DIR=""' '-DVERA_PROGRAM=""' -include "$1" /dev/null \
        || { echo "$1 does not compile alone" >&2; return 1; }
}
export -f check
find src apps tests -name '*.h' ! -name '*-inl.h' -print0 \
    | xargs -0 -n 1 -P "${VERA_JOBS:-$(nproc)}" bash -c 'check "$PWD/$1"' _
