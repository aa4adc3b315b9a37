// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/growth.h"
#include "vera/theory/overlaid_rectangles.h"
#include "vera/theory/rectangle_view.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "theory/rectangle_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::Rectangles;
using testing::scene_side;

constexpr std::uint32_t nobody = ~std::uint32_t{0};

/// Of the cell of the grid that begins there.
std::size_t cell_number(std::int32_t x, std::int32_t y) {
    return static_cast<std::size_t>(x) * scene_side + static_cast<std::size_t>(y);
}

/// Who is seen in each cell.
class SeenCells {
public:
    SeenCells() = default;

    /// By asking all rectangles: twice as large, so that middles of cells are whole.
    explicit SeenCells(const Rectangles& rectangles) {
        Rectangles doubled = rectangles;
        for (IsoRectangle& rectangle : doubled)
            for (std::int32_t* value :
                 {&rectangle.lower_x, &rectangle.upper_x, &rectangle.lower_y, &rectangle.upper_y})
                *value *= 2;
        for (std::int32_t x = 0; x < scene_side; ++x)
            for (std::int32_t y = 0; y < scene_side; ++y)
                at(x, y) =
                    brute_force_first_rectangle(doubled, {{2 * x + 1, 2 * y + 1, -1000}, {0, 0, 1}})
                        .value_or(nobody);
    }

    /// Nobody outside.
    std::uint32_t operator()(std::int32_t x, std::int32_t y) const {
        if (x < 0 || y < 0 || x >= scene_side || y >= scene_side)
            return nobody;
        return cells_[cell_number(x, y)];
    }

private:
    std::uint32_t& at(std::int32_t x, std::int32_t y) { return cells_[cell_number(x, y)]; }

    std::vector<std::uint32_t> cells_ = std::vector<std::uint32_t>(scene_side * scene_side, nobody);
};

/// Calls visit(from, to) for each side of the ring.
template <typename Visit>
void for_each_side(std::span<const PlanePoint> corners, const Visit& visit) {
    for (std::size_t i = 0; i < corners.size(); ++i)
        visit(corners[i], corners[(i + 1) % corners.size()]);
}

/// How often the ways of a rectangle go round each cell.
using Windings = std::vector<int>;

void add_windings(PlanePoint from, PlanePoint to, Windings& windings) {
    // All that lies to the right of what goes down is inside once more.
    for (std::int32_t y = std::min(from.y, to.y); y < std::max(from.y, to.y); ++y)
        for (std::int32_t x = from.x; x < scene_side; ++x)
            windings[cell_number(x, y)] += from.y > to.y ? 1 : -1;
}

/// The rectangle is seen to the left of each side and not to its right, and each side turns.
void expect_border(
    std::span<const PlanePoint> corners, std::uint32_t rectangle, const SeenCells& seen) {
    bool was_level = corners.front().y == corners.back().y;
    for_each_side(corners, [&](PlanePoint from, PlanePoint to) {
        const bool is_level = from.y == to.y;
        EXPECT_NE(is_level, was_level);
        EXPECT_TRUE(is_level || from.x == to.x);
        was_level = is_level;
        const PlanePoint low = {std::min(from.x, to.x), std::min(from.y, to.y)};
        const std::int32_t length = std::max(from.x, to.x) - low.x + std::max(from.y, to.y) - low.y;
        EXPECT_GT(length, 0);
        for (std::int32_t i = 0; i < length; ++i) {
            const std::int32_t x = low.x + (is_level ? i : 0);
            const std::int32_t y = low.y + (is_level ? 0 : i);
            const bool is_left_upper = is_level ? from.x < to.x : from.y > to.y;
            const std::uint32_t upper = seen(x, y);
            const std::uint32_t lower = is_level ? seen(x, y - 1) : seen(x - 1, y);
            EXPECT_EQ(is_left_upper ? upper : lower, rectangle);
            EXPECT_NE(is_left_upper ? lower : upper, rectangle);
        }
    });
}

bool is_before(PlanePoint a, PlanePoint b) {
    return std::pair(a.x, a.y) < std::pair(b.x, b.y);
}

