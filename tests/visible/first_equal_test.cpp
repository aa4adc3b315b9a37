// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/first_equal.h"
#include "vera/visible/vertex_numbers.h"

#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// Few values, so that many are equal.
std::vector<ScreenVertex>
random_vertices(std::uint32_t seed, std::size_t count, std::uint32_t values) {
    std::mt19937 random(seed);
    const auto coordinate = [&] { return static_cast<std::int32_t>(random() % values); };
    std::vector<ScreenVertex> vertices(count);
    for (ScreenVertex& vertex : vertices)
        vertex = {{coordinate(), coordinate()}, static_cast<std::int64_t>(random() % 3)};
    return vertices;
}

TEST(FirstEqual, IsWhatComparingWithAllBeforeFinds) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const std::vector<ScreenVertex> things = random_vertices(seed, 40 * seed, 9);
        const UnfilledVector<std::uint32_t> first = first_equal(
            things.size(),
            [&](std::size_t i) { return hash_of(things[i]); },
            [&](std::size_t i, std::size_t j) { return things[i] == things[j]; });
        ASSERT_EQ(first.size(), things.size());
        for (std::size_t i = 0; i < things.size(); ++i)
            ASSERT_EQ(first[i], std::find(things.begin(), things.end(), things[i]) - things.begin())
                << "seed " << seed;
    }
}

TEST(FirstEqual, TellsThingsOfTheSameHashApart) {
    const UnfilledVector<std::uint32_t> first = first_equal(
        1000,
        [](std::size_t) { return std::uint64_t{7}; },
        [](std::size_t i, std::size_t j) { return i % 30 == j % 30; });
    for (std::uint32_t i = 0; i < first.size(); ++i)
        ASSERT_EQ(first[i], i % 30);
}

TEST(FirstEqual, NumbersManyAsOneAfterTheOtherDoes) {
    // Enough for several blocks and parts.
    const std::vector<ScreenVertex> things = random_vertices(1, 300'000, 200);
    UnfilledVector<std::uint32_t> numbers = first_equal(
        things.size(),
        [&](std::size_t i) { return hash_of(things[i]); },
        [&](std::size_t i, std::size_t j) { return things[i] == things[j]; });
    const std::vector<std::uint32_t> firsts = number_consecutively(numbers);
    std::vector<ScreenVertex> expected;
    VertexNumbers plain(expected);
    for (std::size_t i = 0; i < things.size(); ++i)
        ASSERT_EQ(numbers[i], plain.number(things[i]));
    ASSERT_EQ(firsts.size(), expected.size());
    for (std::size_t i = 0; i < firsts.size(); ++i)
        ASSERT_EQ(things[firsts[i]], expected[i]);
}

} // namespace
} // namespace vera
