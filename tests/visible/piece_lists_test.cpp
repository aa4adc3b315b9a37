// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cell_raster_stages.h"
#include "vera/visible/piece_lists.h"

#include <algorithm>
#include <random>
#include <utility>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

bool are_same(const VisiblePiece& a, const VisiblePiece& b) {
    return a.from == b.from && a.to == b.to && a.edge == b.edge && a.left == b.left
        && a.right == b.right;
}

void expect_same(const VisiblePieces& a, const VisiblePieces& b, std::uint32_t seed) {
    EXPECT_TRUE(a.points == b.points) << "seed " << seed;
    EXPECT_TRUE(std::ranges::equal(a.pieces, b.pieces, are_same)) << "seed " << seed;
    EXPECT_TRUE(std::ranges::equal(
        a.unlit,
        b.unlit,
        [](const UnlitBeside& one, const UnlitBeside& other) {
            return one.left == other.left && one.right == other.right;
        }))
        << "seed " << seed;
    EXPECT_EQ(a.penetrating, b.penetrating) << "seed " << seed;
}

/// Numbers the piece's ends by looking through all points.
void add_plainly(VisiblePieces& all, const VisiblePieces& from, std::size_t i, bool with_lights) {
    VisiblePiece piece = from.pieces[i];
    for (std::uint32_t* end : {&piece.from, &piece.to}) {
        const PackedPoint point = from.points[*end];
        *end =
            static_cast<std::uint32_t>(std::ranges::find(all.points, point) - all.points.begin());
        if (*end == all.points.size())
            all.points.push_back(point);
    }
    all.pieces.push_back(piece);
    if (with_lights)
        all.unlit.push_back(from.unlit_beside(i));
}

/// Pieces of the edges from `first` to before `last`, between few points, of which some are not
/// whole ones. Each point is there once, in the order of the pieces.
VisiblePieces
some_pieces(std::mt19937& random, std::uint32_t first, std::uint32_t last, bool with_lights) {
    const auto point = [&] {
        RationalPoint some;
        some.whole.x = static_cast<std::int32_t>(random() % 3);
        some.whole.y = static_cast<std::int32_t>(random() % 2);
        some.denominator = 1 + static_cast<std::int64_t>(random() % 2);
        some.x_numerator = some.denominator - 1;
        return some;
    };
    VisiblePieces plain;
    VisiblePieces all;
    for (std::uint32_t edge = first; edge < last; ++edge)
        for (std::size_t count = random() % 3; count > 0; --count) {
            const auto number = static_cast<std::uint32_t>(plain.points.size());
            plain.points.push_back(point());
            plain.points.push_back(point());
            const auto left = static_cast<std::uint32_t>(random() % 4);
            plain.pieces.push_back({number, number + 1, {edge / 2, edge}, left, 7});
            if (with_lights)
                plain.unlit.push_back({static_cast<LightSet>(random() % 3), 0});
            add_plainly(all, plain, plain.pieces.size() - 1, with_lights);
            if (random() % 4 == 0)
                all.penetrating.emplace_back(left, edge);
        }
    return all;
}

/// The list with points of its own for each piece, as parts may have them.
VisiblePieces with_each_end(const VisiblePieces& list) {
    VisiblePieces result = list;
    result.points.clear();
    for (VisiblePiece& piece : result.pieces)
        for (std::uint32_t* end : {&piece.from, &piece.to}) {
            result.points.push_back(list.points[*end]);
            *end = static_cast<std::uint32_t>(result.points.size() - 1);
        }
    return result;
}

TEST(PieceLists, PartsAreJoinedAsOneAfterTheOtherIsAdded) {
    std::size_t common = 0;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const bool with_lights = seed % 2 == 1;
        std::vector<SeenPart> parts;
        VisiblePieces expected;
        std::size_t points = 0;
        for (std::uint32_t i = 0; i < seed % 6; ++i) {
            const VisiblePieces part = some_pieces(random, 5 * i, 5 * (i + 1), with_lights);
            points += part.points.size();
            for (std::size_t j = 0; j < part.pieces.size(); ++j)
                add_plainly(expected, part, j, with_lights);
            expected.penetrating.insert(
                expected.penetrating.end(), part.penetrating.begin(), part.penetrating.end());
            parts.emplace_back(
                with_each_end(part), i % 2 == 0 ? PieceStorage::plain : PieceStorage::packed);
        }
        common += points - expected.points.size();
        expect_same(joined(std::move(parts), seed % 7), expected, seed);
    }
    EXPECT_GT(common, 1000U);
}

TEST(PieceLists, PartsOfAListAreTheListWhenTheyAreJoined) {
    for (const std::uint32_t edges : {0U, 1U, 100U, 4096U, 9000U}) {
        std::mt19937 random(edges);
        VisiblePieces list = some_pieces(random, 0, edges, false);
        list.penetrating.clear();
        std::vector<SeenPart> parts = parts_of(list);
        EXPECT_EQ(parts.size(), (list.pieces.size() + 4095) / 4096);
        const VisiblePieces again = joined(std::move(parts), 100);
        expect_same(again, list, edges);
        EXPECT_GE(again.pieces.capacity(), list.pieces.size() + 100);
    }
}