/// Rings are borders of what is seen, all of it, and in the order that is promised.
void expect_seen(const Rectangles& rectangles, const RectangleView& view, const SeenCells& seen) {
    std::vector<Windings> windings(
        rectangles.size(), Windings(static_cast<std::size_t>(scene_side * scene_side)));
    for (std::size_t i = 0; i < view.rings.size(); ++i) {
        const RectangleView::Ring& ring = view.rings[i];
        const auto corners = view.corners_of(ring);
        EXPECT_TRUE(std::min_element(corners.begin(), corners.end(), is_before) == corners.begin());
        if (i > 0) {
            const RectangleView::Ring& before = view.rings[i - 1];
            EXPECT_LE(before.rectangle, ring.rectangle);
            if (before.rectangle == ring.rectangle) {
                EXPECT_TRUE(is_before(view.corners_of(before).front(), corners.front()));
            }
        }
        expect_border(corners, ring.rectangle, seen);
        for_each_side(corners, [&](PlanePoint from, PlanePoint to) {
            add_windings(from, to, windings[ring.rectangle]);
        });
    }
    for (std::uint32_t number = 0; number < rectangles.size(); ++number)
        for (std::int32_t x = 0; x < scene_side; ++x)
            for (std::int32_t y = 0; y < scene_side; ++y)
                if (windings[number][cell_number(x, y)] != (seen(x, y) == number ? 1 : 0))
                    ADD_FAILURE() << "rectangle " << number << " at " << x << ", " << y;
}

