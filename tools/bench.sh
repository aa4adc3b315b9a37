# SPDX-License-Identifier: Apache-2.0
# What "./dev bench" does. Read by dev, whose functions it uses.

bench_usage() {
    cat <<'TEXT'
./dev bench              all of these, in this order; some hours on a quiet machine
./dev bench peers ...    whole pictures, against POV-Ray and Tachyon
./dev bench rays ...     builds and rays a second, against Embree
./dev bench growth ...   how times and counted steps grow with the number of triangles
./dev bench billion ...  a scene of a billion triangles in less than a gigabyte
./dev bench drawings ... drawings, against CGAL, three.js, sketch and OpenCASCADE
./dev bench engines ...  how the two engines grow that find what is seen
./dev bench comparison . depth buffer, visible surfaces and rays, as section 3.4 of the paper compares them
./dev bench faces ...    whether any face is wrong, in the map and in files, at a million points a scene
./dev bench gradients .. how far colours of drawings are off the lighting formula
./dev bench leaks ...    whether the background shines through drawings, in five programs
./dev bench sizes ...    how large drawings are beside what they need
./dev bench raster ...   the compressed raster, against PNG
./dev bench colors ...   pictures of few colours, against ImageMagick
./dev bench plots ...    plots and tables of docs/performance.md from the results
./dev bench PART --help  says what the part takes

Results are kept by machine in bench/results/. Models and scenes that are not in the repository are
looked for in the folders that VERA_MODELS and VERA_SCENES name; what needs one is left out.
TEXT
}

bench_peers() {
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -- vera
    (($# > 0)) || step "find samples of no larger error than POV-Ray's" bench/peers --errors --sides 512
    step "compare with POV-Ray and Tachyon" bench/peers "$@"
}

# Builds a program of the benchmarks.
build_benchmark() {
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -DVERA_BUILD_BENCHMARKS=ON -- "$1"
}

bench_rays() {
    build_benchmark rays_bench
    step "compare with Embree" bench/against_embree rays "$@"
}

bench_growth() {
    build_benchmark growth_bench
    step "measure the growth" bench/against_embree growth "$@"
}

bench_billion() {
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -- vera
    step "render a billion triangles" bench/billion "$@"
}

bench_drawings() {
    step "install peers" install_packages drawings
    # npm comes with the nodejs of others, which Debian's npm conflicts with.
    command -v npm >/dev/null || install_packages npm
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -DVERA_BUILD_BENCHMARKS=ON -- vera envelope_peer hidden_lines_peer
    step "compare drawings" bench/drawings/compare "$@"
}

bench_engines() {
    build_benchmark engines_bench
    step "measure the engines" bench/drawings/engines "$@"
}

bench_comparison() {
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -DVERA_BUILD_BENCHMARKS=ON -- vera comparison_bench
    step "compare the strategies" bench/comparison "$@"
}

bench_faces() {
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -DVERA_BUILD_BENCHMARKS=ON -- vera faces_check
    step "check faces" bench/drawings/faces "$@"
}

bench_gradients() {
    build_benchmark gradients_check
    step "compare colours" bench/drawings/gradients "$@"
}

bench_leaks() {
    step "install viewers" install_packages drawings
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -- vera
    step "look for what shines through" bench/drawings/leaks "$@"
}

bench_sizes() {
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -- vera
    step "weigh drawings" bench/drawings/sizes "$@"
}

bench_raster() {
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -DVERA_BUILD_BENCHMARKS=ON -- vera raster_bench
    step "compare with PNG" bench/raster "$@"
}

bench_colors() {
    # shellcheck disable=SC2046 # one option or none
    step "build" build release $(without_tests) -DVERA_BUILD_BENCHMARKS=ON -- vera colors_bench
    step "compare with ImageMagick" bench/colors "$@"
}

bench_plots() {
    step "plots and tables" bench/plots.py "$@"
}

bench() {
    case ${1:-} in
    --help | -h) bench_usage ;;
    peers | rays | growth | billion | drawings | engines | comparison | faces | gradients | leaks | sizes | raster | colors | plots)
        step "install packages" install_packages build bench
        "bench_$1" "${@:2}"
        ;;
    "")
        step "install packages" install_packages build bench
        bench_peers
        bench_rays
        bench_growth
        bench_billion
        bench_drawings
        bench_engines
        bench_comparison
        bench_faces
        bench_gradients
        bench_leaks
        bench_sizes
        bench_raster
        bench_colors
        bench_plots
        ;;
    *)
        bench_usage >&2
        fail "bench has no '$1'"
        ;;
    esac
}
