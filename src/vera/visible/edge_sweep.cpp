// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/edge_sweep.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vera {

namespace {

/// Places as doubles tell them apart from here on: they are off by 2^-52.
constexpr double surely_apart = 1e-14;

/// So few covers that to leave some out takes longer than to look at them.
constexpr std::size_t few_covers = 8;

} // namespace

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
    left_out_.clear();
    ending_shadows_.clear();
    hidden_by_ = no_cover;
    is_hidden_here_ = false;
    shadows_.clear();
    if (may_be_shadow_)
        for (const Cover& cover : covers_)
            if (is_shadow(cover.triangle))
                shadows_.expect(raster_.scene.triangles[cover.triangle]);
    shadows_.start();
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
    Cover& cover = covers_[event.number];
    const bool begins = event.kind == Event::begins;
    if (may_be_shadow_)
        shadows_.change(raster_.scene.triangles[cover.triangle], cover.sides, begins ? 1 : -1);
    const bool ends_beside = is_shadow(cover.triangle);
    if (ends_beside && cover.is_on_both_sides())
        return;
    std::vector<std::uint32_t>& active = ends_beside ? ending_shadows_ : active_;
    if (begins)
        active.push_back(event.number);
    else if (std::exchange(cover.behind, no_cover) == no_cover)
        active.erase(std::find(active.begin(), active.end(), event.number));
    if (std::exchange(cover.leaves_others_out, false))
        bring_back_behind(event.number);
}

/// Leaves out of the active covers those on both sides that lie behind one of them from the place
/// on, until either ends: what is seen is no matter of what is surely hidden. By twice the margins
/// at both ends, so that it is by one of them in all parts between, whatever rounding does.
void EdgeSweep::leave_out_behind(std::uint32_t foremost, double here) {
    Cover& nearest = covers_[foremost];
    const NearnessSlope& front = raster_.slopes[nearest.triangle];
    const double last = nearest.last.value();
    std::erase_if(active_, [&](std::uint32_t i) {
        Cover& cover = covers_[i];
        if (!cover.is_on_both_sides())
            return false;
        const NearnessSlope& slope = raster_.slopes[cover.triangle];
        const double margin = 2 * (sure_margin(front) + sure_margin(slope));
        const auto is_behind = [&](double place) {
            const NearnessPlace at = place_at(place);
            return front.at(at) - slope.at(at) > margin;
        };
        if (!is_behind(here) || !is_behind(std::min(last, cover.last.value())))
            return false;
        cover.behind = foremost;
        nearest.leaves_others_out = true;
        left_out_.push_back(i);
        return true;
    });
}

