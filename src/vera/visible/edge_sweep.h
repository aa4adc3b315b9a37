// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cell_counts.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/cells.h"
#include "vera/visible/seen_beside.h"
#include "vera/visible/seen_parts.h"
#include "vera/visible/shadow_cells.h"
#include "vera/visible/shadows_beside.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// What all edges are compared with.
struct CellRaster {
    const ScreenScene& scene;
    std::vector<NearnessSlope> slopes;
    std::vector<std::array<ScreenPoint, 3>> corners; ///< of the triangles, side by side
    ScreenEdges edges;
    Cells cells; ///< of surfaces
    ShadowCells shadow_cells;
    /// Of edges, which eighths of the slices of cells along them lie behind what covers these
    /// cells: see eighth_of(). Of those of fewer slices the last bits are set.
    std::vector<std::uint8_t> hidden_eighths;
    /// Those before it surfaces alone have.
    std::size_t first_shadow_edge = 0;
    /// Of the edges from there on, as is_inner() and shadowed_source(); empty: there is no shadow.
    std::vector<std::uint8_t> inner;
    std::vector<std::uint32_t> shadowed;
    std::vector<std::uint8_t> is_near_change; ///< of edges; the others behind these are
    /// Of edges of surfaces, whether they lie between two parts of one source, which then is on
    /// both sides.
    std::vector<std::uint8_t> within_source;
    std::vector<std::uint8_t> has_one_source; ///< of cells, whether the surfaces are parts of one

    PieceStorage storage = PieceStorage::plain; ///< of what is seen

    /// Whether the edge is one between two parts of one shadow.
    bool is_inner(std::uint32_t edge) const {
        return !inner.empty() && edge >= first_shadow_edge && inner[edge - first_shadow_edge] != 0;
    }

    /// Of an edge that nothing has but shadows on one source, that source: other sources' shadows
    /// do not matter beside it. no_source of one that surfaces alone have, else several_sources.
    std::uint32_t shadowed_source(std::uint32_t edge) const {
        return shadowed.empty() || edge < first_shadow_edge ? no_source
                                                            : shadowed[edge - first_shadow_edge];
    }

    /// Whether the edge is asked for: not where it is far from what was changed.
    bool is_followed(std::size_t edge) const {
        return edge >= is_near_change.size() || is_near_change[edge] != 0;
    }

    bool is_within_source(std::uint32_t edge) const {
        return edge < within_source.size() && within_source[edge] != 0;
    }

    /// Whether nothing is seen in the cell but one source, and no shadow on it.
    bool shows_one_source(std::size_t cell) const {
        return has_one_source[cell] != 0
            && (shadow_cells.starts.empty() || shadow_cells.shadows_of(cell).empty());
    }

    /// Whether some light may not reach something that is seen.
    bool may_be_unlit() const { return !shadowed.empty() || !scene.unlit.empty(); }
};

constexpr std::uint32_t several_sources = no_source - 1;

constexpr std::uint8_t all_eighths = 0xff;

/// The bit of the slice among those that a byte has for so many slices.
constexpr std::uint8_t eighth_of(std::int32_t slice, std::int32_t slices) {
    return static_cast<std::uint8_t>(
        1U << (slices <= 8 ? slice : 8 * std::int64_t{slice} / slices));
}

constexpr std::uint32_t no_edge = ~std::uint32_t{0};

/// Follows one edge after another: what a thread needs for it.
class EdgeSweep {
public:
    explicit EdgeSweep(const CellRaster& raster)
        : raster_(raster)
        , may_be_shadow_(!raster.shadowed.empty())
        , seen_(raster.scene, raster.slopes)
        , stamps_(raster.scene.triangles.size()) {}

    void follow(std::uint32_t edge, VisiblePieces& result);

    /// Of all edges that it followed.
    CellCounts counts() const {
        CellCounts counts = counts_;
        counts.depth_orders = seen_.comparisons();
        return counts;
    }

private:
    static constexpr std::uint32_t no_cover = ~std::uint32_t{0};

    /// Where a triangle covers what lies beside the edge; by no triangle: where it is hidden.
    struct Cover {
        std::uint32_t triangle = 0;
        std::uint8_t sides = 0;
        std::uint32_t edge =
            no_edge; ///< of the triangle's that lies there, where it covers one side
        SegmentPlace first;
        SegmentPlace last;
        std::uint32_t behind = no_cover; ///< another cover, as long as that leaves this one out
        bool leaves_others_out = false;

        bool is_on_both_sides() const { return sides == (left_side | right_side); }
    };

    /// A triangle that the line of the edge passes through.
    struct Across {
        std::uint32_t triangle = 0;
        std::array<std::int64_t, 3> sides = {}; ///< orientation() of the edge with its corners
    };

