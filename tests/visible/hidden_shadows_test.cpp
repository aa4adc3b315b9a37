// SPDX-License-Identifier: Apache-2.0
// Shadows on what is hidden change nothing that is seen: the pieces of a scene with them are those
// of the scene without, to the bit. Their edges may reach the border of what hides them, and be
// those of surfaces as well.
#include "vera/visible/cell_raster.h"
#include "vera/visible/cells.h"
#include "vera/visible/edges.h"
#include "vera/visible/seen_beside.h"
#include "vera/visible/shadow_cells.h"
#include "vera/visible/sheets.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// Squares of a picture of side x side, most of them covered by a surface, and triangles behind
/// these, wholly hidden, with corners on the squares' corners. Nearer surfaces hide what the cells
/// know to be hidden, others what only who compares it finds to be.
class HiddenDepths {
public:
    HiddenDepths(std::uint64_t seed, std::int32_t side)
        : random_(seed)
        , nearer_parts_(random_() % 16)
        , side_(side)
        , is_covered_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {
        for (std::int32_t row = 0; row < side; ++row)
            for (std::int32_t column = 0; column < side; ++column)
                if (below(40) != 0)
                    cover(column, row);
        for (int tries = 0; tries < 100; ++tries)
            add_hidden();
    }

    ScreenScene take() { return std::move(scene_); }

private:
    std::int32_t below(std::int32_t count) {
        return static_cast<std::int32_t>(random_() % static_cast<std::uint64_t>(count));
    }

    std::uint32_t add_vertex(ScreenPoint point, std::int64_t nearness) {
        scene_.vertices.push_back({point, nearness});
        return static_cast<std::uint32_t>(scene_.vertices.size() - 1);
    }

    std::uint32_t vertex(std::int32_t column, std::int32_t row, std::int64_t nearness) {
        const std::int32_t size = screen_size / side_;
        return add_vertex({column * size, row * size}, nearness);
    }

    /// By one triangle, twice as wide and high and a bit more: cells know that it covers them.
    void cover(std::int32_t column, std::int32_t row) {
        is_covered_[static_cast<std::size_t>(row * side_ + column)] = 1;
        constexpr std::int32_t more = 8; // steps
        const std::int32_t size = screen_size / side_;
        const bool is_right = column + 1 == side_;
        const bool is_low = row + 1 == side_;
        const ScreenPoint corner = {
            std::clamp(column * size + (is_right ? size + more : -more), 0, screen_size),
            std::clamp(row * size + (is_low ? size + more : -more), 0, screen_size)};
        const std::int32_t along = is_right ? -2 * size - 4 * more : 2 * size + 4 * more;
        const std::int32_t down = is_low ? -2 * size - 4 * more : 2 * size + 4 * more;
        // The same for several in a row: what is known of some need not tell of those far off.
        const std::uint32_t part =
            static_cast<std::uint32_t>((column / 4) % 2 + 2 * ((row / 4) % 2));
        const std::int64_t nearness = depth_size / 4 * ((nearer_parts_ >> part & 1U) == 0 ? 2 : 3);
        const auto vertex = [&](std::int32_t x, std::int32_t y) {
            const auto within = [](std::int32_t place) {
                return std::clamp(place, 0, screen_size);
            };
            return add_vertex({within(x), within(y)}, nearness);
        };
        const std::uint32_t a = vertex(corner.x, corner.y);
        const std::uint32_t b = vertex(corner.x + along, corner.y);
        const std::uint32_t c = vertex(corner.x, corner.y + down);
        add_triangle(scene_, {a, b, c}, source_++);
    }

    bool is_covered(std::int32_t column, std::int32_t row) const {
        return column >= 0 && row >= 0 && column < side_ && row < side_
            && is_covered_[static_cast<std::size_t>(row * side_ + column)] != 0;
    }

