// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/map_locator.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "visible/maximal_pieces.h"
#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

// What is seen is the same however a scene lies on the grid, and however it is put together. Signs
// of whole numbers decide where things are, and margins far from all distances which of two is in
// front: so it is the same to the bit. Only what passes through another is cut at new corners,
// which are rounded to the grid, in a direction that moving the scene does not move with it.

namespace vera {
namespace {

using testing::maximal_pieces;
using testing::MaximalPiece;

/// A way to lay the scene differently on the grid: first x and y are swapped, then mirrored, then
/// shifted.
struct Motion {
    const char* name;
    bool swaps = false;
    bool mirrors_x = false;
    bool mirrors_y = false;
    ScreenPoint by = {};

    bool turns_sides() const { return swaps != (mirrors_x != mirrors_y); }
};

constexpr Motion motions[] = {
    {"x mirrored", false, true},
    {"y mirrored", false, false, true},
    {"x and y swapped", true},
    {"a quarter turn", true, true},
};

ScreenPoint moved(ScreenPoint point, const Motion& motion) {
    if (motion.swaps)
        std::swap(point.x, point.y);
    return {
        (motion.mirrors_x ? screen_size - point.x : point.x) + motion.by.x,
        (motion.mirrors_y ? screen_size - point.y : point.y) + motion.by.y};
}

/// The fraction that stands behind a whole number, from the other end.
void mirror(std::int32_t& whole, std::int64_t& numerator, std::int64_t denominator) {
    whole = screen_size - whole - (numerator == 0 ? 0 : 1);
    numerator = numerator == 0 ? 0 : denominator - numerator;
}

RationalPoint moved(RationalPoint point, const Motion& motion) {
    if (motion.swaps) {
        std::swap(point.whole.x, point.whole.y);
        std::swap(point.x_numerator, point.y_numerator);
    }
    if (motion.mirrors_x)
        mirror(point.whole.x, point.x_numerator, point.denominator);
    if (motion.mirrors_y)
        mirror(point.whole.y, point.y_numerator, point.denominator);
    point.whole.x += motion.by.x;
    point.whole.y += motion.by.y;
    return point;
}

/// The scene with other vertices, and without what has no area with them.
ScreenScene
rebuilt(const ScreenScene& scene, std::vector<ScreenVertex> vertices, bool turns_sides = false) {
    ScreenScene result;
    result.vertices = std::move(vertices);
    result.unlit = scene.unlit;
    for (ScreenTriangle triangle : scene.triangles) {
        if (turns_sides)
            std::swap(triangle.plane[1], triangle.plane[2]);
        if (triangle.is_shadow())
            add_part(result, triangle.vertices, triangle, triangle.light);
        else
            add_triangle(result, triangle.vertices, triangle.source);
    }
    return result;
}

ScreenScene moved(const ScreenScene& scene, const Motion& motion) {
    std::vector<ScreenVertex> vertices = scene.vertices;
    for (ScreenVertex& vertex : vertices)
        vertex.point = moved(vertex.point, motion);
    return rebuilt(scene, std::move(vertices), motion.turns_sides());
}

/// In the quarter of the picture at its origin: it can be shifted by half the picture.
ScreenScene halved(const ScreenScene& scene) {
    std::vector<ScreenVertex> vertices = scene.vertices;
    for (ScreenVertex& vertex : vertices)
        vertex.point = {vertex.point.x / 2, vertex.point.y / 2};
    return rebuilt(scene, std::move(vertices));
}

/// A ring without what it happens to begin with.
struct Outline {
    std::uint32_t source = 0;
    LightSet unlit = 0;
    std::vector<RationalPoint> points;

    friend bool operator==(const Outline&, const Outline&) = default;

