#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# picture_hashes.sh PROGRAM...
# Renders six examples with a program, given with what it takes to run it, and prints their hashes:
# the same for every machine.
set -euo pipefail
scenes=$(cd "$(dirname "${BASH_SOURCE[0]}")/../scenes" && pwd)
for name in still_life glass goblet patches materials instances; do
    hash=$("$@" render "$scenes/$name.vera" -c "$scenes/$name.ctl" --raster 96x72 --progress none \
        --format ppm -o - | sha256sum)
    echo "${hash%% *}  $name"
done
