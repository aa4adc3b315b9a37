#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_tidy.sh [FILE...]
# clang-tidy over these sources, or over all that the release build compiles.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if (($# == 0)); then
    mapfile -t files < <(sed -n 's/^ *"file": "\(.*\)".*/\1/p' build/compile_commands.json \
        | grep -v '/build' | sort -u)
    set -- "${files[@]}"
fi
printf '%s\0' "$@" | xargs -0 -n 1 -P "${VERA_JOBS:-$(nproc)}" \
    clang-tidy-14 -p build --quiet --extra-arg=-Wno-unknown-warning-option 2> >(grep -v ' generated\.$' >&2)
