// SPDX-License-Identifier: Apache-2.0
// Rays among rectangles by point location: proposition 2.
#include "vera/math/elementary.h"
#include "vera/theory/dual_bits.h"
#include "vera/theory/dual_pairs.h"
#include "vera/theory/experiment.h"
#include "vera/theory/scattered_rectangles.h"

#include <algorithm>
#include <string>

namespace vera {

namespace {

constexpr int rays = 300;
constexpr double parts = 2; ///< of the mean distance, of sides: rays meet some

/// The most steps of a ray of some.
template <typename Structure>
double most_steps(const Structure& structure, std::mt19937_64& random) {
    std::uint64_t most = 0;
    for (int i = 0; i < rays; ++i) {
        DualCounts counts;
        structure.first_rectangle(scattered_ray(random), &counts);
        most = std::max(most, counts.steps());
    }
    return static_cast<double>(most);
}

CountedSize steps_of_pairs(std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
    std::mt19937_64 random(seed);
    // All pairs would not fit into memory; what is asked for is the same.
    const DualPairs pairs(
        scattered_rectangles(size, parts, random),
        Stabbing::from_a_rank,
        DualPairs::Building::when_asked,
        {},
        cancel);
    const auto n = static_cast<double>(size);
    const double logarithm = log2_of(n);
    return {n, most_steps(pairs, random), logarithm * logarithm * logarithm};
}

CountedSize steps_of_bits(std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
    std::mt19937_64 random(seed);
    const DualBits bits(scattered_rectangles(size, parts, random), {}, cancel);
    const auto n = static_cast<double>(size);
    return {n, most_steps(bits, random), log2_of(n) + n / 64};
}

CountedSize memory_of_pairs(std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
    std::mt19937_64 random(seed);
    const DualPairs pairs(
        scattered_rectangles(size, parts, random),
        Stabbing::from_a_rank,
        DualPairs::Building::all,
        {},
        cancel);
    const auto n = static_cast<double>(size);
    const double levels = log2_of(4 * n); // of a tree over twice as many ends and what is between
    return {n, static_cast<double>(pairs.bytes()), n * n * n * levels * levels};
}

CountedSize memory_of_bits(std::size_t size, std::uint64_t seed, const CancelFlag* cancel) {
    std::mt19937_64 random(seed);
    const DualBits bits(scattered_rectangles(size, parts, random), {}, cancel);
    const auto n = static_cast<double>(size);
    return {n, static_cast<double>(bits.bytes()), n * n * n};
}

Experiment of_rectangles(const char* name, const char* family, const char* input) {
    Experiment experiment;
    experiment.name = name;
    experiment.family = family;
    experiment.input = input;
    experiment.unit = "rectangles";
    experiment.sizes_a_doubling = 1;
    return experiment;
}

} // namespace

std::vector<Experiment> dual_experiments() {
    Experiment pairs =
        of_rectangles("prop2-steps", "pairs", "rectangles that rays meet, by pairs of their ends");
    pairs.counted = "comparisons, nodes and rectangles of a ray, the most of 300";
    pairs.bound = "log^3 n";
    pairs.source = "VERA 3.3.1, proposition 2";
    pairs.first = 8;
    pairs.last = 512;
    pairs.last_in_tests = 128;
    pairs.most = 1024;
    pairs.count = steps_of_pairs;
    Experiment bits =
        of_rectangles("prop2-steps", "bits", "the same rectangles, by bits of their ends");
    bits.counted = pairs.counted;
    bits.bound = "log n + n/64";
    bits.source = "bits in place of pairs";
    bits.first = 8;
    bits.last = 256;
    bits.last_in_tests = 128;
    bits.most = 1024;
    bits.count = steps_of_bits;
    Experiment memory_pairs =
        of_rectangles("prop2-memory", "pairs", "rectangles, and all pairs of their ends");
    memory_pairs.counted = "bytes of all that is built";
    memory_pairs.bound = "n^3 log^2 4n";
    memory_pairs.source = "VERA 3.3.1, proposition 2, which says n^3 polylog n";
    memory_pairs.first = 4;
    memory_pairs.last = 64;
    memory_pairs.last_in_tests = 32;
    memory_pairs.most = 128;
    memory_pairs.count = memory_of_pairs;
    Experiment memory_bits =
        of_rectangles("prop2-memory", "bits", "rectangles, and the bits of their ends");
    memory_bits.counted = memory_pairs.counted;
    memory_bits.bound = "n^3";
    memory_bits.source = "bits in place of pairs";
    memory_bits.first = 32;
    memory_bits.last = 512;
    memory_bits.last_in_tests = 256;
    memory_bits.most = 1024;
    memory_bits.count = memory_of_bits;
    return {pairs, bits, memory_pairs, memory_bits};
}

} // namespace vera
