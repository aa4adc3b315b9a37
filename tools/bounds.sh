#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures and tables of docs/bounds.md and the pictures of docs/rectangle-view.md anew: the curves, in a minute, and
# the figures.
#
# usage: tools/bounds.sh [PROGRAM]
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."
vera=${1:-build/bin/vera}

for figure in 3a 3b 3c 3d A1 A2 B1; do
    "$vera" bench figure "$figure" -o "docs/images/figure-$figure.svg"
done
curves=$(mktemp)
trap 'rm -f "$curves"' EXIT
"$vera" bench curve all -o docs/images/curves.svg --json >"$curves"
tools/bounds_tables.py "$curves"
