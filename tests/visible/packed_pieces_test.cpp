// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/packed_pieces.h"
#include "vera/visible/seen_parts.h"

#include <algorithm>
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
        std::vector<PackedRows<3>::Row> again;
        packed.for_each([&](const auto& row) { again.push_back(row); });
        ASSERT_EQ(again, rows) << "seed " << seed;
    }
}

TEST(PackedRows, EqualNumbersTakeNoRoom) {
    const PackedRows<2> packed(100'000, [](std::size_t) {
        return PackedRows<2>::Row{7, std::numeric_limits<std::uint64_t>::max()};
    });
    EXPECT_LT(packed.room(), 64U);
    std::size_t equal = 0;
    packed.for_each([&](const auto& row) {
        equal += row[0] == 7 && row[1] == std::numeric_limits<std::uint64_t>::max() ? 1 : 0;
    });
    EXPECT_EQ(equal, 100'000U);
}

void expect_same(const VisiblePieces& again, const VisiblePieces& list) {
    EXPECT_TRUE(again.points == list.points);
    ASSERT_EQ(again.pieces.size(), list.pieces.size());
    ASSERT_EQ(again.unlit.size(), list.unlit.size());
    for (std::size_t i = 0; i < list.pieces.size(); ++i) {
        EXPECT_EQ(again.pieces[i].from, list.pieces[i].from);
        EXPECT_EQ(again.pieces[i].to, list.pieces[i].to);
        EXPECT_EQ(again.pieces[i].edge, list.pieces[i].edge);
        EXPECT_EQ(again.pieces[i].left, list.pieces[i].left);
        EXPECT_EQ(again.pieces[i].right, list.pieces[i].right);
    }
    for (std::size_t i = 0; i < list.unlit.size(); ++i) {
        EXPECT_EQ(again.unlit[i].left, list.unlit[i].left);
        EXPECT_EQ(again.unlit[i].right, list.unlit[i].right);
    }
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
    expect_same(PackedPieces(list).unpacked(), list);
    for (const PieceStorage storage : {PieceStorage::plain, PieceStorage::packed}) {
        SeenPart part(list, storage);
        EXPECT_EQ(part.size(), 2U);
        EXPECT_EQ(part.points(), 3U);
        EXPECT_EQ(part.unlit(), 2U);
        EXPECT_EQ(part.penetrating, list.penetrating);
        expect_same(part.list(), list);
        expect_same(part.take(), list);
        EXPECT_EQ(part.size(), 0U);
        EXPECT_EQ(part.room(), 0U);
        SeenPart other(list, storage);
        for (std::size_t i = 0; i < list.points.size(); ++i)
            EXPECT_TRUE(other.point(i) == list.points[i]);
        other.forget_points();
        EXPECT_EQ(other.points(), 0U);
        EXPECT_EQ(other.take().pieces.size(), 2U);
    }
}

TEST(PackedPieces, NothingIsNothing) {
    for (const PieceStorage storage : {PieceStorage::plain, PieceStorage::packed}) {
        const VisiblePieces again = SeenPart(VisiblePieces{}, storage).take();
        EXPECT_TRUE(again.points.empty());
        EXPECT_TRUE(again.pieces.empty());
    }
    EXPECT_TRUE(parts_of({}).empty());
}

} // namespace
} // namespace vera