    friend bool operator<(const Outline& a, const Outline& b) {
        if (a.source != b.source || a.unlit != b.unlit)
            return std::pair(a.source, a.unlit) < std::pair(b.source, b.unlit);
        return std::lexicographical_compare(
            a.points.begin(),
            a.points.end(),
            b.points.begin(),
            b.points.end(),
            [](const RationalPoint& p, const RationalPoint& q) { return order(p, q) < 0; });
    }
};

void begin_with_first(std::vector<RationalPoint>& points) {
    // A ring may come through its first point twice: the way that goes on with less is taken.
    std::vector<RationalPoint> best = points;
    for (std::size_t i = 1; i < points.size(); ++i) {
        std::rotate(points.begin(), points.begin() + 1, points.end());
        if (Outline{0, 0, points} < Outline{0, 0, best})
            best = points;
    }
    points = std::move(best);
}

/// What is seen, in an order that is no matter of numbers.
struct Seen {
    std::vector<MaximalPiece> pieces;
    std::vector<Outline> outlines;
};

using Engine = VisiblePieces (*)(const ScreenScene&);

VisiblePieces by_cells(const ScreenScene& scene) {
    return cell_raster(scene);
}

VisiblePieces by_sweep(const ScreenScene& scene) {
    return plane_sweep(scene);
}

constexpr std::pair<const char*, Engine> engines[] = {{"cells", by_cells}, {"sweep", by_sweep}};

Seen seen(const ScreenScene& scene, Engine engine) {
    const VisiblePieces found = engine(scene);
    EXPECT_TRUE(found.penetrating.empty());
    const VisibleMap map = visible_map(scene, found);
    EXPECT_EQ(map.joined, 0U);
    Seen result = {maximal_pieces(scene, found), {}};
    for (const VisibleMap::Ring& ring : map.rings) {
        Outline& outline = result.outlines.emplace_back();
        outline.source = ring.source;
        outline.unlit = map.regions[ring.region].unlit;
        for (const std::uint32_t vertex : map.vertices_of(ring))
            outline.points.push_back(map.vertices[vertex]);
        begin_with_first(outline.points);
    }
    std::sort(result.outlines.begin(), result.outlines.end());
    return result;
}

Seen moved(Seen seen, const Motion& motion) {
    for (MaximalPiece& piece : seen.pieces) {
        piece.from = moved(piece.from, motion);
        piece.to = moved(piece.to, motion);
        if (motion.turns_sides())
            std::swap(piece.left, piece.right);
        if (order(piece.to, piece.from) < 0) {
            std::swap(piece.from, piece.to);
            std::swap(piece.left, piece.right);
        }
    }
    std::sort(seen.pieces.begin(), seen.pieces.end());
    for (Outline& outline : seen.outlines) {
        for (RationalPoint& point : outline.points)
            point = moved(point, motion);
        if (motion.turns_sides())
            std::reverse(outline.points.begin(), outline.points.end());
        begin_with_first(outline.points);
    }
    std::sort(seen.outlines.begin(), seen.outlines.end());
    return seen;
}

void expect_same(const Seen& expected, const Seen& found, const std::string& what) {
    EXPECT_EQ(expected.pieces.size(), found.pieces.size()) << what;
    EXPECT_TRUE(expected.pieces == found.pieces) << what;
    EXPECT_EQ(expected.outlines.size(), found.outlines.size()) << what;
    EXPECT_TRUE(expected.outlines == found.outlines) << what;
}

using Test = std::function<void(const ScreenScene& scene, std::uint64_t seed, const std::string&)>;

/// Corners on so few points that sides lie on each other, in layers; and with everything in one
/// plane, where the number of the source alone tells what is in front.
void for_few_points(const Test& test) {
    for (std::uint64_t seed = 0; seed < 80 && !::testing::Test::HasFailure(); ++seed) {
        ScreenScene scene = testing::layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4));
        if (seed % 5 == 4)
            for (ScreenVertex& vertex : scene.vertices)
                vertex.nearness = std::int64_t{vertex.point.x} + 2 * vertex.point.y;
        test(scene, seed, "layers " + std::to_string(seed));
    }
}

/// Scenes without any coincidence, slivers, holes within holes, and many edges through one point.
void for_others(const Test& test) {
    for (std::uint64_t seed = 0; seed < 6 && !::testing::Test::HasFailure(); ++seed) {
        test(
            testing::scattered(seed, 200, screen_size >> (seed % 5)),
            seed,
            "scattered " + std::to_string(seed));
        test(
            testing::balls(seed, 1 + seed % 4, 3 + static_cast<std::int32_t>(seed)),
            seed,
            "balls " + std::to_string(seed));
        test(testing::terrain(seed, 4 << (seed % 3)), seed, "terrain " + std::to_string(seed));
    }
    for (std::uint64_t seed = 0; seed < 40 && !::testing::Test::HasFailure(); ++seed)
        test(testing::slivers(seed, 2 + seed % 30), seed, "slivers " + std::to_string(seed));
    for (std::int32_t count = 1; count < 12; ++count)
        test(testing::nested_holes(count), 1, "holes " + std::to_string(count));
    test(testing::star(60), 1, "star");
}

