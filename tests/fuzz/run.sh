#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# run.sh FUZZER ARGUMENT...: runs it for VERA_FUZZ_SECONDS (10) or VERA_FUZZ_RUNS (50000; -1: any
# number), whichever is spent first. VERA_FUZZ_SEED (1) chooses its inputs, 0 others each time.
# libFuzzer goes by addresses too: where the system lets us, they are not random either.
set -eu
if setarch -R true 2>/dev/null; then
    set -- setarch -R "$@"
fi
exec "$@" -max_total_time="${VERA_FUZZ_SECONDS:-10}" -runs="${VERA_FUZZ_RUNS:-50000}" \
    -seed="${VERA_FUZZ_SEED:-1}"
