# SPDX-License-Identifier: Apache-2.0
# What "./dev test --all" does beyond "./dev test". Read by dev, whose functions it uses.

coverage_report() {
    gcovr --root . --object-directory build-coverage --filter src/vera/ --print-summary \
        --exclude-unreachable-branches --output build-coverage/report.txt
    echo "Line by line: build-coverage/report.txt"
}

# with_simd LEVEL: the tests that compare results, with one set of instructions.
with_simd() {
    local said
    if said=$(VERA_SIMD=$1 build/bin/vera render scenes/spiral.vera --raster 8x8 -o - --format ppm 2>&1 \
        >/dev/null); then
        VERA_SIMD=$1 run_tests release -L 'agree|golden'
    elif [[ $said == *"names no instruction set of this machine"* ]]; then
        echo "this machine has no $1"
    else
        fail "$said"
    fi
}

# The mathematics library takes other paths, and other bits, on a CPU without fused multiply-add.
without_fma() {
    GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2 run_tests release -L 'agree|golden'
}


same_pictures_on_arm() {
    local here there
    here=$(tools/picture_hashes.sh build/bin/vera)
    there=$(tools/picture_hashes.sh qemu-aarch64-static -L build-sysroot-arm64/root \
        build-aarch64/bin/vera)
    echo "$here"
    [[ $here == "$there" ]] || fail "on 64 bit ARM it is: $there"
}

fuzz_for_long() {
    VERA_FUZZ_SECONDS=${VERA_LONG_FUZZ_SECONDS:-600} VERA_FUZZ_RUNS=-1 VERA_FUZZ_SEED=0 \
        run_tests asan -L fuzz
}

# Tests of files of gigabytes are skipped unless this variable is set.
large_tests() {
    VERA_LARGE_TESTS=1 run_tests release -R 'Large|Gigabyte'
}

test_all() {
    local level sysroot
    step "install packages for --all" install_packages all cross
    step "clang-tidy" tools/check_tidy.sh
    step "each header alone" tools/check_headers.sh
    step "dev: build" build dev -DVERA_BUILD_TESTS=ON
    step "dev: unit, agree and door tests" run_tests dev -L 'unit|agree|door'
    for level in ssse3 sse4 avx2 avx512f avx512; do
        step "release: with $level instructions" with_simd "$level"
    done
    step "release: without fused multiply-add" without_fma
    mapfile -t sysroot < <(packages sysroot)
    step "aarch64: unpack libraries" tools/make_sysroot.sh arm64 build-sysroot-arm64 "${sysroot[@]}"
    step "aarch64: build" build aarch64 -- vera unit_and_agree_tests
    step "aarch64: unit and agree tests" run_tests aarch64 -L 'unit|agree'
    step "aarch64: the same pictures" same_pictures_on_arm
    step "release: large files" large_tests
    step "coverage: build" build coverage
    step "coverage: tests" run_tests coverage -L 'unit|agree|golden'
    step "coverage: report" coverage_report
    step "asan: fuzzers, ${VERA_LONG_FUZZ_SECONDS:-600} s each" fuzz_for_long
}
