// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cell_raster.h"

#include "vera/visible/cells.h"
#include "vera/visible/edges.h"
#include "vera/visible/seen_beside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <span>

namespace vera {

namespace {

/// What all edges are compared with.
struct Raster {
    const ScreenScene& scene;
    std::vector<DepthPlane> planes;
    std::vector<NearnessSlope> slopes;
    std::vector<std::array<ScreenPoint, 3>> corners; ///< of the triangles, side by side
    ScreenEdges edges;
    Cells cells;
    std::vector<std::uint8_t> is_hidden; ///< edges that lie behind what covers all their cells
};

constexpr std::uint32_t no_edge = ~std::uint32_t{0};

/// Where a triangle covers what lies beside an edge.
struct Cover {
    std::uint32_t triangle = 0;
    std::uint8_t sides = 0;
    std::uint32_t edge = no_edge; ///< of the triangle's that lies there, where it covers one side
    SegmentPlace first;
    SegmentPlace last;
};

constexpr std::uint32_t no_cover = ~std::uint32_t{0};

/// A place of the edge at which a cover begins or ends, or a triangle touches it.
struct Event {
    double value = 0;
    SegmentPlace place;
    std::uint32_t cover = no_cover;
    bool begins = false;
};

/// Places as doubles tell them apart from here on: they are off by 2^-52.
constexpr double surely_apart = 1e-14;

bool is_before(const Event& a, const Event& b) {
    if (std::abs(a.value - b.value) > surely_apart)
        return a.value < b.value;
    return order(a.place, b.place) < 0;
}

bool is_at_the_same_place(const Event& a, const Event& b) {
    return std::abs(a.value - b.value) <= surely_apart && order(a.place, b.place) == 0;
}

constexpr SegmentPlace beginning = {0, 1};
constexpr SegmentPlace ending = {1, 1};

SegmentPlace clamped(SegmentPlace place) {
    if (place.numerator < 0)
        return beginning;
    return place.numerator > place.denominator ? ending : place;
}

/// Follows one edge after another: what a thread needs for it.
class EdgeSweep {
public:
    explicit EdgeSweep(const Raster& raster)
        : raster_(raster)
        , seen_(raster.scene, raster.slopes)
        , stamps_(raster.scene.triangles.size()) {}

    void follow(std::uint32_t edge, VisiblePieces& result);

private:
    void gather(std::uint32_t edge);
    void add_cover(std::uint32_t triangle);
    void
    add_beside(std::uint32_t triangle, const std::array<ScreenPoint, 3>& corners, std::size_t side);
    void add_across(
        std::uint32_t triangle,
        const std::array<ScreenPoint, 3>& corners,
        const std::array<std::int64_t, 3>& sides);
    void add_touch(ScreenPoint corner);
    void sort_events();
    void change_active(const Event& event);
    bool is_still_hidden() const;
    std::array<const Cover*, 2> seen_between(const Event& first, const Event& last);

    NearnessPlace place_at(double place) const {
        return {begin_.x + place * (end_.x - begin_.x), begin_.y + place * (end_.y - begin_.y)};
    }

    std::uint32_t source_of(std::uint32_t triangle) const {
        return triangle == no_triangle ? no_source : raster_.scene.triangles[triangle].source;
    }

