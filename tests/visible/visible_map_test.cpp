// SPDX-License-Identifier: Apache-2.0
#include "vera/base/parallel.h"
#include "vera/visible/brute_force.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "visible/map_turns.h"
#include "visible/maximal_pieces.h"
#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::area_of;
using testing::layers;
using testing::scattered;
using testing::tangle;
using testing::terrain;
using testing::turns_about;

/// The map shows at each of the points what asking every triangle tells.
void expect_like_brute_force(
    const ScreenScene& scene, std::uint64_t seed, int points, const std::string& what) {
    const VisiblePieces pieces = cell_raster(scene);
    EXPECT_TRUE(pieces.penetrating.empty()) << what;
    const VisibleMap map = visible_map(scene, pieces);
    EXPECT_EQ(map.joined, 0U) << what;
    EXPECT_LE(area_of(map), std::ldexp(1.0, 2 * screen_bits) * (1 + 1e-12)) << what;
    std::mt19937_64 random(seed);
    for (int i = 0; i < points && !::testing::Test::HasFailure(); ++i) {
        const auto x = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size})) | 1;
        const auto y = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size})) | 1;
        const SeenAt expected = seen_at(scene, x, y);
        if (expected.has_side_at)
            continue;
        const auto turns =
            turns_about(map, 0.5 * static_cast<double>(x), 0.5 * static_cast<double>(y));
        if (expected.source == no_source) {
            EXPECT_TRUE(turns.empty()) << what << " at " << x << " " << y;
            continue;
        }
        ASSERT_EQ(turns.size(), 1U) << what << " at " << x << " " << y;
        const VisibleMap::Region region = map.regions[turns.begin()->first];
        EXPECT_EQ(region.source, expected.source) << what << " at " << x << " " << y;
        EXPECT_EQ(region.unlit, expected.unlit) << what << " at " << x << " " << y;
        EXPECT_EQ(turns.begin()->second, 1) << what << " at " << x << " " << y;
    }
}

TEST(VisibleMap, ShowsLikeBruteForceWhatLiesInLayersOnFewPoints) {
    for (std::uint64_t seed = 0; seed < 300 && !HasFailure(); ++seed)
        expect_like_brute_force(
            layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4)),
            seed,
            60,
            "seed " + std::to_string(seed));
}

/// Adds shadows of three lights on sources of the scene, with corners on the same points, and lets
/// a fourth light reach some of them nowhere.
ScreenScene with_shadows(ScreenScene scene, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const std::size_t surfaces = scene.triangles.size();
    const auto any = [&] { return scene.triangles[random() % surfaces]; };
    for (std::size_t i = 0; i < 2 * surfaces; ++i)
        add_triangle(
            scene,
            {any().vertices[0], any().vertices[1], any().vertices[2]},
            any().source,
            static_cast<std::uint32_t>(random() % 3));
    // A shadow lies on its source, which here may be anywhere: as near as what is nearest.
    for (std::size_t i = surfaces; i < scene.triangles.size(); ++i) {
        for (std::uint32_t& vertex : scene.triangles[i].vertices) {
            scene.vertices.push_back({scene.vertices[vertex].point, depth_size});
            vertex = static_cast<std::uint32_t>(scene.vertices.size() - 1);
        }
        scene.triangles[i].plane = scene.triangles[i].vertices;
    }
    scene.unlit.resize(2000);
    for (LightSet& unlit : scene.unlit)
        unlit = random() % 3 == 0 ? 8 : 0;
    return scene;
}

TEST(VisibleMap, ShowsLikeBruteForceWhereLightsReach) {
    for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed) {
        ScreenScene scene =
            with_shadows(layers(seed, 1 + seed % 30, std::int32_t{1} << (1 + seed % 4)), seed);
        if (seed % 2 == 0)
            sort_by_place(scene);
        expect_like_brute_force(scene, seed, 60, "seed " + std::to_string(seed));
    }
}

TEST(VisibleMap, ShowsLikeBruteForceWhatIsScattered) {
    for (std::uint64_t seed = 0; seed < 12 && !HasFailure(); ++seed)
        expect_like_brute_force(
            scattered(seed, 400, screen_size >> (seed % 6)),
            seed,
            300,
            "seed " + std::to_string(seed));
}

TEST(VisibleMap, ShowsLikeBruteForceATerrain) {
    for (std::uint64_t seed = 0; seed < 6 && !HasFailure(); ++seed)
        expect_like_brute_force(
            terrain(seed, 4 << (seed % 4)), seed, 300, "seed " + std::to_string(seed));
}