    /// A place of the edge at which a cover begins or ends, or a triangle touches it.
    struct Event {
        enum Kind : std::uint8_t { begins, ends, touches };

        double value = 0;         ///< of the place
        std::uint32_t number = 0; ///< of the cover, or of the touch
        Kind kind = touches;
    };

    /// What is seen beside a part of the edge.
    struct Seen {
        std::uint32_t triangle = no_triangle;
        LightSet unlit = 0;

        friend bool operator==(const Seen&, const Seen&) = default;
    };

    bool gather(std::uint32_t edge);
    void find_open_parts();
    Hiding hiding_between(double first, double last) const;
    template <typename List, typename DoesMatter>
    void classify_along(
        const List& list, const DoesMatter& does_matter, std::uint8_t hidden_eighths = 0);
    bool lies_within_one_source(std::uint32_t edge) const;
    void hide_between(std::int64_t first, std::int64_t last);
    void classify(std::uint32_t triangle);
    void
    add_beside(std::uint32_t triangle, const std::array<ScreenPoint, 3>& corners, std::size_t side);
    SegmentPlace crossing_of_side(
        ScreenPoint corner, ScreenPoint next, std::int64_t side, std::int64_t next_side) const;
    std::array<SegmentPlace, 2> places_of_touching(const Across& across);
    void add_across(const Across& across);
    void add_all_across();
    void add_touch(ScreenPoint corner);
    void find_hidden_parts();
    bool is_hidden(SegmentPlace first, SegmentPlace last) const;
    void sort_events();
    void start_events();
    bool are_at_the_same_place(const Event& a, const Event& b) const;
    void change_active(const Event& event);
    void leave_out_behind(std::uint32_t foremost, double here);
    void bring_back_behind(std::uint32_t ended);
    bool has_one_sided() const;
    bool ends_a_shadow_somewhere();
    void find_seen_sources(bool is_of_surfaces);
    Seen seen(const Cover* nearest, std::uint8_t side) const;
    bool
    speaks_here(std::uint32_t edge, const Cover* left, const Cover* right, Hiding hiding) const;
    bool is_still_hidden() const;
    std::array<const Cover*, 2>
    seen_between(double first, double last, Hiding hiding, bool asks_always);

    const SegmentPlace& place_of(const Event& event) const {
        switch (event.kind) {
        case Event::begins:
            return covers_[event.number].first;
        case Event::ends:
            return covers_[event.number].last;
        case Event::touches:
            break;
        }
        return touches_[event.number];
    }

    NearnessPlace place_at(double place) const {
        return {begin_.x + place * (end_.x - begin_.x), begin_.y + place * (end_.y - begin_.y)};
    }

    std::uint32_t source_of(std::uint32_t triangle) const {
        return triangle == no_triangle ? no_source : raster_.scene.triangles[triangle].source;
    }

    bool is_shadow(std::uint32_t triangle) const {
        return may_be_shadow_ && triangle != no_triangle
            && raster_.scene.triangles[triangle].is_shadow();
    }

    const CellRaster& raster_;
    bool may_be_shadow_; ///< a triangle
    SeenBeside seen_;
    std::vector<std::uint32_t> stamps_; ///< of triangles: the last edge that they were gathered for
    std::uint32_t stamp_ = 0;
    std::vector<Across> across_;
    std::vector<Cover> covers_;
    std::vector<Cover> hidden_slices_;              ///< covers by no triangle
    std::vector<std::array<double, 2>> open_parts_; ///< places in cells that hide nothing
    std::vector<SegmentPlace> touches_;             ///< where a triangle has a corner on the edge
    std::vector<Event> events_;
    std::vector<std::uint32_t> active_;   ///< covers by surfaces, but for those that are left out
    std::vector<std::uint32_t> left_out_; ///< and such as ended since
    ShadowsBeside shadows_;
    std::vector<std::uint32_t> ending_shadows_; ///< active covers of one side by shadows
    std::vector<std::uint32_t> seen_sources_;
    std::size_t first_hidden_ = 0;       ///< of the covers by no triangle
    std::size_t last_hidden_ = 0;        ///< behind them
    bool is_hidden_here_ = false;        ///< the part of the edge at hand
    std::uint32_t hidden_by_ = no_cover; ///< on both sides of the part of the edge before
    ScreenPoint begin_;
    ScreenPoint end_;
    ScreenStep way_;    ///< from begin to end
    ScreenPoint least_; ///< of both
    ScreenPoint most_;
    VisiblePieces* result_ = nullptr;
    CellCounts counts_;
};

} // namespace vera
