// SPDX-License-Identifier: Apache-2.0
#include "vera/base/free_room.h"
#include "vera/base/unfilled_vector.h"

#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(UnfilledVector, KeepsWhatWasPutThereWhereverItGoes) {
    UnfilledVector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < 100; ++i)
        numbers.push_back(i);
    numbers.resize(100'000); // elsewhere
    for (std::uint32_t i = 100; i < numbers.size(); ++i)
        numbers[i] = i;
    const UnfilledVector<std::uint32_t> copy = numbers;
    const UnfilledVector<std::uint32_t> moved = std::move(numbers);
    ASSERT_EQ(copy, moved);
    for (std::uint32_t i = 0; i < moved.size(); ++i)
        ASSERT_EQ(moved[i], i);
}

TEST(UnfilledVector, IsFilledWhereAValueIsGiven) {
    UnfilledVector<std::uint32_t> numbers(3, 7);
    numbers.resize(5, 8);
    EXPECT_EQ(numbers, (UnfilledVector<std::uint32_t>{7, 7, 7, 8, 8}));
}

TEST(UnfilledVector, GivesItsRoomBack) {
    UnfilledVector<std::uint32_t> numbers(1000);
    free_room(numbers);
    EXPECT_EQ(numbers.capacity(), 0U);
}

} // namespace
} // namespace vera
