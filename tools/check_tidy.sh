#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_tidy.sh [FILE...]
# clang-tidy over these sources, or over all that the release build compiles.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# GCC's precompiled headers mean nothing to clang: files are read as they stand.
mkdir -p build/tidy
sed -E -e 's/ -Winvalid-pch//' -e 's/ -include [^ ]*cmake_pch\.hxx//' build/compile_commands.json \
    >build/tidy/compile_commands.json
if (($# == 0)); then
    mapfile -t files < <(sed -n 's/^ *"file": "\(.*\)".*/\1/p' build/compile_commands.json \
        | grep -v '/build' | sort -u)
    set -- "${files[@]}"
fi
printf '%s\0' "$@" | xargs -0 -n 1 -P "${VERA_JOBS:-$(nproc)}" \
    clang-tidy-14 -p build/tidy --quiet --extra-arg=-Wno-unknown-warning-option 2> >(grep -v ' generated\.$' >&2)