    /// A triangle of a few squares, where all of these and those around them are covered.
    void add_hidden() {
        const std::int32_t column = below(side_);
        const std::int32_t row = below(side_);
        const std::int32_t right = std::min(side_, column + 1 + below(7));
        const std::int32_t bottom = std::min(side_, row + 1 + below(3));
        for (std::int32_t y = row - 1; y <= bottom; ++y)
            for (std::int32_t x = column - 1; x <= right; ++x)
                if (!is_covered(x, y))
                    return;
        const std::int64_t nearness = depth_size / 8 * (1 + below(3)) + source_;
        const std::uint32_t a = vertex(column, row, nearness);
        const std::uint32_t b = vertex(right, row, nearness);
        const std::uint32_t c =
            below(2) == 0 ? vertex(right, bottom, nearness) : vertex(column, bottom, nearness);
        add_triangle(scene_, {a, b, c}, source_++);
        // Behind it, from its upper side on, a sliver so steep that nothing tells at a glance how
        // near it is.
        if (below(3) != 0) {
            const ScreenPoint middle = {
                (column + right) * (screen_size / side_ / 2), row * (screen_size / side_) + 1};
            const std::uint32_t d = add_vertex(middle, nearness - (nearness >> (1 + below(4))));
            add_triangle(scene_, {a, b, d}, source_++);
        }
    }

    std::mt19937_64 random_;
    std::uint64_t nearer_parts_ = 0; ///< as bits
    std::int32_t side_ = 1;
    std::vector<std::uint8_t> is_covered_;
    ScreenScene scene_;
    std::uint32_t source_ = 0;
};

/// A shadow on each surface that is far and no sliver, or on a part of it between two of its
/// corners.
ScreenScene with_hidden_shadows(ScreenScene scene, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const std::size_t surfaces = scene.triangles.size();
    for (std::size_t i = 0; i < surfaces; ++i) {
        const ScreenTriangle on = scene.triangles[i];
        const std::array<ScreenVertex, 3> corners = corners_of(scene, on);
        const bool is_flat = corners[0].nearness == corners[1].nearness
            && corners[0].nearness == corners[2].nearness;
        if (!is_flat || corners[0].nearness >= depth_size / 2)
            continue;
        std::array<std::uint32_t, 3> vertices = on.vertices;
        const auto light = static_cast<std::uint32_t>(random() % 2);
        if (random() % 2 == 0) {
            const ScreenPoint a = corners[0].point;
            const ScreenPoint b = corners[1].point;
            scene.vertices.push_back({{(a.x + b.x) / 2, (a.y + b.y) / 2}, corners[0].nearness});
            vertices[random() % 2] = static_cast<std::uint32_t>(scene.vertices.size() - 1);
        }
        add_part(scene, vertices, on, light);
    }
    return scene;
}

/// Whether no cell lists a shadow: all are hidden.
bool are_all_hidden(const ScreenScene& scene) {
    const std::vector<NearnessSlope> slopes = slopes_of(scene);
    const ScreenEdges edges = screen_edges(scene);
    Cells cells = cells_of(scene, slopes);
    block_by_sheets(cells, {scene, edges, edge_neighbours(scene, edges), slopes});
    return shadow_cells_of(cells, scene, slopes).triangles.empty();
}

TEST(HiddenShadows, ChangeNothingThatIsSeen) {
    std::size_t hidden = 0; // scenes with shadows, all of which are
    for (std::uint64_t seed = 0; seed < 120 && !HasFailure(); ++seed) {
        const std::string what = "seed " + std::to_string(seed);
        const ScreenScene lit = HiddenDepths(seed, std::int32_t{8} << (seed % 2)).take();
        const ScreenScene scene = with_hidden_shadows(lit, seed);
        hidden += scene.triangles.size() > lit.triangles.size() && are_all_hidden(scene) ? 1 : 0;
        const VisiblePieces expected = cell_raster(lit);
        const VisiblePieces found = cell_raster(scene);
        EXPECT_TRUE(found.points == expected.points) << what;
        ASSERT_EQ(found.pieces.size(), expected.pieces.size()) << what;
        for (std::size_t i = 0; i < found.pieces.size(); ++i) {
            const VisiblePiece& a = found.pieces[i];
            const VisiblePiece& b = expected.pieces[i];
            EXPECT_TRUE(
                a.from == b.from && a.to == b.to && a.edge == b.edge && a.left == b.left
                && a.right == b.right && found.unlit_beside(i).left == 0
                && found.unlit_beside(i).right == 0)
                << what << ", piece " << i;
        }
    }
    EXPECT_GT(hidden, 50U);
}

} // namespace
} // namespace vera
