#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# use_installed.sh BUILD_FOLDER COMPILER
# Installs a build somewhere else, builds a program of others against what was installed, with
# warnings that ours do not reach, and runs it.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cmake --install "$1" --prefix "$folder/installed" >/dev/null
cmake -S "$here/consumer" -B "$folder/build" -G Ninja -DCMAKE_CXX_COMPILER="$2" \
    -DCMAKE_PREFIX_PATH="$folder/installed" >/dev/null
if grep -rn -e -Werror "$folder/installed/lib" "$folder/build/build.ninja"; then
    echo "our warnings reach the users of the library" >&2
    exit 1
fi
grep -q -e '-ffp-contract=off' "$folder/build/build.ninja"
cmake --build "$folder/build"
"$folder/build/consumer"
"$folder/installed/bin/vera" --version
