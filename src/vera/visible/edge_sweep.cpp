// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/edge_sweep.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace vera {

namespace {

/// Places as doubles tell them apart from here on: they are off by 2^-52.
constexpr double surely_apart = 1e-14;

constexpr SegmentPlace beginning = {0, 1};
constexpr SegmentPlace ending = {1, 1};

SegmentPlace clamped(SegmentPlace place) {
    if (place.numerator < 0)
        return beginning;
    return place.numerator > place.denominator ? ending : place;
}

} // namespace

/// Tells how those of the triangles list(cell) of the cells along the edge that matter lie to it.
template <typename List, typename DoesMatter>
void EdgeSweep::classify_along(const List& list, const DoesMatter& does_matter) {
    for_each_cell_along(raster_.cells, begin_, end_, [&](std::size_t cell) {
        const std::span<const std::uint32_t> here = list(cell);
        ++counts_.followed_cells;
        counts_.looked_at += here.size();
        for (const std::uint32_t triangle : here)
            if (stamps_[triangle] != stamp_ && does_matter(triangle)) {
                stamps_[triangle] = stamp_;
                ++counts_.candidates;
                classify(triangle);
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
         raster_.is_inner(edge) ? no_edge : edge,
         first,
         last});
}

void EdgeSweep::add_across(const Across& across) {
    const std::array<ScreenPoint, 3>& corners = raster_.corners[across.triangle];
    const std::array<std::int64_t, 3>& sides = across.sides;
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
    if (order(first, last) < 0 && !is_hidden(first, last))
        covers_.push_back({across.triangle, left_side | right_side, no_edge, first, last});
}

/// Tells how the triangle lies to the edge.
void EdgeSweep::classify(std::uint32_t triangle) {
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
    Across across = {triangle, {}};
    std::size_t on_line = 0;
    bool left = false;
    bool right = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t side = across.sides[i] = orientation(begin_, end_, corners[i]);
        on_line += side == 0 ? 1 : 0;
        left = left || side > 0;
        right = right || side < 0;
    }
    if (left && right)
        return across_.push_back(across);
    if (on_line == 2)
        return add_beside(
            triangle,
            corners,
            across.sides[0] != 0       ? 1
                : across.sides[1] != 0 ? 2
                                       : 0);
    for (std::size_t i = 0; i < 3 && on_line == 1; ++i)
        if (across.sides[i] == 0)
            add_touch(corners[i]);
}

/// Of a triangle that has a corner on the line of the edge.
void EdgeSweep::add_touch(ScreenPoint corner) {
    const SegmentPlace place = place_on(begin_, end_, corner);
    if (place.numerator > 0 && place.numerator < place.denominator)
        touches_.push_back(place);
}

/// Finds the parts of the edge along which triangles surely lie before all that covers but one side
/// of it: the same is then seen on both. They become covers by no triangle; the triangles before
/// them are taken out of across_, since they matter nowhere else.
void EdgeSweep::find_hidden_parts() {
    first_hidden_ = last_hidden_ = covers_.size();
    // How near, with their margins, what covers but one side is at both ends of the edge.
    std::array<double, 2> to_hide = {-1, -1};
    const std::array<NearnessPlace, 2> ends = {place_at(0), place_at(1)};
    const auto is_shadow = [&](std::uint32_t triangle) {
        return raster_.scene.triangles[triangle].is_shadow();
    };
    for (const Cover& cover : covers_) {
        if (cover.is_on_both_sides())
            continue;
        const NearnessSlope& slope = raster_.slopes[cover.triangle];
        for (std::size_t i = 0; i < 2; ++i)
            to_hide[i] = std::max(to_hide[i], slope.at(ends[i]) + sure_margin(slope));
    }
    std::erase_if(across_, [&](const Across& across) {
        const NearnessSlope& slope = raster_.slopes[across.triangle];
        const double margin = sure_margin(slope);
        const bool hides = slope.at(ends[0]) - margin > to_hide[0]
            && slope.at(ends[1]) - margin > to_hide[1] && !is_shadow(across.triangle);
        if (hides)
            add_across(across);
        return hides;
    });
    const auto first = covers_.begin() + static_cast<std::ptrdiff_t>(first_hidden_);
    std::sort(first, covers_.end(), [](const Cover& a, const Cover& b) {
        return order(a.first, b.first) < 0;
    });
    auto last = first; // behind the parts
    for (auto cover = first; cover != covers_.end(); ++cover) {
        if (last != first && order(cover->first, (last - 1)->last) <= 0) {
            if (order(cover->last, (last - 1)->last) > 0)
                (last - 1)->last = cover->last;
        } else {
            *last++ = {no_triangle, left_side | right_side, no_edge, cover->first, cover->last};
        }
    }
    covers_.erase(last, covers_.end());
    last_hidden_ = covers_.size();
}

