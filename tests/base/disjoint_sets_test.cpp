// SPDX-License-Identifier: Apache-2.0
#include "vera/base/disjoint_sets.h"

#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// Against a label for each number, of which all of a set are rewritten at a join.
TEST(DisjointSets, AreToldByTheirSmallestNumbers) {
    std::mt19937_64 random(1);
    for (std::uint32_t count = 1; count < 40; ++count) {
        DisjointSets sets(count);
        std::vector<std::uint32_t> labels(count);
        for (std::uint32_t i = 0; i < count; ++i)
            labels[i] = i;
        for (std::uint32_t turn = 0; turn < count; ++turn) {
            const auto a = static_cast<std::uint32_t>(random() % count);
            const auto b = static_cast<std::uint32_t>(random() % count);
            sets.join(a, b);
            const std::uint32_t smaller = labels[a] < labels[b] ? labels[a] : labels[b];
            const std::uint32_t larger = labels[a] < labels[b] ? labels[b] : labels[a];
            for (std::uint32_t& label : labels)
                if (label == larger)
                    label = smaller;
            for (std::uint32_t i = 0; i < count; ++i)
                ASSERT_EQ(sets.first_of(i), labels[i]);
        }
    }
}

} // namespace
} // namespace vera
