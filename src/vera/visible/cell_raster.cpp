// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cell_raster.h"

#include "vera/exact/front_order.h"
#include "vera/visible/cells.h"
#include "vera/visible/edges.h"
#include "vera/visible/seen_beside.h"
#include "vera/visible/shadow_cells.h"
#include "vera/visible/sheets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
    Cells cells; ///< of surfaces
    ShadowCells shadow_cells;
    std::vector<std::uint8_t> is_hidden; ///< edges that lie behind what covers all their cells
    std::vector<std::uint8_t> is_inner;  ///< edges between two parts of one shadow
    /// Of edges that nothing has but shadows on one source, that source: other sources' shadows do
    /// not matter beside them. no_source of those that surfaces alone have, else several_sources.
    std::vector<std::uint32_t> shadowed_source;
    std::vector<std::uint8_t> is_near_change; ///< of edges; empty: all are
};

constexpr std::uint32_t several_sources = no_source - 1;

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

/// What is seen beside a part of an edge.
struct Seen {
    std::uint32_t triangle = no_triangle;
    LightSet unlit = 0;

    friend bool operator==(const Seen&, const Seen&) = default;
};

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
    bool gather(std::uint32_t edge);
    template <typename List, typename DoesMatter>
    void add_along(const List& list, const DoesMatter& does_matter);
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
    bool ends_a_shadow() const;
    bool ends_a_shadow_somewhere();
    void find_seen_sources(bool is_of_surfaces);
    bool has_one_sided() const;
    Seen seen(const Cover* nearest, std::uint8_t side) const;
    bool speaks_here(std::uint32_t edge, const Cover* left, const Cover* right) const;
    bool is_still_hidden() const;
    std::array<const Cover*, 2>
    seen_between(const Event& first, const Event& last, bool asks_always);

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
    std::vector<Cover> covers_;
    std::vector<SegmentPlace> touches_; ///< where a triangle has a corner on the edge
    std::vector<Event> events_;
    std::vector<std::uint32_t> active_; ///< covers by surfaces
    std::vector<std::uint32_t> active_shadows_;
    std::vector<std::uint32_t> seen_sources_;
    std::uint32_t hidden_by_ = no_cover; ///< on both sides of the part of the edge before
    ScreenPoint begin_;
    ScreenPoint end_;
    VisiblePieces* result_ = nullptr;
};