/// Of what find_hidden_parts() found.
bool EdgeSweep::is_hidden(SegmentPlace first, SegmentPlace last) const {
    const auto parts = std::span(covers_).subspan(first_hidden_, last_hidden_ - first_hidden_);
    // They lie apart from each other, in their order.
    const auto behind = std::partition_point(parts.begin(), parts.end(), [&](const Cover& part) {
        return order(part.first, first) <= 0;
    });
    return behind != parts.begin() && order(last, (behind - 1)->last) <= 0;
}

void EdgeSweep::sort_events() {
    events_.clear();
    for (std::uint32_t i = 0; i < covers_.size(); ++i) {
        events_.push_back({covers_[i].first.value(), i, Event::begins});
        events_.push_back({covers_[i].last.value(), i, Event::ends});
    }
    for (std::uint32_t i = 0; i < touches_.size(); ++i)
        events_.push_back({touches_[i].value(), i, Event::touches});
    counts_.events += events_.size();
    std::sort(events_.begin(), events_.end(), [&](const Event& a, const Event& b) {
        if (std::abs(a.value - b.value) > surely_apart)
            return a.value < b.value;
        return order(place_of(a), place_of(b)) < 0;
    });
}

/// Before the first event.
void EdgeSweep::start_events() {
    active_.clear();
    active_shadows_.clear();
    hidden_by_ = no_cover;
    is_hidden_here_ = false;
}

bool EdgeSweep::are_at_the_same_place(const Event& a, const Event& b) const {
    return std::abs(a.value - b.value) <= surely_apart && order(place_of(a), place_of(b)) == 0;
}

void EdgeSweep::change_active(const Event& event) {
    if (event.kind == Event::touches)
        return;
    if (covers_[event.number].triangle == no_triangle) {
        is_hidden_here_ = event.kind == Event::begins;
        return;
    }
    const bool is_shadow = raster_.scene.triangles[covers_[event.number].triangle].is_shadow();
    std::vector<std::uint32_t>& active = is_shadow ? active_shadows_ : active_;
    if (event.kind == Event::begins)
        active.push_back(event.number);
    else
        active.erase(std::find(active.begin(), active.end(), event.number));
}

/// Whether a surface ends at the edge: else the same one is seen on both sides.
bool EdgeSweep::has_one_sided() const {
    return std::any_of(active_.begin(), active_.end(), [&](std::uint32_t i) {
        return !covers_[i].is_on_both_sides();
    });
}

