// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/kinetic_order.h"

#include "vera/base/check.h"
#include "vera/theory/sloped_ray.h"

#include <algorithm>
#include <compare>
#include <utility>

namespace vera {

namespace {

/// A heap of events may hold so many for each ray before those that hold no more are dropped: each
/// ray has one that holds.
constexpr std::size_t events_per_ray = 4;

/// A ray where the order begins.
struct Placed {
    std::int64_t value = 0;
    std::int32_t slope = 0;
    std::uint32_t ray = 0;

    friend auto operator<=>(const Placed&, const Placed&) = default;
};

} // namespace

KineticOrder::KineticOrder(
    std::span<const PlanePoint> points, std::int32_t first_z, std::int32_t last_z)
    : points_(points)
    , last_z_(last_z)
    , at_(points.size())
    , place_(points.size())
    , before_(points.size())
    , after_(points.size())
    , version_(points.size()) {
    std::vector<Placed> placed(points.size());
    for (std::uint32_t ray = 0; ray < placed.size(); ++ray)
        placed[ray] = {value_at(points[ray], first_z), points[ray].x, ray};
    std::sort(placed.begin(), placed.end());
    std::transform(
        placed.begin(), placed.end(), at_.begin(), [](const Placed& one) { return one.ray; });
    events_.reserve(events_per_ray * (points.size() + 1));
    for (std::uint32_t place = 0; place < at_.size(); ++place) {
        place_[at_[place]] = place;
        before_[place] = place == 0 ? none : place - 1;
        after_[place] = place + 1 == at_.size() ? none : place + 1;
    }
    for (std::uint32_t place = 0; place < at_.size(); ++place)
        schedule(place);
}

bool KineticOrder::comes_later(const Event& a, const Event& b) {
    if (a.z < b.z || b.z < a.z)
        return b.z < a.z;
    return b.left < a.left;
}

std::uint32_t KineticOrder::right_of(std::uint32_t ray) const {
    const std::uint32_t place = after_[place_[ray]];
    return place == none ? none : at_[place];
}

bool KineticOrder::is_current(const Event& event) const {
    return event.version == version_[event.left];
}

void KineticOrder::link(std::uint32_t left_place, std::uint32_t right_place) {
    if (left_place != none)
        after_[left_place] = right_place;
    if (right_place != none)
        before_[right_place] = left_place;
}

void KineticOrder::schedule(std::uint32_t left_place) {
    if (left_place == none)
        return;
    const std::uint32_t left = at_[left_place];
    ++version_[left];
    const std::uint32_t right = right_of(left);
    if (right == none || points_[left].x <= points_[right].x)
        return;
    const CrossingZ z = {
        std::int64_t{points_[right].y} - points_[left].y,
        std::int64_t{points_[left].x} - points_[right].x};
    if (CrossingZ{last_z_, 1} < z)
        return;
    events_.push_back({z, left, version_[left]});
    std::push_heap(events_.begin(), events_.end(), comes_later);
}

/// So that next() need only look at the first, and old ones take no more than O(m) of space.
void KineticOrder::drop_old_events() {
    if (events_.size() > events_per_ray * at_.size()) {
        std::erase_if(events_, [&](const Event& event) { return !is_current(event); });
        std::make_heap(events_.begin(), events_.end(), comes_later);
    }
    while (!events_.empty() && !is_current(events_.front())) {
        std::pop_heap(events_.begin(), events_.end(), comes_later);
        events_.pop_back();
    }
}

std::optional<Crossing> KineticOrder::next() const {
    if (events_.empty())
        return {};
    const Event& event = events_.front();
    return Crossing{event.z, event.left, right_of(event.left)};
}

void KineticOrder::pass() {
    VERA_CHECK(!events_.empty());
    const std::uint32_t left = events_.front().left;
    const std::uint32_t right = right_of(left);
    std::swap(at_[place_[left]], at_[place_[right]]);
    std::swap(place_[left], place_[right]);
    // Now the right one stands first. All three pairs of neighbours are new.
    schedule(before_[place_[right]]);
    schedule(place_[right]);
    schedule(place_[left]);
    ++passed_;
    drop_old_events();
}

void KineticOrder::remove(std::uint32_t ray) {
    const std::uint32_t place = place_[ray];
    VERA_CHECK(at_[place] == ray);
    const std::uint32_t before = before_[place];
    at_[place] = none;
    ++version_[ray];
    link(before, after_[place]);
    schedule(before);
    drop_old_events();
}

double KineticOrder::bytes_forecast(std::size_t rays) {
    // What sorts them at first is given back before there are that many events.
    return static_cast<double>(
        rays * (5 * sizeof(std::uint32_t) + (events_per_ray + 3) * sizeof(Event)));
}

} // namespace vera
