// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/seen_beside.h"

#include <algorithm>
#include <cmath>

namespace vera {

void SeenBeside::follow(ScreenPoint begin, ScreenPoint end) {
    begin_ = begin;
    end_ = end;
    // Parts are made longer by more than their ends are off: of two triangles that change their
    // order where one part ends and another begins, both parts then know.
    const ScreenStep way = step(begin, end);
    const auto x = static_cast<double>(way.x);
    const auto y = static_cast<double>(way.y);
    const double part = 0x1p-20 / (std::abs(x) + std::abs(y));
    bit_ = {part * x, part * y};
}

/// Of what covers the side, as is_before() tells.
std::uint32_t SeenBeside::foremost_on(std::uint8_t side) const {
    std::uint32_t foremost = foremost_;
    for (const std::uint32_t i : on_one_side_)
        if ((candidates_[i].sides & side) != 0 && (foremost == nothing || is_before(i, foremost)))
            foremost = i;
    return foremost;
}

/// Of what covers the side, that which surely hides all else, or nothing where none covers it;
/// nullopt: there are several.
std::optional<std::uint32_t> SeenBeside::only_one_on(std::uint8_t side) const {
    const std::uint32_t foremost = foremost_on(side);
    for (std::uint32_t i = 0; i < candidates_.size(); ++i)
        if (i != foremost && (candidates_[i].sides & side) != 0
            && !candidates_[foremost].hides(candidates_[i]))
            return std::nullopt;
    return foremost;
}

/// What nothing surely hides; what is asked among all, as find_front_among_all().
void SeenBeside::find_front(std::uint8_t side, Front& front) {
    if (hiding_ == Hiding::by_nothing)
        return find_front_among_all(side, front);
    front.clear();
    const std::uint32_t foremost = foremost_on(side);
    for (std::uint32_t i = 0; i < candidates_.size(); ++i)
        if ((candidates_[i].sides & side) != 0 && !candidates_[foremost].hides(candidates_[i]))
            front.push_back({i, {candidates_[i].triangle, {}}});
    if (front.size() < 2)
        return;
    // What is hidden by something hidden is hidden by what hides that as well.
    in_front_.clear();
    for (const InFront& one : front)
        in_front_.push_back(candidates_[one.candidate].sure());
    const std::vector<std::uint8_t>& is_hidden = hidden_.hidden(in_front_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < front.size(); ++i)
        if (is_hidden[i] == 0)
            front[kept++] = front[i];
    front.resize(kept);
}

/// A few, each of which surely hides all that are not among them: none of these is in front of one
/// of them, not even by way of some between.
void SeenBeside::find_front_among_all(std::uint8_t side, Front& front) {
    front.clear();
    behind_.clear();
    const std::uint32_t foremost = foremost_on(side);
    if (foremost == nothing)
        return;
    SureNearness all_of_front = candidates_[foremost].sure();
    const auto joins = [&](std::uint32_t i) {
        const SureNearness one = candidates_[i].sure();
        if (all_of_front.hides(one))
            return false;
        for (std::size_t place = 0; place < 2; ++place)
            all_of_front.least[place] = std::min(all_of_front.least[place], one.least[place]);
        front.push_back({i, {candidates_[i].triangle, {}}});
        return true;
    };
    for (std::uint32_t i = 0; i < candidates_.size(); ++i)
        if ((candidates_[i].sides & side) != 0 && !joins(i))
            behind_.push_back(i);
    // What joined late may not hide what was left out before.
    for (std::size_t before = 0; before != front.size();) {
        before = front.size();
        std::size_t kept = 0;
        for (const std::uint32_t i : behind_)
            if (!joins(i))
                behind_[kept++] = i;
        behind_.resize(kept);
    }
}

bool SeenBeside::has_one_sided(const Front& front) const {
    return std::any_of(front.begin(), front.end(), [&](const InFront& one) {
        return candidates_[one.candidate].sides != (left_side | right_side);
    });
}

/// In an order that is no matter of how they were found: of what is coincident within rounding, a
/// may be before b, b before c and c before a.
void SeenBeside::put_in_order(Front& front) const {
    const auto key = [&](const InFront& one) {
        return std::pair(scene_.triangles[one.on_line.triangle].source, one.on_line.triangle);
    };
    std::sort(front.begin(), front.end(), [&](const InFront& a, const InFront& b) {
        return key(a) < key(b);
    });
}

void SeenBeside::find_chords(Front& front) const {
    for (auto& [candidate, on_line] : front)
        on_line.chord =
            chord_in(corners_of(scene_, scene_.triangles[on_line.triangle]), begin_, end_);
}

/// Whether a, which is before b in the front, is in front of b there, by all places at which both
/// are.
bool SeenBeside::is_in_front(const InFront& a, const InFront& b, double part) {
    const Candidate& one = candidates_[a.candidate];
    const Candidate& other = candidates_[b.candidate];
    if (one.hides(other) || other.hides(one))
        return one.hides(other);
    ++comparisons_;
    const FrontOrder order = triangle_order(scene_, slopes_, one.triangle, other.triangle);
    if (order != FrontOrder::penetrating)
        return order == FrontOrder::first;
    changes_ = changes_ || (one.near[0] - other.near[0]) * (one.near[1] - other.near[1]) <= 0;
    return one.near_at(part) > other.near_at(part);
}

/// Of the front, by their numbers there, the fewest that none of the others is in front of: one,
/// but where the order goes round.
std::vector<std::uint32_t> SeenBeside::foremost_among_all(double part, const Front& front) {
    const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
        return a < b ? is_in_front(front[a], front[b], part)
                     : !is_in_front(front[b], front[a], part);
    };
    std::uint32_t first = 0; // in front of all others, perhaps by way of some between
    for (std::uint32_t i = 1; i < front.size(); ++i)
        if (is_before(i, first))
            first = i;
    std::vector<std::uint32_t> foremost = {first};
    for (std::size_t next = 0; next < foremost.size(); ++next)
        for (std::uint32_t i = 0; i < front.size(); ++i)
            if (std::find(foremost.begin(), foremost.end(), i) == foremost.end()
                && is_before(i, foremost[next]))
                foremost.push_back(i);
    std::sort(foremost.begin(), foremost.end());
    return foremost;
}