void for_all(const Test& test) {
    for_few_points(test);
    for_others(test);
}

TEST(Invariance, TheSameIsSeenHoweverTheSceneIsMirroredAndTurned) {
    for_all([](const ScreenScene& scene, std::uint64_t, const std::string& what) {
        for (const auto& [name, engine] : engines) {
            const Seen expected = seen(scene, engine);
            for (const Motion& motion : motions)
                expect_same(
                    moved(expected, motion),
                    seen(moved(scene, motion), engine),
                    what + ", " + motion.name + ", " + name);
        }
    });
}

TEST(Invariance, TheSameBordersAreSeenWhereTheOrderOfPlanesIsNotTransitive) {
    // Planes two depths apart are coincident, planes six apart are not. Borders need not close
    // then, and how their ends are joined is a matter of how the scene lies.
    for (std::uint64_t seed = 0; seed < 100 && !HasFailure(); ++seed) {
        ScreenScene scene = testing::layers(seed, 2 + seed % 40, std::int32_t{1} << (1 + seed % 4));
        for (const ScreenTriangle& triangle : scene.triangles)
            for (const std::uint32_t i : triangle.vertices)
                scene.vertices[i].nearness = 1000 + triangle.source % 7;
        for (const auto& [name, engine] : engines) {
            const Seen expected = {maximal_pieces(scene, engine(scene)), {}};
            for (const Motion& motion : motions) {
                const ScreenScene other = moved(scene, motion);
                const Seen found = {maximal_pieces(other, engine(other)), {}};
                expect_same(
                    moved(expected, motion),
                    found,
                    "seed " + std::to_string(seed) + ", " + motion.name + ", " + name);
            }
        }
    }
}

TEST(Invariance, TheSameIsSeenWhereverTheSceneIsShifted) {
    for_all([](const ScreenScene& whole, std::uint64_t seed, const std::string& what) {
        const ScreenScene scene = halved(whole);
        std::mt19937_64 random(seed);
        for (const auto& [name, engine] : engines) {
            const Seen expected = seen(scene, engine);
            for (int i = 0; i < 3; ++i) {
                Motion motion = {"shifted"};
                // By some steps, so that cells' borders come to lie elsewhere in it, or by many.
                const std::uint64_t most = i == 0 ? 3 : screen_size / 2 + 1;
                motion.by = {
                    static_cast<std::int32_t>(random() % most),
                    static_cast<std::int32_t>(random() % most)};
                expect_same(
                    moved(expected, motion),
                    seen(moved(scene, motion), engine),
                    what + ", shifted by " + std::to_string(motion.by.x) + " "
                        + std::to_string(motion.by.y) + ", " + name);
            }
        }
    });
}

/// The same triangles and vertices, numbered anew, each triangle beginning with any of its corners.
ScreenScene shuffled(const ScreenScene& scene, std::mt19937_64& random) {
    std::vector<std::uint32_t> number(scene.vertices.size());
    std::iota(number.begin(), number.end(), 0U);
    std::shuffle(number.begin(), number.end(), random);
    std::vector<ScreenTriangle> triangles = scene.triangles;
    std::shuffle(triangles.begin(), triangles.end(), random);
    ScreenScene result;
    result.vertices.resize(scene.vertices.size());
    result.unlit = scene.unlit;
    for (std::size_t i = 0; i < number.size(); ++i)
        result.vertices[number[i]] = scene.vertices[i];
    for (ScreenTriangle& triangle : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            triangle.vertices[i] = number[triangle.vertices[i]];
            triangle.plane[i] = number[triangle.plane[i]];
        }
        std::shuffle(triangle.vertices.begin(), triangle.vertices.end(), random);
        if (triangle.is_shadow())
            add_part(result, triangle.vertices, triangle, triangle.light);
        else
            add_triangle(result, triangle.vertices, triangle.source);
    }
    return result;
}

TEST(Invariance, TheSameIsSeenInWhateverOrderTrianglesAndTheirCornersCome) {
    for_all([](const ScreenScene& scene, std::uint64_t seed, const std::string& what) {
        std::mt19937_64 random(seed);
        const std::array<ScreenScene, 2> others = {
            shuffled(scene, random), shuffled(scene, random)};
        for (const auto& [name, engine] : engines) {
            const Seen expected = seen(scene, engine);
            for (const ScreenScene& other : others)
                expect_same(expected, seen(other, engine), what + ", " + name);
        }
    });
}