TEST(RectangleView, SeesWhatIsSeenInEveryCell) {
    std::mt19937_64 random(1);
    std::size_t cells = 0;
    std::size_t rings = 0;
    for (int turn = 0; turn < 300; ++turn)
        for (const testing::RectangleScene& family : testing::rectangle_scenes()) {
            const Rectangles rectangles = family.rectangles(random);
            const RectangleView view = rectangle_view(rectangles);
            expect_seen(rectangles, view, SeenCells(rectangles));
            rings += view.rings.size();
            cells += static_cast<std::size_t>(scene_side * scene_side);
            ASSERT_FALSE(HasFailure()) << family.name << ", turn " << turn;
        }
    EXPECT_GT(cells, 350'000U);
    EXPECT_GT(rings, 20'000U);
}

/// A rectangle's number, and the corners of what is seen of it.
using PlainRing = std::pair<std::uint32_t, std::vector<std::pair<std::int32_t, std::int32_t>>>;

std::vector<PlainRing> plain_rings(const RectangleView& view) {
    std::vector<PlainRing> rings;
    for (const RectangleView::Ring& ring : view.rings) {
        rings.push_back({ring.rectangle, {}});
        for (const PlanePoint corner : view.corners_of(ring))
            rings.back().second.emplace_back(corner.x, corner.y);
    }
    return rings;
}

/// Without the points at which only something else begins beyond.
std::vector<PlainRing> plain_rings(const VisibleMap& map) {
    std::vector<PlainRing> rings;
    for (const VisibleMap::Ring& ring : map.rings) {
        const auto vertices = map.vertices_of(ring);
        const auto point = [&](std::size_t i) {
            const RationalPoint& at = map.vertices[vertices[i % vertices.size()]];
            EXPECT_EQ(at.denominator, 1);
            return at.whole;
        };
        std::vector<std::pair<std::int32_t, std::int32_t>> corners;
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (orientation(point(i + vertices.size() - 1), point(i), point(i + 1)) != 0)
                corners.emplace_back(point(i).x, point(i).y);
        std::rotate(
            corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        rings.emplace_back(ring.source, corners);
    }
    std::sort(rings.begin(), rings.end());
    return rings;
}

TEST(RectangleView, SeesLikeBothEngines) {
    std::mt19937_64 random(2);
    std::size_t corners = 0;
    for (int turn = 0; turn < 200; ++turn)
        for (const testing::RectangleScene& family : testing::rectangle_scenes()) {
            const Rectangles rectangles = family.rectangles(random);
            const ScreenScene scene = screen_scene(rectangles);
            const RectangleView view = rectangle_view(rectangles);
            const auto found = plain_rings(view);
            EXPECT_EQ(found, plain_rings(visible_map(scene, cell_raster(scene))));
            EXPECT_EQ(found, plain_rings(visible_map(scene, plane_sweep(scene))));
            corners += view.corners.size();
            ASSERT_FALSE(HasFailure()) << family.name << ", turn " << turn;
        }
    EXPECT_GT(corners, 10'000U);
}

/// What is seen of larger scenes, where little of the borders lies in one rectangle's reach.
TEST(RectangleView, SeesLikeTheCellsOfManyRectangles) {
    for (const OverlaidFamily& family : overlaid_families())
        for (const std::size_t count : {2U, 40U, 150U}) {
            const Rectangles rectangles = family.rectangles(count, 3);
            const ScreenScene scene = screen_scene(rectangles);
            EXPECT_EQ(
                plain_rings(rectangle_view(rectangles)),
                plain_rings(visible_map(scene, cell_raster(scene))))
                << family.name << ", " << count;
        }
}

std::vector<PlainRing> seen_of(const Rectangles& rectangles) {
    return plain_rings(rectangle_view(rectangles));
}

std::vector<std::pair<std::int32_t, std::int32_t>>
corners_of(std::int32_t lower_x, std::int32_t upper_x, std::int32_t lower_y, std::int32_t upper_y) {
    return {{lower_x, lower_y}, {upper_x, lower_y}, {upper_x, upper_y}, {lower_x, upper_y}};
}

TEST(RectangleView, PutsTheFirstOfOnePlaneInFront) {
    const Rectangles rectangles = {
        {7, 0, 4, 0, 4}, {7, 2, 6, 0, 4}, {7, 0, 4, 0, 4}, {6, 1, 2, 1, 2}};
    const std::vector<PlainRing> expected = {
        {0, corners_of(0, 4, 0, 4)},
        {0, {{1, 1}, {1, 2}, {2, 2}, {2, 1}}}, // a hole, to the right
        {1, corners_of(4, 6, 0, 4)},
        {3, corners_of(1, 2, 1, 2)}};
    EXPECT_EQ(seen_of(rectangles), expected);
}

TEST(RectangleView, HasPartsThatMeetInACornerApart) {
    const Rectangles rectangles = {{0, 0, 1, 0, 1}, {0, 1, 2, 1, 2}, {1, 0, 2, 0, 2}};
    const std::vector<PlainRing> expected = {
        {0, corners_of(0, 1, 0, 1)},
        {1, corners_of(1, 2, 1, 2)},
        {2, corners_of(0, 1, 1, 2)},
        {2, corners_of(1, 2, 0, 1)}};
    EXPECT_EQ(seen_of(rectangles), expected);
}

TEST(RectangleView, SeesNothingOfWhatHasNoArea) {
    EXPECT_TRUE(seen_of({}).empty());
    EXPECT_TRUE(seen_of({{0, 3, 3, 0, 9}, {0, 0, 9, 5, 5}, {0, 1, 1, 1, 1}}).empty());
    const std::vector<PlainRing> expected = {{1, corners_of(0, 9, 0, 9)}};
    EXPECT_EQ(seen_of({{0, 3, 3, 0, 9}, {5, 0, 9, 0, 9}, {9, 0, 9, 0, 9}}), expected);
}

TEST(RectangleView, TakesTheLargestCoordinates) {
    constexpr std::int32_t most = largest_plane_coordinate;
    const std::vector<PlainRing> expected = {
        {0, {{-most, -most}, {most, -most}, {most, most}, {-most, most}}},
        {0, {{0, 0}, {0, most - 1}, {most - 1, most - 1}, {most - 1, 0}}},
        {1, corners_of(0, most - 1, 0, most - 1)}};
    EXPECT_EQ(
        seen_of({{most, -most, most, -most, most}, {-most, 0, most - 1, 0, most - 1}}), expected);
}

TEST(RectangleView, RefusesWhatIsNoRectangleAndWhatIsOutsideThePicture) {
    const auto message_of = [](const auto& use) -> std::string {
        try {
            use();
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(
        message_of([] {
            rectangle_view(Rectangles{{0, 0, 1, 0, 1}, {0, 0, 1, 3, 2}});
        }),
        "rectangle 1 has a lower side above its upper side: exchange the two");
    EXPECT_NE(
        message_of([] {
            rectangle_view(Rectangles{{0, 0, largest_plane_coordinate + 1, 0, 1}});
        }).find("rectangle 0"),
        std::string::npos);
    EXPECT_EQ(
        message_of([] {
            screen_scene(Rectangles{{0, 0, screen_size, -1, 1}});
        }),
        "rectangle 0 lies outside the grid of the picture: take corners from 0 to 4194304");
}

/// Of many, whose trees alone would not fit; of fewer, when their border has grown.
TEST(RectangleView, IsRefusedWhereMemoryWouldNotSuffice) {
    for (const Rectangles& rectangles : {hidden_grate_of_bars(60'000, 1), grate_of_bars(200, 1)}) {
        const MemoryLimit limit(1);
        try {
            rectangle_view(rectangles);
            ADD_FAILURE() << "was not refused";
        } catch (const std::runtime_error& error) {
            EXPECT_EQ(
                std::string(error.what())
                    .find(
                        "what is seen of " + std::to_string(rectangles.size())
                        + " rectangles takes about"),
                0U)
                << error.what();
        }
    }
}

/// A rectangle that crosses many bars, whose borders have grown little by little, doubles them.
TEST(RectangleView, IsRefusedWhereOneRectangleTakesMoreMemoryThanThereIs) {
    constexpr std::int32_t bars = 8192; // progress is told before the turn of each 1024th
    Rectangles rectangles;
    for (std::int32_t i = 0; i < bars; ++i)
        rectangles.push_back({0, 2 * i, 2 * i + 1, 0, 3});
    const std::size_t without = rectangle_view(rectangles).corners.size();
    EXPECT_EQ(without, 4U * bars);
    rectangles.push_back({1, 0, 2 * bars, 1, 2});
    std::optional<MemoryLimit> limit;
    const auto limit_at_last = [&](double done) {
        if (done > (bars - 0.5) / (bars + 1))
            limit.emplace(1);
    };
    EXPECT_THROW(rectangle_view(rectangles, nullptr, limit_at_last), std::runtime_error);
    EXPECT_TRUE(limit.has_value());
}

TEST(RectangleView, EndsWhenItIsCancelledAndTellsHowFarItIs) {
    const Rectangles rectangles = scattered_squares(1500, 1);
    double last = 0;
    rectangle_view(rectangles, nullptr, [&](double done) {
        EXPECT_GE(done, last);
        EXPECT_LE(done, 1);
        last = done;
    });
    EXPECT_GT(last, 0.5);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(rectangle_view(rectangles, nullptr, {}, &cancel), Cancelled);
}

/// A piece that is found ends at corners of what is seen, or where two of the nearer ones meet.
TEST(RectangleView, FindsNoMoreOfTheBorderThanIsSeen) {
    std::mt19937_64 random(5);
    std::uint64_t found = 0;
    for (int turn = 0; turn < 100; ++turn)
        for (const testing::RectangleScene& family : testing::rectangle_scenes()) {
            WindowCounts counts;
            const RectangleView view = rectangle_view(family.rectangles(random), &counts);
            ASSERT_LE(counts.found, view.corners.size()) << family.name << ", turn " << turn;
            found += counts.found;
        }
    EXPECT_GT(found, 10'000U);
}

TEST(RectangleView, TakesTheSameStepsAgain) {
    const Rectangles rectangles = scattered_squares(100, 1);
    WindowCounts once;
    rectangle_view(rectangles, &once);
    WindowCounts twice = once;
    rectangle_view(rectangles, &twice);
    EXPECT_EQ(twice.steps(), 2 * once.steps());
}

/// All sides cross behind the cover, and steps hardly grow faster than the rectangles; the sweep
/// meets each crossing.
TEST(RectangleView, TakesStepsWithWhatIsSeenAndNotWithWhatCrosses) {
    std::vector<double> sizes;
    std::vector<double> steps;
    std::vector<double> crossings;
    std::vector<double> swept;
    for (const std::size_t count : {32U, 64U, 128U, 256U}) {
        const Rectangles rectangles = hidden_grate_of_bars(count, 1);
        WindowCounts counts;
        const RectangleView view = rectangle_view(rectangles, &counts);
        EXPECT_EQ(view.corners.size(), 4U);
        PlaneSweepCounts sweep;
        plane_sweep(screen_scene(rectangles), {std::nullopt, &sweep});
        sizes.push_back(static_cast<double>(count));
        steps.push_back(static_cast<double>(counts.steps()));
        crossings.push_back(static_cast<double>(sweep.crossings));
        swept.push_back(static_cast<double>(sweep.comparisons + sweep.queued));
    }
    EXPECT_LT(growth(sizes, steps).exponent, 1.25);
    EXPECT_GT(growth(sizes, crossings).exponent, 1.9);
    EXPECT_GT(growth(sizes, swept).exponent, 1.9);
}

} // namespace
} // namespace vera