/// The first of the text of the foremost. Those of them that pass through each other on the way are
/// told where it is another one at its end than at its beginning.
std::uint32_t SeenBeside::find_among_all(const Front& front) {
    changes_ = false;
    const std::vector<std::uint32_t> middle = foremost_among_all(0.5, front);
    if (changes_) {
        std::vector<std::uint32_t> either = foremost_among_all(0, front);
        const std::vector<std::uint32_t> last = foremost_among_all(1, front);
        if (either[0] != last[0]) {
            either.insert(either.end(), last.begin(), last.end());
            for (const std::uint32_t a : either)
                for (const std::uint32_t b : either) {
                    changes_ = false;
                    if (a < b)
                        is_in_front(front[a], front[b], 0);
                    if (changes_)
                        penetrating_->push_back(
                            std::minmax(front[a].on_line.triangle, front[b].on_line.triangle));
                }
        }
    }
    return front[middle[0]].candidate;
}

SeenBeside::Top SeenBeside::top_at(double part, const Front& front) {
    const InFront* top = nullptr;
    for (const InFront& next : front) {
        const Candidate& challenger = candidates_[next.candidate];
        if (top == nullptr) {
            top = &next;
            continue;
        }
        const Candidate& champion = candidates_[top->candidate];
        ++comparisons_;
        const FrontOrder order = triangle_order(scene_, slopes_, next.on_line, top->on_line);
        bool wins = order == FrontOrder::first;
        if (order == FrontOrder::penetrating) {
            // Perhaps elsewhere. That they do here is true of a way if and only if it is of a part
            // of it.
            const double at_first = challenger.near[0] - champion.near[0];
            const double at_last = challenger.near[1] - champion.near[1];
            changes_ = changes_ || at_first * at_last <= 0;
            wins = challenger.near_at(part) > champion.near_at(part);
        }
        if (wins)
            top = &next;
    }
    return {part, top == nullptr ? nothing : top->candidate};
}

/// Finds who passes through whom between two places of the way, from what is seen there.
void SeenBeside::find_penetrating(Top first, Top last, const Front& front) {
    if (first.candidate == last.candidate)
        return;
    const Candidate& one = candidates_[first.candidate];
    const Candidate& other = candidates_[last.candidate];
    const double at_first = one.near_at(first.part) - other.near_at(first.part);
    const double at_last = one.near_at(last.part) - other.near_at(last.part);
    const double part = first.part + (last.part - first.part) * (at_first / (at_first - at_last));
    const auto do_penetrate = [&](const Candidate& a, const Candidate& b) {
        return triangle_order(scene_, slopes_, a.triangle, b.triangle) == FrontOrder::penetrating;
    };
    if (part > first.part && part < last.part) {
        // Something else may be in front where these two meet, and then passes through both. What
        // is coincident with one of them, or meets both there, is so by rounding alone, which is
        // another one of each part of an edge.
        constexpr double rounding = 0.5; // steps of nearness
        const Top between = top_at(part, front);
        const Candidate& third = candidates_[between.candidate];
        const double nearest = std::max(one.near_at(part), other.near_at(part));
        if (between.candidate != first.candidate && between.candidate != last.candidate
            && third.near_at(part) > nearest + rounding && do_penetrate(one, third)
            && do_penetrate(third, other)) {
            find_penetrating(first, between, front);
            find_penetrating(between, last, front);
            return;
        }
    }
    // Where order goes round, tops may change between two that do not pass through each other:
    // there is nothing to cut.
    if (do_penetrate(one, other))
        penetrating_->push_back(std::minmax(one.triangle, other.triangle));
}

std::uint32_t SeenBeside::find_in(Front& front) {
    if (front.size() < 2)
        return front.empty() ? nothing : front[0].candidate;
    put_in_order(front);
    if (hiding_ == Hiding::by_nothing)
        return find_among_all(front);
    find_chords(front);
    changes_ = false;
    const Top middle = top_at(0.5, front);
    if (changes_)
        find_penetrating(top_at(0, front), top_at(1, front), front);
    return middle.candidate;
}

SeenBeside::Seen SeenBeside::find(
    std::vector<std::pair<std::uint32_t, std::uint32_t>>& penetrating, bool asks_always) {
    const bool is_hidden = hiding_ == Hiding::by_what_covers && foremost_ != nothing
        && std::all_of(on_one_side_.begin(), on_one_side_.end(), [&](std::uint32_t i) {
                               return candidates_[foremost_].hides(candidates_[i]);
                           });
    if (is_hidden && !asks_always)
        return {nothing, nothing, foremost_};
    if (hiding_ == Hiding::by_what_covers) {
        // Of most parts. That which is the same on both sides covers both of them.
        const std::optional<std::uint32_t> left = only_one_on(left_side);
        const std::optional<std::uint32_t> right = left ? only_one_on(right_side) : std::nullopt;
        if (right)
            return left == right && !asks_always ? Seen{} : Seen{*left, *right};
    }
    find_front(left_side, fronts_[0]);
    find_front(right_side, fronts_[1]);
    if (!asks_always && !has_one_sided(fronts_[0]) && !has_one_sided(fronts_[1]))
        return {};
    penetrating_ = &penetrating;
    return {find_in(fronts_[0]), find_in(fronts_[1])};
}

} // namespace vera