TEST(PieceLists, PiecesAreJoinedAlongAnEdgeWhereNothingElseEnds) {
    const auto at = [](std::int32_t x) {
        RationalPoint point;
        point.whole.x = x;
        return PackedPoint(point);
    };
    VisiblePieces list;
    for (std::int32_t x = 0; x <= 7; ++x)
        list.points.push_back(at(x));
    const ScreenEdges::Edge edge = {0, 1};
    list.pieces = {
        {0, 1, edge, 4, 5},
        {1, 2, edge, 4, 5},
        {2, 3, edge, 4, 5},
        {3, 4, edge, 4, 5}, // behind the end of another
        {4, 5, edge, 4, 6}, // beside another
        {5, 6, edge, 4, 6}, // in other light
        {6, 7, {0, 2}, 4, 6},
        {3, 7, {1, 2}, 4, 5}};
    list.unlit.resize(list.pieces.size());
    list.unlit[5].right = 1;
    VisiblePieces expected;
    for (const std::int32_t x : {0, 3, 4, 5, 6, 7})
        expected.points.push_back(at(x));
    expected.pieces = {
        {0, 1, edge, 4, 5},
        {1, 2, edge, 4, 5},
        {2, 3, edge, 4, 6},
        {3, 4, edge, 4, 6},
        {4, 5, {0, 2}, 4, 6},
        {1, 5, {1, 2}, 4, 5}};
    expected.unlit.resize(expected.pieces.size());
    expected.unlit[3].right = 1;
    join_along_edges(list);
    expect_same(list, expected, 0);
}

TEST(PieceLists, KeptAndFoundPiecesAreMergedAsAllByTheirEdges) {
    std::size_t kept = 0;
    std::size_t both = 0;
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        std::mt19937 random(seed);
        const bool has_lights_before = seed % 3 == 1;
        const bool has_lights_found = seed % 2 == 1;
        const VisiblePieces before = some_pieces(random, 0, seed % 40, has_lights_before);
        const VisiblePieces any = some_pieces(random, 0, seed % 40, has_lights_found);
        // Each edge has either what was there before, or what was found.
        const auto is_near = [&](std::uint32_t edge) {
            return edge * 0x9e3779b9U >> 28U < seed % 16;
        };
        std::vector<std::uint8_t> is_kept;
        std::vector<std::pair<const VisiblePieces*, std::size_t>> order;
        for (std::size_t i = 0; i < before.pieces.size(); ++i) {
            is_kept.push_back(is_near(before.pieces[i].edge.end) ? 0 : 1);
            if (is_kept.back() != 0)
                order.emplace_back(&before, i);
        }
        VisiblePieces found;
        for (std::size_t i = 0; i < any.pieces.size(); ++i)
            if (is_near(any.pieces[i].edge.end))
                add_plainly(found, any, i, has_lights_found);
        found.penetrating = any.penetrating;
        for (std::size_t i = 0; i < found.pieces.size(); ++i)
            order.emplace_back(&found, i);
        std::ranges::stable_sort(
            order, {}, [](const auto& piece) { return piece.first->pieces[piece.second].edge; });
        VisiblePieces left;
        for (std::size_t i = 0; i < before.pieces.size(); ++i)
            if (is_kept[i] != 0)
                add_plainly(left, before, i, has_lights_before);
        const bool has_lights = !left.unlit.empty() || !found.unlit.empty();
        VisiblePieces expected;
        expected.penetrating = found.penetrating;
        for (const auto& [list, i] : order)
            add_plainly(expected, *list, i, has_lights);
        expect_same(merged(left, found), expected, seed);
        kept += static_cast<std::size_t>(std::ranges::count(is_kept, 1));
        both += found.pieces.empty() || found.pieces.size() == order.size() ? 0 : 1;
    }
    EXPECT_GT(kept, 1000U);
    EXPECT_GT(both, 100U);
}

TEST(PieceLists, KeptPiecesAndThoseOfEdgesFollowedAgainAreAsIfAllHadBeenFollowed) {
    ScreenScene scene = testing::scattered(1, 4'000, screen_size / 50);
    sort_by_place(scene);
    const VisiblePieces expected = cell_raster(scene);
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        CellRaster raster = raster_of(scene, {}, {}, nullptr);
        raster.storage = seed % 2 == 0 ? PieceStorage::plain : PieceStorage::packed;
        std::vector<SeenPart> parts;
        follow_edges(raster, 0, raster.edges.edges.size(), {}, nullptr, parts);
        EXPECT_GT(parts.size(), 2U);
        std::mt19937 random(seed);
        // None, all, few and many, in stretches.
        std::uint8_t is_near = seed == 0 ? 1 : 0;
        for (std::size_t i = 0; i < raster.edges.edges.size(); ++i) {
            if (seed > 3 && random() % (seed * seed * seed) == 0)
                is_near = is_near == 0 ? 1 : 0;
            raster.is_near_change.push_back(is_near);
        }
        std::vector<EdgePart> kept = kept_pieces(raster, std::move(parts));
        parts.clear();
        follow_edges(raster, std::move(kept), {}, nullptr, parts);
        expect_same(joined(std::move(parts)), expected, seed);
    }
}

} // namespace
} // namespace vera