/// The scene with shadows of three lights on some of its triangles, with corners among those of
/// all: they reach beyond their faces, lie on each other and end at borders. And some of the faces
/// get nothing of a light.
ScreenScene shadowed(ScreenScene scene, std::mt19937_64& random) {
    const std::size_t surfaces = scene.triangles.size();
    const std::size_t vertices = scene.vertices.size();
    std::uint32_t most = 0;
    for (std::size_t i = 0; i < surfaces; ++i)
        most = std::max(most, scene.triangles[i].source);
    scene.unlit.resize(most + 1);
    for (std::size_t i = 0; i < surfaces; ++i) {
        const ScreenTriangle on = scene.triangles[i];
        if (random() % 8 == 0)
            scene.unlit[on.source] = LightSet{1} << random() % 3;
        for (std::uint64_t count = random() % 4; count > 0; --count) {
            std::array<std::uint32_t, 3> corners;
            for (std::uint32_t& corner : corners)
                corner = random() % 2 == 0 ? on.vertices[random() % 3]
                                           : static_cast<std::uint32_t>(random() % vertices);
            add_part(scene, corners, on, static_cast<std::uint32_t>(random() % 3));
        }
    }
    return scene;
}

TEST(Invariance, TheSameShadowsAreSeenHoweverTheSceneLiesAndInWhateverOrder) {
    std::size_t unlit = 0;
    for_all([&](const ScreenScene& whole, std::uint64_t seed, const std::string& what) {
        std::mt19937_64 random(seed);
        const ScreenScene scene = shadowed(whole, random);
        const Seen expected = seen(scene, by_cells);
        for (const Outline& outline : expected.outlines)
            unlit += outline.unlit != 0 ? 1 : 0;
        for (const Motion& motion : motions)
            expect_same(
                moved(expected, motion),
                seen(moved(scene, motion), by_cells),
                what + ", " + motion.name);
        expect_same(expected, seen(shuffled(scene, random), by_cells), what + ", shuffled");
    });
    EXPECT_GT(unlit, 2500U);
}

/// Every triangle in parts, which have its plane: round a point in it, or on both sides of the
/// middle of a side, where neighbours are not split.
ScreenScene split(const ScreenScene& scene, std::mt19937_64& random) {
    ScreenScene result;
    result.vertices = scene.vertices;
    const auto add_vertex = [&](ScreenPoint point) {
        result.vertices.push_back({point, 0}); // planes are those of the whole
        return static_cast<std::uint32_t>(result.vertices.size() - 1);
    };
    for (const ScreenTriangle& triangle : scene.triangles) {
        const auto [a, b, c] = triangle.vertices;
        const auto corners = corners_of(scene, triangle);
        const auto mean = [&](auto coordinate, std::int64_t u, std::int64_t v, std::int64_t w) {
            return static_cast<std::int32_t>(
                (u * coordinate(corners[0]) + v * coordinate(corners[1])
                 + w * coordinate(corners[2]))
                / (u + v + w));
        };
        const auto point = [&](std::int64_t u, std::int64_t v, std::int64_t w) {
            return ScreenPoint{
                mean([](const ScreenVertex& vertex) { return vertex.point.x; }, u, v, w),
                mean([](const ScreenVertex& vertex) { return vertex.point.y; }, u, v, w)};
        };
        const auto weight = [&] { return static_cast<std::int64_t>(1 + random() % 3); };
        const ScreenPoint inner = point(weight(), weight(), weight());
        const ScreenPoint middle = point(1, 1, 0);
        const bool is_inside = orientation(corners[0].point, corners[1].point, inner) > 0
            && orientation(corners[1].point, corners[2].point, inner) > 0
            && orientation(corners[2].point, corners[0].point, inner) > 0;
        if (is_inside && random() % 3 != 0) {
            const std::uint32_t d = add_vertex(inner);
            add_part(result, {a, b, d}, triangle);
            add_part(result, {b, c, d}, triangle);
            add_part(result, {c, a, d}, triangle);
        } else if (
            orientation(corners[0].point, corners[1].point, middle) == 0
            && middle != corners[0].point && middle != corners[1].point) {
            const std::uint32_t d = add_vertex(middle);
            add_part(result, {a, d, c}, triangle);
            add_part(result, {d, b, c}, triangle);
        } else {
            add_part(result, {a, b, c}, triangle);
        }
    }
    return result;
}