/// Whether what hid the part of the edge before hides this one as well.
bool EdgeSweep::is_still_hidden() const {
    bool is_there = false;
    for (const std::uint32_t i : active_) {
        is_there = is_there || i == hidden_by_;
        if (!covers_[i].is_on_both_sides()
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
        return !covers_[i].is_on_both_sides() && is_there(shadow(i).source) && !goes_on(i);
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
        const Cover& cover = covers_[event.number];
        const ScreenTriangle& triangle = raster_.scene.triangles[cover.triangle];
        const int more = event.kind == Event::begins ? 1 : -1;
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
        for (; i < events_.size() && are_at_the_same_place(here, events_[i]); ++i)
            if (events_[i].kind != Event::touches)
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
    start_events();
    for (std::size_t i = 0; i < events_.size();) {
        const Event& here = events_[i];
        for (; i < events_.size() && are_at_the_same_place(here, events_[i]); ++i)
            change_active(events_[i]);
        if (i == events_.size())
            break;
        if (is_hidden_here_)
            continue;
        const std::size_t pairs = result_->penetrating.size();
        const auto [left, right] = seen_between(here.value, events_[i].value, !is_of_surfaces);
        // Where some pass through each other, others than those in the middle are seen as well.
        if (result_->penetrating.size() > pairs)
            for (const std::uint32_t cover : active_)
                seen_sources_.push_back(source_of(covers_[cover].triangle));
        for (const Cover* cover : {left, right})
            if (cover != nullptr && (left != right || !is_of_surfaces))
                seen_sources_.push_back(source_of(cover->triangle));
    }
    std::sort(seen_sources_.begin(), seen_sources_.end());
    const auto last = std::unique(seen_sources_.begin(), seen_sources_.end());
    seen_sources_.erase(last, seen_sources_.end());
}

/// What is seen on the left and on the right between the places. Who does not always ask is told
/// nothing where that is the same.
std::array<const EdgeSweep::Cover*, 2>
EdgeSweep::seen_between(double first, double last, bool asks_always) {
    seen_.start(place_at(first), place_at(last));
    counts_.active += active_.size();
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

EdgeSweep::Seen EdgeSweep::seen(const Cover* nearest, std::uint8_t side) const {
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

void EdgeSweep::add_all_across() {
    for (const Across& across : across_)
        add_across(across);
    across_.clear();
}

/// Gathers the covers that matter for what is seen beside the edge; false where it parts nothing.
bool EdgeSweep::gather(std::uint32_t edge) {
    const auto& [begin, end] = raster_.edges.edges[edge];
    begin_ = raster_.scene.vertices[begin].point;
    end_ = raster_.scene.vertices[end].point;
    seen_.follow(begin_, end_);
    ++stamp_;
    ++counts_.followed;
    across_.clear();
    covers_.clear();
    touches_.clear();
    first_hidden_ = last_hidden_ = 0;
    const auto all = [](std::uint32_t) { return true; };
    const auto surfaces = [&](std::size_t cell) { return raster_.cells.triangles_of(cell); };
    const auto add_shadows_on = [&](std::uint32_t source) {
        classify_along(
            [&](std::size_t cell) {
                return raster_.shadow_cells.shadows_on(cell, source, raster_.scene);
            },
            all);
        add_all_across();
    };
    const std::uint32_t shadowed = raster_.shadowed_source(edge);
    const bool is_of_surfaces = shadowed == no_source;
    const bool is_of_shadows = !is_of_surfaces && shadowed != several_sources;
    if (is_of_shadows) {
        add_shadows_on(shadowed);
        classify_along(surfaces, [&](std::uint32_t i) { return source_of(i) == shadowed; });
        add_all_across();
        if (!ends_a_shadow_somewhere())
            return false;
    }
    classify_along(surfaces, all);
    if (shadowed != several_sources) {
        find_hidden_parts();
        if (is_hidden(beginning, ending))
            return false;
    }
    add_all_across();
    if (is_of_shadows || raster_.shadow_cells.triangles.empty())
        return true;
    find_seen_sources(is_of_surfaces);
    for (const std::uint32_t source : seen_sources_)
        add_shadows_on(source);
    return !seen_sources_.empty();
}

void EdgeSweep::follow(std::uint32_t edge, VisiblePieces& result) {
    if (raster_.is_hidden[edge] != 0 || raster_.is_inner(edge))
        return;
    result_ = &result;
    if (!gather(edge))
        return;
    sort_events();
    start_events();

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
        if (!is_open())
            return;
        const auto number = static_cast<std::uint32_t>(result.points.size());
        result.points.push_back(point_at(begin_, end_, open.first));
        result.points.push_back(point_at(begin_, end_, last));
        result.pieces.push_back(
            {number,
             number + 1,
             raster_.edges.edges[edge],
             open.left.triangle,
             open.right.triangle});
        if (raster_.may_be_unlit())
            result.unlit.push_back({open.left.unlit, open.right.unlit});
    };
    for (std::size_t i = 0; i < events_.size();) {
        const Event& here = events_[i];
        std::size_t next = i;
        bool is_touched = false;
        for (; next < events_.size() && are_at_the_same_place(here, events_[next]); ++next) {
            change_active(events_[next]);
            // What covers one side has a corner where it begins and where it ends.
            is_touched = is_touched || events_[next].kind == Event::touches
                || !covers_[events_[next].number].is_on_both_sides();
        }
        Piece piece = {place_of(here)};
        if (next < events_.size() && !is_hidden_here_) {
            const auto [left, right] =
                seen_between(here.value, events_[next].value, ends_a_shadow());
            if (speaks_here(edge, left, right)) {
                piece.left = seen(left, left_side);
                piece.right = seen(right, right_side);
            }
        }
        // Where a corner touches the edge, or others of the same source come to be seen, what is
        // seen beside it may be the same before and behind, and yet other edges end there.
        if (is_touched || piece.left != open.left || piece.right != open.right) {
            close(place_of(here));
            open = piece;
        }
        i = next;
    }
}

} // namespace vera
