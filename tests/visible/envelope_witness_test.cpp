// SPDX-License-Identifier: Apache-2.0
// CGAL's Envelope_3 as a witness of what is seen: another algorithm (divide and conquer), by other
// people, on exact fractions, which shares no line with ours.
#include "vera/visible/penetrations.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "visible/screen_scenes.h"
#include <CGAL/Env_surface_data_traits_3.h>
#include <CGAL/Env_triangle_traits_3.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/envelope_3.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::balls;
using testing::layers;
using testing::scattered;
using testing::tangle;
using testing::terrain;

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Point = Kernel::Point_2;
using Traits = CGAL::Env_surface_data_traits_3<CGAL::Env_triangle_traits_3<Kernel>, std::uint32_t>;
using Diagram = CGAL::Envelope_diagram_2<Traits>;
using Halfedge = Diagram::Halfedge_const_handle;

/// A part of the border of what is seen of a source, as long as it is straight and the same is seen
/// across: from where it begins to where it ends, what is seen on its left, and on its right.
struct Border {
    Point from;
    Point to;
    std::uint32_t left = 0;
    std::uint32_t right = 0;

    friend bool operator==(const Border&, const Border&) = default;

    friend bool operator<(const Border& a, const Border& b) {
        if (const auto order = CGAL::compare_xy(a.from, b.from); order != CGAL::EQUAL)
            return order == CGAL::SMALLER;
        if (const auto order = CGAL::compare_xy(a.to, b.to); order != CGAL::EQUAL)
            return order == CGAL::SMALLER;
        return std::tie(a.left, a.right) < std::tie(b.left, b.right);
    }
};

Diagram envelope(const ScreenScene& scene) {
    std::vector<Traits::Surface_3> triangles;
    for (const ScreenTriangle& triangle : scene.triangles) {
        std::vector<Kernel::Point_3> corners;
        for (const ScreenVertex& corner : corners_of(scene, triangle))
            corners.emplace_back(
                corner.point.x, corner.point.y, Number(static_cast<double>(corner.nearness)));
        triangles.emplace_back(
            CGAL::Env_triangle_traits_3<Kernel>::Surface_3(corners[0], corners[1], corners[2]),
            triangle.source);
    }
    Diagram diagram;
    CGAL::upper_envelope_3(triangles.begin(), triangles.end(), diagram);
    return diagram;
}

/// Of what coincides there the first in the text.
std::uint32_t source_of(Diagram::Face_const_handle face) {
    std::uint32_t source = no_source;
    for (auto surface = face->surfaces_begin(); surface != face->surfaces_end(); ++surface)
        source = std::min(source, surface->data());
    return source;
}

bool parts_sources(Halfedge edge) {
    return source_of(edge->face()) != source_of(edge->twin()->face());
}

/// The one before it on the border of what is seen on its left.
Halfedge previous_border(Halfedge edge) {
    for (edge = edge->prev(); !parts_sources(edge); edge = edge->twin()->prev())
        ;
    return edge;
}

Halfedge next_border(Halfedge edge) {
    for (edge = edge->next(); !parts_sources(edge); edge = edge->twin()->next())
        ;
    return edge;
}

bool goes_on(Halfedge edge, Halfedge next) {
    const Point& from = edge->source()->point();
    const Point& by = edge->target()->point();
    const Point& to = next->target()->point();
    return source_of(edge->twin()->face()) == source_of(next->twin()->face())
        && CGAL::collinear(from, by, to) && CGAL::are_strictly_ordered_along_line(from, by, to);
}

std::vector<Border> borders(const Diagram& diagram) {
    std::vector<Border> result;
    for (Halfedge edge = diagram.halfedges_begin(); edge != diagram.halfedges_end(); ++edge) {
        if (!parts_sources(edge) || source_of(edge->face()) == no_source)
            continue;
        if (goes_on(previous_border(edge), edge))
            continue;
        Halfedge last = edge;
        for (Halfedge next = next_border(last); goes_on(last, next); next = next_border(last))
            last = next;
        result.push_back(
            {edge->source()->point(),
             last->target()->point(),
             source_of(edge->face()),
             source_of(edge->twin()->face())});
    }
    std::sort(result.begin(), result.end());
    return result;
}

Point exact_point(const RationalPoint& point) {
    const auto coordinate = [&](std::int32_t whole, std::int64_t numerator) {
        return Number(whole)
            + Number(static_cast<long>(numerator)) / Number(static_cast<long>(point.denominator));
    };
    return {
        coordinate(point.whole.x, point.x_numerator), coordinate(point.whole.y, point.y_numerator)};
}

std::vector<Border> borders(const VisibleMap& map) {
    std::vector<Border> result;
    for (const VisibleMap::Ring& ring : map.rings) {
        const auto vertices = map.vertices_of(ring);
        for (std::size_t i = 0; i < vertices.size(); ++i)
            result.push_back(
                {exact_point(map.vertices[vertices[i]]),
                 exact_point(map.vertices[vertices[(i + 1) % vertices.size()]]),
                 ring.source,
                 map.source_across(ring.first + i)});
    }
    std::sort(result.begin(), result.end());
    return result;
}