TEST(VisibleMap, IsTheSameForAnyNumberOfThreadsAndOrderOfTriangles) {
    ScreenScene scene = scattered(3, 3000, screen_size / 16);
    sort_by_place(scene);
    const VisiblePieces expected = [&] {
        const ThreadLimit one(1);
        return cell_raster(scene);
    }();
    const VisiblePieces found = cell_raster(scene);
    ASSERT_EQ(found.pieces.size(), expected.pieces.size());
    for (std::size_t i = 0; i < found.pieces.size(); ++i) {
        EXPECT_EQ(found.points[found.pieces[i].from], expected.points[expected.pieces[i].from]);
        EXPECT_EQ(found.points[found.pieces[i].to], expected.points[expected.pieces[i].to]);
        EXPECT_EQ(found.pieces[i].left, expected.pieces[i].left);
        EXPECT_EQ(found.pieces[i].right, expected.pieces[i].right);
    }
    const double area = area_of(visible_map(scene, expected));
    const ScreenScene unsorted = scattered(3, 3000, screen_size / 16);
    EXPECT_NEAR(area_of(visible_map(unsorted, cell_raster(unsorted))) / area, 1, 1e-12);
}

void expect_same_pieces(
    const VisiblePieces& found, const VisiblePieces& expected, const std::string& what) {
    EXPECT_TRUE(found.points == expected.points) << what;
    EXPECT_TRUE(found.penetrating == expected.penetrating) << what;
    ASSERT_EQ(found.pieces.size(), expected.pieces.size()) << what;
    for (std::size_t i = 0; i < found.pieces.size(); ++i) {
        const VisiblePiece& a = found.pieces[i];
        const VisiblePiece& b = expected.pieces[i];
        const UnlitBeside of_a = found.unlit_beside(i);
        const UnlitBeside of_b = expected.unlit_beside(i);
        ASSERT_TRUE(
            a.from == b.from && a.to == b.to && a.edge == b.edge && a.left == b.left
            && a.right == b.right && of_a.left == of_b.left && of_a.right == of_b.right)
            << what << ", piece " << i;
    }
}

TEST(VisiblePieces, OfACutSceneAreThoseThatWereKeptAndThoseNearTheCuts) {
    std::size_t rounds = 0;
    std::size_t kept = 0; // rounds in which not all was near what was cut
    for (std::uint64_t seed = 0; seed < 60 && !HasFailure(); ++seed) {
        ScreenScene scene = tangle(seed, 3 + seed % 40, seed % 3 == 0 ? 8 : 0);
        const ScreenScene beside = scattered(seed, 200, screen_size / 40);
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        scene.vertices.insert(scene.vertices.end(), beside.vertices.begin(), beside.vertices.end());
        for (const ScreenTriangle& triangle : beside.triangles) {
            const auto [a, b, c] = triangle.vertices;
            add_triangle(scene, {first + a, first + b, first + c}, 1000 + triangle.source);
        }
        VisiblePieces pieces = cell_raster(scene);
        for (int round = 0; round < 3 && !pieces.penetrating.empty(); ++round, ++rounds) {
            const SceneChange change = cut_penetrations(scene, pieces.penetrating);
            kept += change.triangles.size() < scene.triangles.size() / 2 ? 1 : 0;
            pieces = cell_raster_after(change, {}, std::move(pieces), scene);
            expect_same_pieces(pieces, cell_raster(scene), "seed " + std::to_string(seed));
        }
    }
    EXPECT_GT(rounds, 60U);
    EXPECT_GT(kept, 30U);
}

TEST(VisiblePieces, OfASceneWithShadowsAreThoseThatWereKeptAndThoseNearThem) {
    for (std::uint64_t seed = 0; seed < 60 && !HasFailure(); ++seed) {
        ScreenScene scene = scattered(seed, 5 + 10 * (seed % 20), screen_size / 8);
        VisiblePieces before = cell_raster(scene);
        const std::size_t surfaces = scene.triangles.size();
        SceneChange change;
        if (seed % 4 == 0) // without shadows, where the light reaches none of a source
            scene.unlit = {0, 1, 0, 3};
        for (std::size_t i = 0; i < surfaces; i += 1 + seed % 7) {
            const ScreenTriangle on = scene.triangles[i];
            ScreenVertex middle = corners_of(scene, on)[2];
            middle.point.x = (middle.point.x + corners_of(scene, on)[0].point.x) / 2;
            scene.vertices.push_back(middle);
            const auto last = static_cast<std::uint32_t>(scene.vertices.size() - 1);
            if (seed % 4 != 0)
                add_part(
                    scene,
                    {on.vertices[0], on.vertices[1], last},
                    on,
                    static_cast<std::uint32_t>(seed % 2));
        }
        for (std::size_t i = surfaces; i < scene.triangles.size(); ++i)
            change.triangles.push_back(static_cast<std::uint32_t>(i));
        expect_same_pieces(
            cell_raster_after(change, {}, std::move(before), scene),
            cell_raster(scene),
            "seed " + std::to_string(seed));
    }
}