/// What was left out behind the cover that ended here, and goes on, is active again.
void EdgeSweep::bring_back_behind(std::uint32_t ended) {
    std::erase_if(left_out_, [&](std::uint32_t i) {
        const std::uint32_t behind = covers_[i].behind;
        if (behind == ended) {
            covers_[i].behind = no_cover;
            active_.push_back(i);
        }
        return behind == ended || behind == no_cover;
    });
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

/// Of one source and the shadows on it, which were added: whether one ends at the edge anywhere on
/// the source. Where many overlap, most do not, and nothing else needs to be compared with them.
bool EdgeSweep::ends_a_shadow_somewhere() {
    sort_events();
    start_events();
    for (std::size_t i = 0; i < events_.size();) {
        const Event& here = events_[i];
        for (; i < events_.size() && are_at_the_same_place(here, events_[i]); ++i)
            change_active(events_[i]);
        if (shadows_.is_any_parted())
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
        const auto [left, right] =
            seen_between(here.value, events_[i].value, Hiding::by_what_covers, !is_of_surfaces);
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

/// What hides along the part between the places.
Hiding EdgeSweep::hiding_between(double first, double last) const {
    const bool is_open = std::ranges::any_of(open_parts_, [&](const std::array<double, 2>& part) {
        return first <= part[1] && last >= part[0];
    });
    return is_open ? Hiding::by_nothing : Hiding::by_what_covers;
}

/// What is seen on the left and on the right between the places. Who does not always ask is told
/// nothing where that is the same.
std::array<const EdgeSweep::Cover*, 2>
EdgeSweep::seen_between(double first, double last, Hiding hiding, bool asks_always) {
    counts_.active += active_.size();
    if (!asks_always && !has_one_sided())
        return {};
    seen_.start(place_at(first), place_at(last), hiding);
    if (!asks_always && hiding == Hiding::by_what_covers && hidden_by_ != no_cover
        && is_still_hidden())
        return {};
    for (const std::uint32_t i : active_)
        seen_.add(covers_[i].triangle, covers_[i].sides);
    const SeenBeside::Seen seen = seen_.find(result_->penetrating, asks_always);
    hidden_by_ = seen.hidden_by == SeenBeside::nothing ? no_cover : active_[seen.hidden_by];
    const auto cover = [&](std::uint32_t number) {
        return number == SeenBeside::nothing ? nullptr : &covers_[active_[number]];
    };
    const std::array<const Cover*, 2> found = {cover(seen.left), cover(seen.right)};
    // Near open points all that is there is asked.
    if (active_.size() > few_covers && seen_.foremost() != SeenBeside::nothing
        && open_parts_.empty())
        leave_out_behind(active_[seen_.foremost()], first);
    return found;
}

EdgeSweep::Seen EdgeSweep::seen(const Cover* nearest, std::uint8_t side) const {
    if (nearest == nullptr)
        return {};
    const std::uint32_t source = source_of(nearest->triangle);
    const LightSet unlit = raster_.scene.unlit_of(source);
    return {nearest->triangle, may_be_shadow_ ? unlit | shadows_.lights(source, side) : unlit};
}

/// Of several edges in one place that what is seen beside it has, one speaks for all: of those of
/// the surfaces or, within a surface, of those of the shadows on it.
bool EdgeSweep::speaks_here(
    std::uint32_t edge, const Cover* left, const Cover* right, Hiding hiding) const {
    std::uint32_t first = no_edge;
    for (const Cover* cover : {left, right})
        if (cover != nullptr)
            first = std::min(first, cover->edge);
    // Where the order goes round, what ends here may decide between two others that do not.
    if (first == no_edge && left != right && hiding == Hiding::by_nothing)
        for (const std::uint32_t i : active_)
            first = std::min(first, covers_[i].edge);
    if (left == right && left != nullptr)
        for (const std::uint32_t i : ending_shadows_)
            if (source_of(covers_[i].triangle) == source_of(left->triangle))
                first = std::min(first, covers_[i].edge);
    return edge == first;
}

void EdgeSweep::follow(std::uint32_t edge, VisiblePieces& result) {
    if (raster_.hidden_eighths[edge] == all_eighths || raster_.is_inner(edge))
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
    // To find a point takes as long as all else of a piece, and most begin where the one before
    // ended.
    bool is_end_of_piece = false; // the place where the open one begins
    const auto point = [&](SegmentPlace place) {
        return PackedPoint(point_at(begin_, end_, place));
    };
    const auto close = [&](SegmentPlace last) {
        const bool is_piece = is_open();
        const bool continues = std::exchange(is_end_of_piece, is_piece);
        if (!is_piece)
            return;
        if (!continues)
            result.points.push_back(point(open.first));
        result.points.push_back(point(last));
        const auto end = static_cast<std::uint32_t>(result.points.size() - 1);
        result.pieces.push_back(
            {end - 1, end, raster_.edges.edges[edge], open.left.triangle, open.right.triangle});
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
            const Hiding hiding = hiding_between(here.value, events_[next].value);
            // Where a shadow ends, other lights may reach what is seen on the two sides.
            const auto [left, right] =
                seen_between(here.value, events_[next].value, hiding, shadows_.is_any_parted());
            if (speaks_here(edge, left, right, hiding)) {
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