/// Adds those of the triangles list(cell) of the cells along the edge that matter.
template <typename List, typename DoesMatter>
void EdgeSweep::add_along(const List& list, const DoesMatter& does_matter) {
    for_each_cell_along(raster_.cells, begin_, end_, [&](std::size_t cell) {
        for (const std::uint32_t triangle : list(cell))
            if (stamps_[triangle] != stamp_ && does_matter(triangle)) {
                stamps_[triangle] = stamp_;
                add_cover(triangle);
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
    const std::uint32_t edge = raster_.edges.of_triangle[triangle][side];
    covers_.push_back(
        {triangle,
         is_left ? left_side : right_side,
         raster_.is_inner[edge] != 0 ? no_edge : edge,
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
    const bool is_shadow = raster_.scene.triangles[covers_[event.cover].triangle].is_shadow();
    std::vector<std::uint32_t>& active = is_shadow ? active_shadows_ : active_;
    if (event.begins)
        active.push_back(event.cover);
    else
        active.erase(std::find(active.begin(), active.end(), event.cover));
}

/// Whether a surface ends at the edge: else the same one is seen on both sides.
bool EdgeSweep::has_one_sided() const {
    return std::any_of(active_.begin(), active_.end(), [&](std::uint32_t i) {
        return covers_[i].sides != (left_side | right_side);
    });
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

/// Whether a shadow ends at the edge: other lights may reach what is seen there on its two sides.
/// Not where another shadow of the same light on the same source goes on.
bool EdgeSweep::ends_a_shadow() const {
    const auto shadow = [&](std::uint32_t i) -> const ScreenTriangle& {
        return raster_.scene.triangles[covers_[i].triangle];
    };
    const auto is_there = [&](std::uint32_t source) {
        return std::any_of(active_.begin(), active_.end(), [&](std::uint32_t i) {
            return source_of(covers_[i].triangle) == source;
        });
    };
    const auto goes_on = [&](std::uint32_t i) {
        return std::any_of(active_shadows_.begin(), active_shadows_.end(), [&](std::uint32_t j) {
            return (covers_[j].sides & ~covers_[i].sides) != 0 && shadow(j).light == shadow(i).light
                && shadow(j).source == shadow(i).source;
        });
    };
    return std::any_of(active_shadows_.begin(), active_shadows_.end(), [&](std::uint32_t i) {
        return covers_[i].sides != (left_side | right_side) && is_there(shadow(i).source)
            && !goes_on(i);
    });
}

/// Of one source and the shadows on it, which were added: whether one ends at the edge anywhere on
/// the source. Where many overlap, most do not, and nothing else needs to be compared with them.
bool EdgeSweep::ends_a_shadow_somewhere() {
    sort_events();
    // Of each light, how many shadows cover what is on the left and on the right.
    std::array<std::array<std::int32_t, 2>, most_lights_of_a_set> covering = {};
    int parted = 0;   // lights that reach but one side
    int surfaces = 0; // of the source
    const auto change = [&](const Event& event) {
        const Cover& cover = covers_[event.cover];
        const ScreenTriangle& triangle = raster_.scene.triangles[cover.triangle];
        const int more = event.begins ? 1 : -1;
        if (!triangle.is_shadow()) {
            surfaces += more;
            return;
        }
        std::array<std::int32_t, 2>& sides = covering[triangle.light];
        const auto is_parted = [&] { return (sides[0] > 0) != (sides[1] > 0) ? 1 : 0; };
        parted -= is_parted();
        sides[0] += (cover.sides & left_side) != 0 ? more : 0;
        sides[1] += (cover.sides & right_side) != 0 ? more : 0;
        parted += is_parted();
    };
    for (std::size_t i = 0; i < events_.size();) {
        const Event& here = events_[i];
        for (; i < events_.size() && is_at_the_same_place(here, events_[i]); ++i)
            if (events_[i].cover != no_cover)
                change(events_[i]);
        if (parted > 0 && surfaces > 0)
            return true;
    }
    return false;
}

/// Of the surfaces, which were added: the sources that are seen beside the edge or, of an edge of
/// surfaces alone, where it parts them. None is where the edge is hidden, whatever shadows there
/// are.
void EdgeSweep::find_seen_sources(bool is_of_surfaces) {
    seen_sources_.clear();
    sort_events();
    for (std::size_t i = 0; i < events_.size();) {
        const Event& here = events_[i];
        for (; i < events_.size() && is_at_the_same_place(here, events_[i]); ++i)
            change_active(events_[i]);
        if (i == events_.size())
            break;
        const auto [left, right] = seen_between(here, events_[i], !is_of_surfaces);
        for (const Cover* cover : {left, right})
            if (cover != nullptr && (left != right || !is_of_surfaces))
                seen_sources_.push_back(source_of(cover->triangle));
    }
    hidden_by_ = no_cover;
    std::sort(seen_sources_.begin(), seen_sources_.end());
    const auto last = std::unique(seen_sources_.begin(), seen_sources_.end());
    seen_sources_.erase(last, seen_sources_.end());
}

/// What is seen on the left and on the right between the events. Who does not always ask is told
/// nothing where that is the same.
std::array<const Cover*, 2>
EdgeSweep::seen_between(const Event& first, const Event& last, bool asks_always) {
    seen_.start(place_at(first.value), place_at(last.value));
    if (!asks_always && (!has_one_sided() || (hidden_by_ != no_cover && is_still_hidden())))
        return {};
    for (const std::uint32_t i : active_)
        seen_.add(covers_[i].triangle, covers_[i].sides);
    const SeenBeside::Seen seen = seen_.find(result_->penetrating, asks_always);
    hidden_by_ = seen.hidden_by == SeenBeside::nothing ? no_cover : active_[seen.hidden_by];
    const auto cover = [&](std::uint32_t number) {
        return number == SeenBeside::nothing ? nullptr : &covers_[active_[number]];
    };
    return {cover(seen.left), cover(seen.right)};
}

Seen EdgeSweep::seen(const Cover* nearest, std::uint8_t side) const {
    if (nearest == nullptr)
        return {};
    const std::uint32_t source = source_of(nearest->triangle);
    Seen seen = {nearest->triangle, raster_.scene.unlit_of(source)};
    for (const std::uint32_t i : active_shadows_) {
        const ScreenTriangle& shadow = raster_.scene.triangles[covers_[i].triangle];
        if ((covers_[i].sides & side) != 0 && shadow.source == source)
            seen.unlit |= LightSet{1} << shadow.light;
    }
    return seen;
}

/// Of several edges in one place that what is seen beside it has, one speaks for all: of those of
/// the surfaces or, within a surface, of those of the shadows on it.
bool EdgeSweep::speaks_here(std::uint32_t edge, const Cover* left, const Cover* right) const {
    std::uint32_t first = no_edge;
    for (const Cover* cover : {left, right})
        if (cover != nullptr)
            first = std::min(first, cover->edge);
    if (left == right && left != nullptr)
        for (const std::uint32_t i : active_shadows_)
            if (source_of(covers_[i].triangle) == source_of(left->triangle))
                first = std::min(first, covers_[i].edge);
    return edge == first;
}

/// Gathers the covers that matter for what is seen beside the edge; false where it parts nothing.
bool EdgeSweep::gather(std::uint32_t edge) {
    const auto& [begin, end] = raster_.edges.edges[edge];
    begin_ = raster_.scene.vertices[begin].point;
    end_ = raster_.scene.vertices[end].point;
    seen_.follow(begin_, end_);
    ++stamp_;
    covers_.clear();
    touches_.clear();
    active_.clear();
    active_shadows_.clear();
    hidden_by_ = no_cover;
    const auto all = [](std::uint32_t) { return true; };
    const auto surfaces = [&](std::size_t cell) { return raster_.cells.triangles_of(cell); };
    const auto add_shadows_on = [&](std::uint32_t source) {
        add_along(
            [&](std::size_t cell) {
                return raster_.shadow_cells.shadows_on(cell, source, raster_.scene);
            },
            all);
    };
    const std::uint32_t shadowed = raster_.shadowed_source[edge];
    const bool is_shadow = shadowed != no_source && shadowed != several_sources;
    if (is_shadow) {
        add_shadows_on(shadowed);
        add_along(surfaces, [&](std::uint32_t i) { return source_of(i) == shadowed; });
        if (!ends_a_shadow_somewhere())
            return false;
    }
    add_along(surfaces, all);
    if (is_shadow || raster_.shadow_cells.triangles.empty())
        return true;
    find_seen_sources(shadowed == no_source);
    for (const std::uint32_t source : seen_sources_)
        add_shadows_on(source);
    return !seen_sources_.empty();
}

void EdgeSweep::follow(std::uint32_t edge, VisiblePieces& result) {
    if (raster_.is_hidden[edge] != 0 || raster_.is_inner[edge] != 0)
        return;
    result_ = &result;
    if (!gather(edge))
        return;
    sort_events();
    hidden_by_ = no_cover;

    struct Piece {
        SegmentPlace first;
        Seen left = {};
        Seen right = {};
    };

    Piece open;
    const auto is_open = [&] {
        return source_of(open.left.triangle) != source_of(open.right.triangle)
            || open.left.unlit != open.right.unlit;
    };
    const auto close = [&](SegmentPlace last) {
        if (is_open())
            result.pieces.push_back(
                {point_at(begin_, end_, open.first),
                 point_at(begin_, end_, last),
                 begin_,
                 end_,
                 raster_.edges.edges[edge],
                 open.left.triangle,
                 open.right.triangle,
                 open.left.unlit,
                 open.right.unlit});
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
            const auto [left, right] = seen_between(here, events_[next], ends_a_shadow());
            if (speaks_here(edge, left, right)) {
                piece.left = seen(left, left_side);
                piece.right = seen(right, right_side);
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

/// Whether the edge is a point, or lies behind what covers all its cells, if it is so near.
bool is_hidden(const Raster& raster, const ScreenEdges::Edge& edge, double near) {
    const ScreenPoint a = raster.scene.vertices[edge.begin].point;
    const ScreenPoint b = raster.scene.vertices[edge.end].point;
    return a == b || for_each_cell_along(raster.cells, a, b, [&](std::size_t cell) {
               return near < raster.cells.blocked[cell];
           });
}

/// Of each edge how near it is in the planes of all triangles that have it.
std::vector<double> nearness_of_edges(const Raster& raster) {
    std::vector<double> nearness(
        raster.edges.edges.size(), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < raster.slopes.size(); ++i)
        for (const std::uint32_t edge : raster.edges.of_triangle[i]) {
            const auto& [begin, end] = raster.edges.edges[edge];
            nearness[edge] = std::max(
                nearness[edge],
                nearest_for_hiding(
                    raster.slopes[i],
                    std::array{
                        raster.scene.vertices[begin].point, raster.scene.vertices[end].point}));
        }
    return nearness;
}

/// Whether the edge parts two parts of one shadow: beside it the same is seen. (Where several are
/// on a side, it is followed like any other.)
bool is_inner(const ScreenScene& scene, const EdgeNeighbours& beside) {
    if (!beside.are_two())
        return false;
    const ScreenTriangle& left = scene.triangles[beside.left];
    const ScreenTriangle& right = scene.triangles[beside.right];
    return left.is_shadow() && left.light == right.light && left.source == right.source;
}

std::vector<std::uint32_t> shadowed_sources(const ScreenScene& scene, const ScreenEdges& edges) {
    constexpr std::uint32_t none = several_sources - 1;
    std::vector<std::uint32_t> sources(edges.edges.size(), none);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i)
        for (const std::uint32_t edge : edges.of_triangle[i]) {
            const ScreenTriangle& triangle = scene.triangles[i];
            const std::uint32_t source = triangle.is_shadow() ? triangle.source : no_source;
            const bool is_same = sources[edge] == none || sources[edge] == source;
            sources[edge] = is_same ? source : several_sources;
        }
    return sources;
}

Raster raster_of(const ScreenScene& scene, const CancelFlag* cancel) {
    Raster raster = {scene, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    raster.planes.resize(scene.triangles.size());
    raster.slopes.resize(scene.triangles.size());
    raster.corners.resize(scene.triangles.size());
    for (std::size_t i = 0; i < raster.planes.size(); ++i) {
        const std::array<ScreenVertex, 3> corners = corners_of(scene, scene.triangles[i]);
        raster.planes[i] = plane_of(scene, scene.triangles[i]);
        raster.slopes[i] = nearness_slope(raster.planes[i]);
        raster.corners[i] = {corners[0].point, corners[1].point, corners[2].point};
    }
    raster.edges = screen_edges(scene);
    raster.shadowed_source = shadowed_sources(scene, raster.edges);
    const std::vector<EdgeNeighbours> neighbours = edge_neighbours(scene, raster.edges);
    raster.is_inner.resize(neighbours.size());
    for (std::size_t i = 0; i < neighbours.size(); ++i)
        raster.is_inner[i] = is_inner(scene, neighbours[i]) ? 1 : 0;
    raster.cells = cells_of(scene, raster.planes, raster.slopes, cancel);
    block_by_sheets(raster.cells, {scene, raster.edges, neighbours, raster.planes, raster.slopes});
    raster.shadow_cells = shadow_cells_of(raster.cells, scene, raster.slopes, cancel);
    const std::vector<double> nearness = nearness_of_edges(raster);
    raster.is_hidden.resize(raster.edges.edges.size());
    parallel_ranges(raster.is_hidden.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            raster.is_hidden[i] = is_hidden(raster, raster.edges.edges[i], nearness[i]) ? 1 : 0;
    });
    return raster;
}

/// Which edges lie in a cell that what was changed touches, or did.
std::vector<std::uint8_t> edges_near(const SceneChange& change, const Raster& raster) {
    std::vector<std::uint8_t> is_changed(raster.cells.blocked.size());
    const auto mark = [&](const std::array<ScreenVertex, 3>& corners) {
        for_each_cell_of(raster.cells, corners, [&](std::size_t cell) { is_changed[cell] = 1; });
    };
    for (const std::uint32_t triangle : change.triangles)
        mark(corners_of(raster.scene, raster.scene.triangles[triangle]));
    for (const std::array<ScreenVertex, 3>& corners : change.places)
        mark(corners);
    std::vector<std::uint8_t> near(raster.edges.edges.size());
    parallel_ranges(near.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto point = [&](std::uint32_t vertex) {
                return raster.scene.vertices[vertex].point;
            };
            const auto& [begin, end] = raster.edges.edges[i];
            const bool is_far =
                for_each_cell_along(raster.cells, point(begin), point(end), [&](std::size_t cell) {
                    return is_changed[cell] == 0;
                });
            near[i] = is_far ? 0 : 1;
        }
    });
    return near;
}

/// Lends one EdgeSweep to each thread that works.
class EdgeSweeps {
public:
    explicit EdgeSweeps(const Raster& raster)
        : raster_(raster) {}

    std::unique_ptr<EdgeSweep> take() {
        const std::lock_guard lock(mutex_);
        if (idle_.empty())
            return std::make_unique<EdgeSweep>(raster_);
        std::unique_ptr<EdgeSweep> sweep = std::move(idle_.back());
        idle_.pop_back();
        return sweep;
    }

    void give_back(std::unique_ptr<EdgeSweep> sweep) {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(sweep));
    }

private:
    const Raster& raster_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<EdgeSweep>> idle_;
};

/// Of the pieces before, those of edges from this one on.
auto first_piece_of(const std::vector<VisiblePiece>& before, ScreenEdges::Edge edge) {
    return std::lower_bound(
        before.begin(),
        before.end(),
        edge,
        [](const VisiblePiece& piece, const ScreenEdges::Edge& value) {
            return piece.edge < value;
        });
}

/// Follows the edges that are near what was changed, or all, and keeps the pieces of the others.
VisiblePieces follow_edges(
    const Raster& raster,
    const std::vector<VisiblePiece>& before,
    const Progress& progress,
    const CancelFlag* cancel) {
    constexpr std::size_t part = 4096; // edges
    const std::vector<ScreenEdges::Edge>& edges = raster.edges.edges;
    std::vector<VisiblePieces> parts((edges.size() + part - 1) / part);
    EdgeSweeps sweeps(raster);
    std::mutex mutex;
    std::size_t done = 0;
    const auto follow_part = [&](std::size_t number, EdgeSweep& sweep) {
        const std::size_t end = std::min(edges.size(), (number + 1) * part);
        auto kept = first_piece_of(before, edges[number * part]);
        for (std::size_t i = number * part; i < end; ++i) {
            if (cancel != nullptr && i % 16 == 0)
                cancel->throw_if_raised();
            const bool is_followed = raster.is_near_change.empty() || raster.is_near_change[i] != 0;
            if (is_followed)
                sweep.follow(static_cast<std::uint32_t>(i), parts[number]);
            for (; kept != before.end() && kept->edge <= edges[i]; ++kept)
                if (!is_followed && kept->edge == edges[i])
                    parts[number].pieces.push_back(*kept);
        }
    };
    parallel_ranges(parts.size(), 1, [&](std::size_t first, std::size_t last) {
        std::unique_ptr<EdgeSweep> sweep = sweeps.take();
        for (std::size_t i = first; i < last; ++i)
            follow_part(i, *sweep);
        sweeps.give_back(std::move(sweep));
        const std::lock_guard lock(mutex);
        done += last - first;
        if (progress)
            progress(static_cast<double>(done) / static_cast<double>(parts.size()));
    });

    VisiblePieces result;
    std::size_t pieces = 0;
    for (const VisiblePieces& of_part : parts)
        pieces += of_part.pieces.size();
    result.pieces.reserve(pieces);
    for (const VisiblePieces& of_part : parts) {
        result.pieces.insert(result.pieces.end(), of_part.pieces.begin(), of_part.pieces.end());
        result.penetrating.insert(
            result.penetrating.end(), of_part.penetrating.begin(), of_part.penetrating.end());
    }
    return result;
}

void sort_pairs(std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

} // namespace

VisiblePieces
cell_raster(const ScreenScene& scene, const Progress& progress, const CancelFlag* cancel) {
    VisiblePieces result = follow_edges(raster_of(scene, cancel), {}, progress, cancel);
    sort_pairs(result.penetrating);
    return result;
}

VisiblePieces cell_raster_after(
    const SceneChange& change,
    VisiblePieces before,
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel) {
    Raster raster = raster_of(scene, cancel);
    raster.is_near_change = edges_near(change, raster);
    // Where no shadow is near, there is none.
    const auto unlit = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? 0 : scene.unlit_of(scene.triangles[triangle].source);
    };
    std::vector<std::uint8_t> is_changed(scene.triangles.size());
    for (const std::uint32_t triangle : change.triangles)
        is_changed[triangle] = 1;
    for (VisiblePiece& piece : before.pieces) {
        piece.left_unlit = unlit(piece.left);
        piece.right_unlit = unlit(piece.right);
    }
    VisiblePieces result = follow_edges(raster, before.pieces, progress, cancel);
    for (const auto& [a, b] : before.penetrating)
        if (is_changed[a] == 0 && is_changed[b] == 0)
            result.penetrating.emplace_back(a, b);
    sort_pairs(result.penetrating);
    return result;
}

} // namespace vera