/// The ways along pieces, way by way as they are explained: number 2 i goes along piece i, and the
/// next one back.
class PlainWays {
public:
    PlainWays(const ScreenScene& scene, const VisiblePieces& pieces)
        : scene_(scene)
        , pieces_(pieces) {}

    std::size_t count() const { return 2 * pieces_.pieces.size(); }

    std::uint32_t from(std::size_t way) const {
        const VisiblePiece& piece = pieces_.pieces[way / 2];
        return way % 2 == 0 ? piece.from : piece.to;
    }

    ScreenStep direction(std::size_t way) const {
        const ScreenEdges::Edge& edge = pieces_.pieces[way / 2].edge;
        const ScreenPoint begin = scene_.vertices[edge.begin].point;
        const ScreenPoint end = scene_.vertices[edge.end].point;
        return way % 2 == 0 ? step(begin, end) : step(end, begin);
    }

    /// What is seen on the left.
    std::optional<VisibleMap::Region> region(std::size_t way) const {
        const VisiblePiece& piece = pieces_.pieces[way / 2];
        const UnlitBeside unlit = pieces_.unlit_beside(way / 2);
        const std::uint32_t triangle = way % 2 == 0 ? piece.left : piece.right;
        if (triangle == no_triangle)
            return std::nullopt;
        return VisibleMap::Region{
            scene_.triangles[triangle].source, way % 2 == 0 ? unlit.left : unlit.right};
    }

    /// Of those that leave the way's end, the first to the right of the way back.
    std::size_t following(std::size_t way) const {
        const std::size_t back = way ^ 1U;
        std::size_t best = back;
        double least = 7; // more than a whole turn
        for (std::size_t i = 0; i < count(); ++i) {
            const double turn = angle(direction(back)) - angle(direction(i));
            const double to_the_right = turn <= 0 ? turn + 2 * std::acos(-1.0) : turn;
            if (i != back && from(i) == from(back) && to_the_right < least) {
                least = to_the_right;
                best = i;
            }
        }
        return best;
    }

private:
    static double angle(ScreenStep a) {
        return std::atan2(static_cast<double>(a.y), static_cast<double>(a.x));
    }

    const ScreenScene& scene_;
    const VisiblePieces& pieces_;
};

/// The rings of a map one after the other, region by region, and what is beyond each side.
struct PlainRing {
    VisibleMap::Region region;
    std::vector<std::uint32_t> vertices;
    std::vector<std::optional<VisibleMap::Region>> across;

    friend bool operator==(const PlainRing&, const PlainRing&) = default;
};

std::vector<PlainRing> plain_rings(const ScreenScene& scene, const VisiblePieces& pieces) {
    const PlainWays ways(scene, pieces);
    std::vector<PlainRing> rings;
    std::vector<bool> done(ways.count());
    for (std::size_t first = 0; first < ways.count(); ++first) {
        if (done[first] || !ways.region(first))
            continue;
        PlainRing& ring = rings.emplace_back();
        ring.region = *ways.region(first);
        for (std::size_t way = first; !done[way];) {
            done[way] = true;
            const std::size_t next = ways.following(way);
            if (cross(ways.direction(way), ways.direction(next)) != 0
                || ways.region(way ^ 1U) != ways.region(next ^ 1U)) {
                ring.vertices.push_back(ways.from(next));
                ring.across.push_back(ways.region(next ^ 1U));
            }
            way = next;
        }
    }
    std::stable_sort(rings.begin(), rings.end(), [](const PlainRing& a, const PlainRing& b) {
        return a.region < b.region;
    });
    return rings;
}