TEST(Invariance, TheSameIsSeenWhenEveryTriangleIsSplit) {
    std::size_t whole = 0;
    std::size_t parts = 0;
    for_all([&](const ScreenScene& scene, std::uint64_t seed, const std::string& what) {
        std::mt19937_64 random(seed);
        const ScreenScene once = split(scene, random);
        const ScreenScene twice = split(once, random);
        whole += scene.triangles.size();
        parts += twice.triangles.size();
        for (const auto& [name, engine] : engines) {
            const Seen expected = seen(scene, engine);
            expect_same(expected, seen(once, engine), what + ", once, " + name);
            expect_same(expected, seen(twice, engine), what + ", twice, " + name);
        }
    });
    EXPECT_GT(parts, 5 * whole);
}

/// Two triangles over the whole picture, at that nearness.
void add_wall(ScreenScene& scene, std::int64_t nearness, std::uint32_t source) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const ScreenPoint point :
         {ScreenPoint{0, 0},
          ScreenPoint{screen_size, 0},
          ScreenPoint{screen_size, screen_size},
          ScreenPoint{0, screen_size}})
        scene.vertices.push_back({point, nearness});
    add_triangle(scene, {first, first + 1, first + 2}, source);
    add_triangle(scene, {first, first + 2, first + 3}, source);
}

TEST(Invariance, TheSameIsSeenWhateverLiesBehindAWall) {
    constexpr std::uint32_t wall = 1'000'000;
    for_all([](const ScreenScene& whole, std::uint64_t seed, const std::string& what) {
        // The scene in the nearer half of all depths.
        ScreenScene scene = whole;
        for (ScreenVertex& vertex : scene.vertices)
            vertex.nearness = depth_size / 2 + 16 + vertex.nearness / 4;
        add_wall(scene, depth_size / 2, wall);
        // Behind it triangles on few points, which pass through each other: nobody sees that.
        ScreenScene more = scene;
        const ScreenScene hidden = testing::tangle(seed, 5 + seed % 20, 8);
        for (const ScreenTriangle& triangle : hidden.triangles) {
            std::array<std::uint32_t, 3> corners;
            for (std::size_t i = 0; i < 3; ++i) {
                const ScreenVertex& vertex = hidden.vertices[triangle.vertices[i]];
                corners[i] = static_cast<std::uint32_t>(more.vertices.size());
                more.vertices.push_back({vertex.point, vertex.nearness / 4});
            }
            add_triangle(more, corners, wall + 1 + triangle.source);
        }
        for (const auto& [name, engine] : engines)
            expect_same(seen(scene, engine), seen(more, engine), what + ", " + name);
    });
}

/// What is seen of a scene after it was cut, to be asked at points.
struct CutScene {
    CutScene(ScreenScene scene, VisibilityEngine engine)
        : whole(whole_pieces(scene, {}, nullptr, engine))
        , map(visible_map(scene, whole.pieces))
        , locator(map) {}

    WholePieces whole;
    VisibleMap map;
    MapLocator locator;
};

TEST(Invariance, WhatIsCutIsSeenInTheSamePlacesButForAFewSteps) {
    constexpr double reach = 8; // steps
    std::size_t compared = 0;
    for (std::uint64_t seed = 0; seed < 60 && !HasFailure(); ++seed) {
        const ScreenScene scene = testing::tangle(seed, 2 + seed % 20, seed % 2 == 0 ? 0 : 8);
        for (const VisibilityEngine engine : {VisibilityEngine::cells, VisibilityEngine::sweep}) {
            const CutScene expected(scene, engine);
            EXPECT_EQ(expected.whole.left, 0U);
            for (const Motion& motion : motions) {
                const CutScene found(moved(scene, motion), engine);
                std::mt19937_64 random(seed);
                for (int i = 0; i < 50; ++i) {
                    const ScreenPoint at = {
                        static_cast<std::int32_t>(random() % screen_size),
                        static_cast<std::int32_t>(random() % screen_size)};
                    if (expected.locator.has_side_near(at.x, at.y, reach, reach))
                        continue;
                    const ScreenPoint there = moved(at, motion);
                    const MapPlace here = expected.locator.at(at.x, at.y);
                    const MapPlace place = found.locator.at(there.x, there.y);
                    EXPECT_TRUE(here.is_sound && place.is_sound) << "seed " << seed;
                    EXPECT_EQ(here.source, place.source)
                        << "seed " << seed << ", " << motion.name << " at " << at.x << " " << at.y;
                    ++compared;
                }
            }
        }
    }
    EXPECT_GT(compared, 20000U);
}

} // namespace
} // namespace vera