    const Raster& raster_;
    SeenBeside seen_;
    std::vector<std::uint32_t> stamps_; ///< of triangles: the last edge that they were gathered for
    std::uint32_t stamp_ = 0;
    std::vector<std::uint32_t> candidates_;
    std::vector<Cover> covers_;
    std::vector<SegmentPlace> touches_; ///< where a triangle has a corner on the edge
    std::vector<Event> events_;
    std::vector<std::uint32_t> active_;  ///< covers
    std::uint32_t hidden_by_ = no_cover; ///< on both sides of the part of the edge before
    ScreenPoint begin_;
    ScreenPoint end_;
    VisiblePieces* result_ = nullptr;
};

/// Gathers the triangles along the edge.
void EdgeSweep::gather(std::uint32_t edge) {
    const auto& [begin, end] = raster_.edges.edges[edge];
    begin_ = raster_.scene.vertices[begin].point;
    end_ = raster_.scene.vertices[end].point;
    ++stamp_;
    candidates_.clear();
    for_each_cell_along(raster_.cells, begin_, end_, [&](std::size_t cell) {
        for (const std::uint32_t triangle : raster_.cells.triangles_of(cell))
            if (stamps_[triangle] != stamp_) {
                stamps_[triangle] = stamp_;
                candidates_.push_back(triangle);
            }
        return true;
    });
}

/// Of a triangle with a side in the line of the edge, from corner `side` on.
void EdgeSweep::add_beside(
    std::uint32_t triangle, const std::array<ScreenPoint, 3>& corners, std::size_t side) {
    SegmentPlace first = place_on(begin_, end_, corners[side]);
    SegmentPlace last = place_on(begin_, end_, corners[(side + 1) % 3]);
    const bool is_left = order(first, last) < 0; // since corners go round to the left
    if (!is_left)
        std::swap(first, last);
    first = clamped(first);
    last = clamped(last);
    if (order(first, last) >= 0)
        return;
    covers_.push_back(
        {triangle,
         is_left ? left_side : right_side,
         raster_.edges.of_triangle[triangle][side],
         first,
         last});
}

/// Of a triangle that the line of the edge passes through; sides tells on which side of it each
/// corner lies.
void EdgeSweep::add_across(
    std::uint32_t triangle,
    const std::array<ScreenPoint, 3>& corners,
    const std::array<std::int64_t, 3>& sides) {
    std::array<SegmentPlace, 2> places;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3 && count < 2; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (sides[i] == 0) {
            places[count++] = place_on(begin_, end_, corners[i]);
            add_touch(corners[i]);
        } else if ((sides[i] < 0 && sides[next] > 0) || (sides[i] > 0 && sides[next] < 0)) {
            // The same two numbers whichever of the two triangles at that side is asked.
            places[count++] = corners[i] < corners[next]
                ? crossing_place(begin_, end_, corners[i], corners[next])
                : crossing_place(begin_, end_, corners[next], corners[i]);
        }
    }
    if (order(places[1], places[0]) < 0)
        std::swap(places[0], places[1]);
    const SegmentPlace first = clamped(places[0]);
    const SegmentPlace last = clamped(places[1]);
    if (order(first, last) < 0)
        covers_.push_back({triangle, left_side | right_side, no_edge, first, last});
}

void EdgeSweep::add_cover(std::uint32_t triangle) {
    const std::array<ScreenPoint, 3>& corners = raster_.corners[triangle];
    const auto is_beyond = [&](auto coordinate) {
        const std::int32_t least = std::min(coordinate(begin_), coordinate(end_));
        const std::int32_t most = std::max(coordinate(begin_), coordinate(end_));
        return (coordinate(corners[0]) < least && coordinate(corners[1]) < least
                && coordinate(corners[2]) < least)
            || (coordinate(corners[0]) > most && coordinate(corners[1]) > most
                && coordinate(corners[2]) > most);
    };
    if (is_beyond([](ScreenPoint p) { return p.x; })
        || is_beyond([](ScreenPoint p) { return p.y; }))
        return;
    std::array<std::int64_t, 3> sides;
    std::size_t on_line = 0;
    bool left = false;
    bool right = false;
    for (std::size_t i = 0; i < 3; ++i) {
        sides[i] = orientation(begin_, end_, corners[i]);
        on_line += sides[i] == 0 ? 1 : 0;
        left = left || sides[i] > 0;
        right = right || sides[i] < 0;
    }
    if (left && right)
        return add_across(triangle, corners, sides);
    if (on_line == 2)
        return add_beside(triangle, corners, sides[0] != 0 ? 1 : sides[1] != 0 ? 2 : 0);
    for (std::size_t i = 0; i < 3 && on_line == 1; ++i)
        if (sides[i] == 0)
            add_touch(corners[i]);
}

/// Of a triangle that has a corner on the line of the edge.
void EdgeSweep::add_touch(ScreenPoint corner) {
    const SegmentPlace place = place_on(begin_, end_, corner);
    if (place.numerator > 0 && place.numerator < place.denominator)
        touches_.push_back(place);
}

void EdgeSweep::sort_events() {
    events_.clear();
    for (std::uint32_t i = 0; i < covers_.size(); ++i) {
        events_.push_back({covers_[i].first.value(), covers_[i].first, i, true});
        events_.push_back({covers_[i].last.value(), covers_[i].last, i, false});
    }
    for (const SegmentPlace& place : touches_)
        events_.push_back({place.value(), place});
    std::sort(events_.begin(), events_.end(), is_before);
}

void EdgeSweep::change_active(const Event& event) {
    if (event.cover == no_cover)
        return;
    if (event.begins)
        active_.push_back(event.cover);
    else
        active_.erase(std::find(active_.begin(), active_.end(), event.cover));
}

/// Whether what hid the part of the edge before hides this one as well.
bool EdgeSweep::is_still_hidden() const {
    bool is_there = false;
    for (const std::uint32_t i : active_) {
        is_there = is_there || i == hidden_by_;
        if (covers_[i].sides != (left_side | right_side)
            && !seen_.hides(covers_[hidden_by_].triangle, covers_[i].triangle))
            return false;
    }
    return is_there;
}

/// What is seen on the left and on the right between the events, or nothing where that is the same.
std::array<const Cover*, 2> EdgeSweep::seen_between(const Event& first, const Event& last) {
    seen_.start(place_at(first.value), place_at(last.value));
    if (hidden_by_ != no_cover && is_still_hidden())
        return {};
    for (const std::uint32_t i : active_)
        seen_.add(covers_[i].triangle, covers_[i].sides);
    const SeenBeside::Seen seen = seen_.find(result_->penetrating);
    hidden_by_ = seen.hidden_by == SeenBeside::nothing ? no_cover : active_[seen.hidden_by];
    const auto cover = [&](std::uint32_t number) {
        return number == SeenBeside::nothing ? nullptr : &covers_[active_[number]];
    };
    return {cover(seen.left), cover(seen.right)};
}

/// Of several edges in one place that what is seen beside it has, one speaks for all.
bool speaks_here(std::uint32_t edge, const Cover* left, const Cover* right) {
    std::uint32_t first = no_edge;
    for (const Cover* cover : {left, right})
        if (cover != nullptr)
            first = std::min(first, cover->edge);
    return edge == first;
}

void EdgeSweep::follow(std::uint32_t edge, VisiblePieces& result) {
    if (raster_.is_hidden[edge] != 0)
        return;
    gather(edge);
    result_ = &result;
    seen_.follow(begin_, end_);
    covers_.clear();
    touches_.clear();
    for (const std::uint32_t triangle : candidates_)
        add_cover(triangle);
    sort_events();
    active_.clear();
    hidden_by_ = no_cover;

    struct Piece {
        SegmentPlace first;
        std::uint32_t left = no_triangle;
        std::uint32_t right = no_triangle;
    };

    Piece open;
    const auto is_open = [&] { return source_of(open.left) != source_of(open.right); };
    const auto close = [&](SegmentPlace last) {
        if (is_open())
            result.pieces.push_back(
                {point_at(begin_, end_, open.first),
                 point_at(begin_, end_, last),
                 begin_,
                 end_,
                 open.left,
                 open.right});
    };
    for (std::size_t i = 0; i < events_.size();) {
        const Event& here = events_[i];
        std::size_t next = i;
        bool is_touched = false;
        for (; next < events_.size() && is_at_the_same_place(here, events_[next]); ++next) {
            change_active(events_[next]);
            // What covers one side has a corner where it begins and where it ends.
            is_touched = is_touched || events_[next].cover == no_cover
                || covers_[events_[next].cover].sides != (left_side | right_side);
        }
        Piece piece = {here.place};
        if (next < events_.size()) {
            const auto [left, right] = seen_between(here, events_[next]);
            if (speaks_here(edge, left, right)) {
                piece.left = left != nullptr ? left->triangle : no_triangle;
                piece.right = right != nullptr ? right->triangle : no_triangle;
            }
        }
        // Where a corner touches the edge, or others of the same source come to be seen, what is
        // seen beside it may be the same before and behind, and yet other edges end there.
        if (is_touched || piece.left != open.left || piece.right != open.right) {
            close(here.place);
            open = piece;
        }
        i = next;
    }
}

/// Whether the edge is a point, or lies behind what covers all its cells by more than the margin.
bool is_hidden(const Raster& raster, const ScreenEdges::Edge& edge, double margin) {
    const ScreenVertex& a = raster.scene.vertices[edge.begin];
    const ScreenVertex& b = raster.scene.vertices[edge.end];
    const double near = static_cast<double>(std::max(a.nearness, b.nearness)) + margin;
    return a.point == b.point
        || for_each_cell_along(raster.cells, a.point, b.point, [&](std::size_t cell) {
               return near < raster.cells.blocked[cell];
           });
}

/// Of each edge the largest hidden_margin() of its triangles.
std::vector<double> edge_margins(const Raster& raster) {
    std::vector<double> margins(raster.edges.edges.size());
    for (std::size_t i = 0; i < raster.slopes.size(); ++i)
        for (const std::uint32_t edge : raster.edges.of_triangle[i])
            margins[edge] = std::max(margins[edge], hidden_margin(raster.slopes[i]));
    return margins;
}

Raster raster_of(const ScreenScene& scene, const CancelFlag* cancel) {
    Raster raster = {scene, {}, {}, {}, {}, {}, {}};
    raster.planes.resize(scene.triangles.size());
    raster.slopes.resize(scene.triangles.size());
    raster.corners.resize(scene.triangles.size());
    for (std::size_t i = 0; i < raster.planes.size(); ++i) {
        const std::array<ScreenVertex, 3> corners = corners_of(scene, scene.triangles[i]);
        raster.planes[i] = depth_plane(corners);
        raster.slopes[i] = nearness_slope(raster.planes[i]);
        raster.corners[i] = {corners[0].point, corners[1].point, corners[2].point};
    }
    raster.edges = screen_edges(scene);
    raster.cells = cells_of(scene, raster.planes, raster.slopes, cancel);
    const std::vector<double> margins = edge_margins(raster);
    raster.is_hidden.resize(raster.edges.edges.size());
    parallel_ranges(raster.is_hidden.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            raster.is_hidden[i] = is_hidden(raster, raster.edges.edges[i], margins[i]) ? 1 : 0;
    });
    return raster;
}

} // namespace

