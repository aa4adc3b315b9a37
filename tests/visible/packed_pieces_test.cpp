// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/packed_pieces.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(PackedRows, NumbersOfAnyLengthAreAsTheyWere) {
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    for (std::uint32_t seed = 0; seed < 500; ++seed) {
        std::mt19937_64 random(seed);
        std::vector<PackedRows<3>::Row> rows(seed % 70);
        // Columns of no, few, and all bits, above a least number that is not 0.
        std::array<int, 3> widths = {};
        PackedRows<3>::Row least = {};
        for (std::size_t column = 0; column < 3; ++column) {
            widths[column] = static_cast<int>(random() % 65);
            least[column] = widths[column] == 64 ? 0 : random() % (most >> widths[column]);
        }
        for (PackedRows<3>::Row& row : rows)
            for (std::size_t column = 0; column < 3; ++column) {
                const int width = widths[column];
                const std::uint64_t above = width == 0 ? 0 : random() >> (64 - width);
                row[column] = least[column] + above;
            }
        const PackedRows<3> packed(rows.size(), [&](std::size_t i) { return rows[i]; });
        ASSERT_EQ(packed.size(), rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i)
            ASSERT_EQ(packed[i], rows[i]) << "seed " << seed << ", row " << i;
    }
}

TEST(PackedRows, EqualNumbersTakeNoRoom) {
    const PackedRows<2> packed(100'000, [](std::size_t) {
        return PackedRows<2>::Row{7, std::numeric_limits<std::uint64_t>::max()};
    });
    EXPECT_LT(packed.room(), 64U);
    EXPECT_EQ(packed[99'999][1], std::numeric_limits<std::uint64_t>::max());
}

TEST(PackedPieces, TheSmallestAndTheLargestAreAsTheyWere) {
    constexpr std::int64_t longest = (std::int64_t{1} << (2 * screen_bits + 1)) - 1;
    VisiblePieces list;
    list.points = {
        RationalPoint{},
        RationalPoint{{screen_size, screen_size}, 0, 0, 1},
        RationalPoint{{1, 2}, longest - 1, longest - 2, longest}};
    list.pieces = {
        {0, 1, {0, no_triangle - 1}, no_triangle, 0}, {2, 2, {5, 6}, no_triangle - 1, no_triangle}};
    list.unlit = {{all_lights, 0}, {0, 1}};
    list.penetrating = {{1, 2}};
    const PackedPieces packed(list);
    const VisiblePieces again = packed.unpacked();
    EXPECT_TRUE(again.points == list.points);
    ASSERT_EQ(again.pieces.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(again.pieces[i].from, list.pieces[i].from);
        EXPECT_EQ(again.pieces[i].to, list.pieces[i].to);
        EXPECT_EQ(again.pieces[i].edge, list.pieces[i].edge);
        EXPECT_EQ(packed.edge(i), list.pieces[i].edge);
        EXPECT_EQ(again.pieces[i].left, list.pieces[i].left);
        EXPECT_EQ(again.pieces[i].right, list.pieces[i].right);
        EXPECT_EQ(again.unlit[i].left, list.unlit[i].left);
        EXPECT_EQ(again.unlit[i].right, list.unlit[i].right);
    }
    EXPECT_EQ(again.penetrating, list.penetrating);
}

TEST(PackedPieces, NothingIsNothing) {
    const VisiblePieces again = PackedPieces(VisiblePieces{}).unpacked();
    EXPECT_TRUE(again.points.empty());
    EXPECT_TRUE(again.pieces.empty());
    EXPECT_TRUE(parts_of({}).empty());
}

} // namespace
} // namespace vera
