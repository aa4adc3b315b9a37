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

void SeenBeside::find_front(std::uint8_t side, Front& front) {
    std::uint32_t foremost = foremost_;
    for (const std::uint32_t i : on_one_side_)
        if ((candidates_[i].sides & side) != 0 && (foremost == nothing || is_before(i, foremost)))
            foremost = i;
    front.clear();
    for (std::uint32_t i = 0; i < candidates_.size(); ++i)
        if ((candidates_[i].sides & side) != 0 && !candidates_[foremost].hides(candidates_[i]))
            front.push_back({i, {candidates_[i].triangle, {}}});
    if (front.size() < 2)
        return;
    // What is hidden by something hidden is hidden by what hides that as well.
    in_front_.clear();
    for (const InFront& one : front) {
        const Candidate& c = candidates_[one.candidate];
        in_front_.push_back(
            {{c.near[0] - c.margin, c.near[1] - c.margin},
             {c.near[0] + c.margin, c.near[1] + c.margin}});
    }
    const std::vector<std::uint8_t>& is_hidden = hidden_.hidden(in_front_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < front.size(); ++i)
        if (is_hidden[i] == 0)
            front[kept++] = front[i];
    front.resize(kept);
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
    for (auto& [candidate, on_line] : front)
        on_line.chord =
            chord_in(corners_of(scene_, scene_.triangles[on_line.triangle]), begin_, end_);
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
    if (part > first.part && part < last.part) {
        // Something else may be in front where these two meet.
        const Top between = top_at(part, front);
        if (between.candidate != first.candidate && between.candidate != last.candidate) {
            find_penetrating(first, between, front);
            find_penetrating(between, last, front);
            return;
        }
    }
    // Where order goes round, tops may change between two that do not pass through each other:
    // there is nothing to cut.
    if (triangle_order(scene_, slopes_, one.triangle, other.triangle) == FrontOrder::penetrating)
        penetrating_->push_back(std::minmax(one.triangle, other.triangle));
}

std::uint32_t SeenBeside::find_in(Front& front) {
    if (front.size() < 2)
        return front.empty() ? nothing : front[0].candidate;
    put_in_order(front);
    changes_ = false;
    const Top middle = top_at(0.5, front);
    if (changes_)
        find_penetrating(top_at(0, front), top_at(1, front), front);
    return middle.candidate;
}

SeenBeside::Seen SeenBeside::find(
    std::vector<std::pair<std::uint32_t, std::uint32_t>>& penetrating, bool asks_always) {
    const bool is_hidden = foremost_ != nothing
        && std::all_of(on_one_side_.begin(), on_one_side_.end(), [&](std::uint32_t i) {
                               return candidates_[foremost_].hides(candidates_[i]);
                           });
    if (is_hidden && !asks_always)
        return {nothing, nothing, foremost_};
    find_front(left_side, fronts_[0]);
    find_front(right_side, fronts_[1]);
    if (!asks_always && !has_one_sided(fronts_[0]) && !has_one_sided(fronts_[1]))
        return {};
    penetrating_ = &penetrating;
    return {find_in(fronts_[0]), find_in(fronts_[1])};
}

} // namespace vera