std::string text_of(const Border& border) {
    std::ostringstream text;
    text << std::setprecision(12) << border.from << " to " << border.to << ": " << border.left
         << " | " << border.right;
    return text.str();
}

/// Every border of the one map is a border of the other, with the same ends to the last digit and
/// the same beside it. The number of borders.
std::size_t expect_same_map(const ScreenScene& scene, const std::string& what) {
    const VisiblePieces pieces = cell_raster(scene);
    EXPECT_TRUE(pieces.penetrating.empty()) << what;
    const std::vector<Border> found = borders(visible_map(scene, pieces));
    const std::vector<Border> expected = borders(envelope(scene));
    EXPECT_EQ(found.size(), expected.size()) << what;
    const auto differing = std::ranges::mismatch(found, expected);
    if (differing.in1 != found.end() && differing.in2 != expected.end())
        ADD_FAILURE() << what << ": " << text_of(*differing.in1) << "\ninstead of "
                      << text_of(*differing.in2);
    return expected.size();
}

TEST(EnvelopeWitness, SeesTheSameOfLayersOnFewPoints) {
    std::size_t compared = 0;
    for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed)
        compared += expect_same_map(
            layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4)),
            "seed " + std::to_string(seed));
    EXPECT_GT(compared, 5000U);
}

TEST(EnvelopeWitness, SeesTheSameOfScatteredTriangles) {
    std::size_t compared = 0;
    for (std::uint64_t seed = 0; seed < 12 && !HasFailure(); ++seed)
        compared += expect_same_map(
            scattered(seed, 150, screen_size >> (seed % 5)), "seed " + std::to_string(seed));
    EXPECT_GT(compared, 5000U);
}

TEST(EnvelopeWitness, SeesTheSameOfATerrain) {
    std::size_t compared = 0;
    for (std::uint64_t seed = 0; seed < 6 && !HasFailure(); ++seed)
        compared += expect_same_map(
            terrain(seed, 4 + 2 * static_cast<std::int32_t>(seed)), "seed " + std::to_string(seed));
    EXPECT_GT(compared, 1000U);
}

TEST(EnvelopeWitness, SeesTheSameOfClosedBodies) {
    std::size_t compared = 0;
    for (std::uint64_t seed = 0; seed < 6 && !HasFailure(); ++seed)
        compared += expect_same_map(
            balls(seed, 2 + seed % 3, 5 + static_cast<std::int32_t>(seed)),
            "seed " + std::to_string(seed));
    EXPECT_GT(compared, 1000U);
}

/// A point of the picture in steps of the grid.
struct Place {
    double x = 0;
    double y = 0;
};

Place place_of(const Point& point) {
    return {CGAL::to_double(point.x()), CGAL::to_double(point.y())};
}

struct BorderLine {
    Place from;
    Place to;
    std::uint32_t left = 0;
};

/// How far the place is from the line, at least.
double distance(Place at, const BorderLine& line) {
    const double x = line.to.x - line.from.x;
    const double y = line.to.y - line.from.y;
    const double along = ((at.x - line.from.x) * x + (at.y - line.from.y) * y) / (x * x + y * y);
    const double part = std::clamp(along, 0.0, 1.0);
    return std::hypot(line.from.x + part * x - at.x, line.from.y + part * y - at.y);
}

/// The sources whose borders go round the place, and how often.
std::map<std::uint32_t, int> turns_about(const std::vector<BorderLine>& lines, Place at) {
    std::map<std::uint32_t, int> turns;
    for (const auto& [from, to, left] : lines) {
        const double side = (to.x - from.x) * (at.y - from.y) - (to.y - from.y) * (at.x - from.x);
        if (from.y <= at.y && to.y > at.y && side > 0)
            ++turns[left];
        else if (from.y > at.y && to.y <= at.y && side < 0)
            --turns[left];
    }
    std::erase_if(turns, [](const auto& each) { return each.second == 0; });
    return turns;
}

std::vector<BorderLine> lines_of(const std::vector<Border>& borders) {
    std::vector<BorderLine> lines;
    for (const Border& border : borders)
        lines.push_back({place_of(border.from), place_of(border.to), border.left});
    return lines;
}

TEST(EnvelopeWitness, SeesTheSameOfTanglesButForAFewSteps) {
    constexpr double off = 8;
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 40 && !HasFailure(); ++seed) {
        const ScreenScene scene = tangle(seed, 2 + seed % 20);
        ScreenScene cut = scene;
        const WholePieces whole = whole_pieces(cut);
        EXPECT_EQ(whole.left, 0U) << "seed " << seed;
        const auto found = lines_of(borders(visible_map(cut, whole.pieces)));
        const auto expected = lines_of(borders(envelope(scene)));
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> coordinate(0, screen_size);
        for (int i = 0; i < 200; ++i) {
            const Place at = {coordinate(random), coordinate(random)};
            if (std::ranges::any_of(
                    expected, [&](const BorderLine& line) { return distance(at, line) < off; }))
                continue;
            ++compared;
            EXPECT_EQ(turns_about(found, at), turns_about(expected, at))
                << "seed " << seed << " at " << at.x << " " << at.y;
        }
    }
    EXPECT_GT(compared, 5000);
}

} // namespace
} // namespace vera
