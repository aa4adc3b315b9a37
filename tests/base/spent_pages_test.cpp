// SPDX-License-Identifier: Apache-2.0
#include "vera/base/held_memory.h"
#include "vera/base/spent_pages.h"

#include <cstddef>
#include <vector>

#include "base/memory_is_watched.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(SpentPages, UnusedRoomIsGivenBackAndCanBeUsedAnew) {
    constexpr std::size_t count = std::size_t{1} << 22U;
    std::vector<int> vector(count, 1);
    const auto before = static_cast<double>(held_memory());
    vector.resize(count / 4);
    give_back_unused(vector);
    EXPECT_EQ(vector.capacity(), count);
    if (!memory_is_watched()) {
        EXPECT_LT(static_cast<double>(held_memory()), before - 0.7 * count * sizeof(int));
    }
    vector.resize(count, 2);
    for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(vector[i], i < count / 4 ? 1 : 2) << i;
}

TEST(SpentPages, WhatLiesBesideSpentElementsStays) {
    std::vector<int> vector(100'000);
    for (std::size_t i = 0; i < vector.size(); ++i)
        vector[i] = static_cast<int>(i);
    for (const std::size_t first : {std::size_t{50'000}, std::size_t{70'001}, std::size_t{70'002}})
        for (const std::size_t last : {first, first + 1, first + 1023, first + 1025, first + 9000})
            give_back_spent(vector, first, last);
    give_back_spent(vector, 0, 0);
    for (std::size_t i = 0; i < vector.size(); ++i)
        if (i < 50'000 || (i >= 59'000 && i < 70'001) || i >= 79'002) {
            ASSERT_EQ(vector[i], static_cast<int>(i));
        }
}

} // namespace
} // namespace vera
