#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# use_installed.sh BUILD_FOLDER COMPILER
# Installs a build somewhere else, builds programs of others against what was installed, with
# warnings that ours do not reach, and runs them: one, and the examples as they were installed.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# build SOURCE_FOLDER: the program is then $folder/NAME/NAME.
build() {
    local program
    program=$folder/$(basename "$1")
    cmake -S "$1" -B "$program" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
        -DCMAKE_PREFIX_PATH="$folder/installed" >/dev/null
    if grep -rn -e -Werror "$folder/installed/lib" "$program/build.ninja"; then
        echo "our warnings reach the users of the library" >&2
        exit 1
    fi
    grep -q -e '-ffp-contract=off' "$program/build.ninja"
    cmake --build "$program"
}

compiler=$2
cmake --install "$1" --prefix "$folder/installed" >/dev/null
build "$here/consumer"
"$folder/consumer/consumer"
"$folder/installed/bin/vera" --version

build "$folder/installed/share/doc/vera-raytracer/examples/ray_queries"
"$folder/ray_queries/ray_queries" | tee "$folder/said"
[[ $(grep -c '^It meets triangle' "$folder/said") == 3 ]]
[[ $(grep -c '^It enters or leaves pearl 3 at t = ' "$folder/said") == 2 ]]
grep -q '^#.*\.\..*@@@' "$folder/said" # the floor, a shadow and the ring