std::vector<PlainRing> rings_of(const VisibleMap& map) {
    std::vector<PlainRing> rings;
    std::size_t place = 0;
    for (const VisibleMap::Ring& ring : map.rings) {
        EXPECT_EQ(ring.first, place) << "one ring's vertices are behind the other's";
        EXPECT_EQ(ring.source, map.regions[ring.region].source);
        PlainRing& plain = rings.emplace_back();
        plain.region = map.regions[ring.region];
        for (; place < ring.first + ring.count; ++place) {
            plain.vertices.push_back(map.ring_vertices[place]);
            const std::uint32_t across = map.ring_across[place];
            plain.across.push_back(
                across == no_region ? std::nullopt : std::optional(map.regions[across]));
        }
    }
    EXPECT_EQ(place, map.ring_vertices.size());
    return rings;
}

TEST(VisibleMap, HasTheRingsThatAPlainWalkFinds) {
    std::size_t rings = 0;
    for (std::uint64_t seed = 0; seed < 120 && !HasFailure(); ++seed) {
        ScreenScene scene = seed % 2 == 0
            ? layers(seed, 1 + seed % 25, std::int32_t{1} << (1 + seed % 4))
            : scattered(seed, 5 + seed % 40, screen_size / 4);
        const VisiblePieces pieces = cell_raster(scene);
        const VisibleMap map = visible_map(scene, pieces);
        ASSERT_EQ(map.joined, 0U);
        const std::vector<PlainRing> expected = plain_rings(scene, pieces);
        EXPECT_TRUE(rings_of(map) == expected) << "seed " << seed;
        rings += expected.size();
    }
    EXPECT_GT(rings, 1000U);
}

TEST(VisibleMap, OfWhatIsGivenAwayIsTheSameButForWhatIsNotAskedFor) {
    std::size_t joined = 0;
    for (std::uint64_t seed = 0; seed < 40 && !HasFailure(); ++seed) {
        ScreenScene scene =
            seed % 2 == 0 ? layers(seed, 30, 8) : tangle(seed, 20); // not cut: ways are joined
        VisiblePieces pieces = cell_raster(scene);
        const VisibleMap expected = visible_map(scene, pieces);
        const RingDetail detail =
            seed % 4 < 2 ? RingDetail::with_across : RingDetail::without_across;
        const VisibleMap map = visible_map(std::move(scene), std::move(pieces), detail);
        EXPECT_TRUE(map.vertices == expected.vertices) << seed;
        EXPECT_EQ(map.regions, expected.regions) << seed;
        EXPECT_EQ(map.ring_vertices, expected.ring_vertices) << seed;
        EXPECT_EQ(map.joined, expected.joined) << seed;
        EXPECT_EQ(map.joined_sides, expected.joined_sides) << seed;
        ASSERT_EQ(map.rings.size(), expected.rings.size()) << seed;
        for (std::size_t i = 0; i < map.rings.size(); ++i) {
            EXPECT_EQ(map.rings[i].source, expected.rings[i].source) << seed;
            EXPECT_EQ(map.rings[i].region, expected.rings[i].region) << seed;
            EXPECT_EQ(map.rings[i].first, expected.rings[i].first) << seed;
            EXPECT_EQ(map.rings[i].count, expected.rings[i].count) << seed;
        }
        if (detail == RingDetail::with_across)
            EXPECT_EQ(map.ring_across, expected.ring_across) << seed;
        else
            EXPECT_TRUE(map.ring_across.empty()) << seed;
        EXPECT_FALSE(expected.ring_across.empty()) << seed;
        joined += map.joined;
    }
    EXPECT_GT(joined, 0U);
}

TEST(VisibleMap, OfNothingIsEmptyAndOfOneTriangleIsItself) {
    EXPECT_TRUE(visible_map({}, cell_raster({})).rings.empty());
    ScreenScene scene;
    scene.vertices = {
        {{0, 0}, 5}, {{screen_size, 0}, 5}, {{0, screen_size}, 5}, {{screen_size, screen_size}, 9}};
    add_triangle(scene, {0, 1, 2}, 4);
    VisibleMap map = visible_map(scene, cell_raster(scene));
    ASSERT_EQ(map.rings.size(), 1U);
    EXPECT_EQ(map.rings[0].source, 4U);
    EXPECT_EQ(map.rings[0].count, 3U);
    EXPECT_EQ(doubled_area(map, map.rings[0]), std::ldexp(1.0, 2 * screen_bits));
    // The other half of the frame, of the same source: one region of four corners.
    add_triangle(scene, {1, 2, 3}, 4);
    map = visible_map(scene, cell_raster(scene));
    ASSERT_EQ(map.rings.size(), 1U);
    EXPECT_EQ(map.rings[0].count, 4U);
}