VisiblePieces
cell_raster(const ScreenScene& scene, const Progress& progress, const CancelFlag* cancel) {
    constexpr std::size_t part = 4096; // edges
    const Raster raster = raster_of(scene, cancel);
    const std::size_t count = raster.edges.edges.size();
    std::vector<VisiblePieces> parts((count + part - 1) / part);
    std::mutex mutex;
    std::vector<std::unique_ptr<EdgeSweep>> sweeps;
    std::size_t done = 0;
    parallel_ranges(parts.size(), 1, [&](std::size_t first, std::size_t last) {
        std::unique_ptr<EdgeSweep> sweep;
        {
            const std::lock_guard lock(mutex);
            if (!sweeps.empty()) {
                sweep = std::move(sweeps.back());
                sweeps.pop_back();
            }
        }
        if (!sweep)
            sweep = std::make_unique<EdgeSweep>(raster);
        for (std::size_t i = first; i < last; ++i) {
            const std::size_t end = std::min(count, (i + 1) * part);
            for (std::size_t edge = i * part; edge < end; ++edge) {
                if (cancel != nullptr && edge % 16 == 0)
                    cancel->throw_if_raised();
                sweep->follow(static_cast<std::uint32_t>(edge), parts[i]);
            }
        }
        const std::lock_guard lock(mutex);
        sweeps.push_back(std::move(sweep));
        done += last - first;
        if (progress)
            progress(static_cast<double>(done) / static_cast<double>(parts.size()));
    });

    VisiblePieces result;
    std::size_t pieces = 0;
    for (const VisiblePieces& of_part : parts)
        pieces += of_part.pieces.size();
    result.pieces.reserve(pieces);
    for (VisiblePieces& of_part : parts) {
        result.pieces.insert(result.pieces.end(), of_part.pieces.begin(), of_part.pieces.end());
        result.penetrating.insert(
            result.penetrating.end(), of_part.penetrating.begin(), of_part.penetrating.end());
    }
    std::sort(result.penetrating.begin(), result.penetrating.end());
    result.penetrating.erase(
        std::unique(result.penetrating.begin(), result.penetrating.end()),
        result.penetrating.end());
    return result;
}

} // namespace vera