TEST(VisibleMap, HoldsAThousandEdgesThroughOnePoint) {
    ScreenScene scene;
    const ScreenPoint middle = {screen_size / 2, screen_size / 2};
    constexpr std::int32_t count = 500;
    for (std::int32_t i = 0; i < count; ++i) {
        // Slivers with their tip in the middle, each a bit nearer.
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        const std::int32_t along = i * (screen_size / count);
        scene.vertices.push_back({middle, i});
        scene.vertices.push_back({{along, i % 2 == 0 ? 0 : screen_size}, i});
        scene.vertices.push_back(
            {{along + screen_size / count * 2 / 3, i % 2 == 0 ? 0 : screen_size}, i});
        add_triangle(scene, {first, first + 1, first + 2}, static_cast<std::uint32_t>(i));
    }
    expect_like_brute_force(scene, 1, 500, "star");
    const VisibleMap map = visible_map(scene, cell_raster(scene));
    EXPECT_EQ(map.rings.size(), std::size_t{count});
}

TEST(ScreenScene, KeepsTheFirstOfTheTextOfTrianglesInOnePlace) {
    ScreenScene scene;
    scene.vertices = {{{0, 0}, 5}, {{screen_size, 0}, 5}, {{0, screen_size}, 5}};
    add_triangle(scene, {0, 1, 2}, 7);
    add_triangle(scene, {2, 0, 1}, 3);
    add_triangle(scene, {1, 0, 2}, 5);
    sort_by_place(scene);
    ASSERT_EQ(scene.triangles.size(), 1U);
    EXPECT_EQ(scene.triangles[0].source, 3U);
}

/// What is seen at the point and, if it is the same, some steps of the grid around it.
std::optional<SeenAt>
seen_around(const ScreenScene& scene, std::int64_t x_in_halves, std::int64_t y_in_halves) {
    const SeenAt middle = seen_at(scene, x_in_halves, y_in_halves);
    constexpr std::int64_t off = 8;
    for (const auto& [x, y] : {std::pair{off, off}, {-off, off}, {off, -off}, {-off, -off}})
        if (seen_at(scene, x_in_halves + x, y_in_halves + y).source != middle.source)
            return std::nullopt;
    return middle;
}

/// The map after cutting shows at points away from borders what asking every triangle tells.
void expect_like_brute_force_after_cutting(
    const ScreenScene& scene, std::uint64_t seed, int points, const std::string& what) {
    ScreenScene cut = scene;
    const WholePieces whole = whole_pieces(cut);
    EXPECT_EQ(whole.left, 0U) << what;
    const VisibleMap map = visible_map(cut, whole.pieces);
    std::mt19937_64 random(seed);
    for (int i = 0; i < points && !::testing::Test::HasFailure(); ++i) {
        const auto x = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size})) | 1;
        const auto y = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size})) | 1;
        const auto expected = seen_around(scene, x, y);
        if (!expected)
            continue;
        const auto turns =
            turns_about(map, 0.5 * static_cast<double>(x), 0.5 * static_cast<double>(y));
        EXPECT_EQ(turns.size(), expected->source == no_source ? 0U : 1U) << what;
        if (!turns.empty()) {
            EXPECT_EQ(map.regions[turns.begin()->first].source, expected->source) << what;
            EXPECT_EQ(turns.begin()->second, 1) << what;
        }
    }
}

TEST(VisibleMap, ShowsLikeBruteForceWhatPenetratesButForAFewSteps) {
    for (std::uint64_t seed = 0; seed < 80 && !HasFailure(); ++seed)
        expect_like_brute_force_after_cutting(
            tangle(seed, 2 + seed % 30), seed, 100, "seed " + std::to_string(seed));
}

TEST(VisibleMap, JoinsWhatIsNearestWhereSurfacesPartAlongNearlyTheSameLine) {
    // Of two loose ends of a source, the first is far from any beginning, the second near one.
    expect_like_brute_force_after_cutting(tangle(2434, 16), 1, 3000, "tangle");
}

TEST(VisibleMap, TellsWhatPenetrates) {
    ScreenScene scene;
    scene.vertices = {
        {{0, 0}, 0},
        {{screen_size, 0}, depth_size},
        {{0, screen_size}, 0},
        {{100, 100}, depth_size / 2},
        {{screen_size - 500, 300}, depth_size / 2},
        {{200, screen_size / 2}, depth_size / 2}};
    add_triangle(scene, {0, 1, 2}, 0);
    add_triangle(scene, {3, 4, 5}, 1);
    EXPECT_EQ(cell_raster(scene).penetrating.size(), 1U);
}

} // namespace
} // namespace vera
