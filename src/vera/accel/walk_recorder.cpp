// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/walk_recorder.h"

#include "vera/scene/crossings.h"

#include <utility>

namespace vera::detail {

std::size_t WalkRecorder::enter_scene() {
    // It is entered again where a first search has remained undecided.
    if (walk_.places.empty())
        walk_.places.emplace_back();
    return 0;
}

std::size_t WalkRecorder::enter_call(std::size_t place, const Frame& frame, std::uint32_t element) {
    const Geometry& geometry = *frame.local->geometry;
    const Element at = element_at(geometry, element);
    const SubsceneCall& call = geometry.calls[geometry.items[at.item].index];
    const WalkedPlace& from = walk_.places[place];
    WalkedPlace entered;
    entered.geometry = static_cast<std::size_t>(call.subscene) + 1;
    entered.first_primitive = frame.first_primitive + primitive_number(geometry, at);
    entered.depth = from.depth + 1;
    entered.to_scene = composed(from.to_scene, call.to_parent);
    walk_.places.push_back(entered);
    return walk_.places.size() - 1;
}

std::size_t WalkRecorder::add(WalkStep step) {
    walk_.steps.push_back(std::move(step));
    return walk_.steps.size() - 1;
}

WalkedObject& WalkRecorder::add_object(
    std::size_t step, const Frame& frame, std::uint32_t element, WalkedObject::Outcome outcome) {
    const Geometry& geometry = *frame.local->geometry;
    const Element at = element_at(geometry, element);
    WalkedObject object;
    object.primitive = frame.first_primitive + primitive_number(geometry, at);
    object.is_call = geometry.items[at.item].kind == ItemKind::subscene_call;
    object.outcome = outcome;
    return walk_.steps[step].objects.emplace_back(object);
}

void WalkRecorder::add_test(
    std::size_t step, const PacketQuery& query, const Frame& frame, std::uint32_t element) {
    WalkedObject& object = add_object(step, frame, element);
    for_each_crossing(
        *frame.local->geometry,
        element_at(*frame.local->geometry, element),
        frame.rays.ray(0),
        frame.start_element[0] == element ? query.rays[0].start.piece : no_piece,
        [&](double t, std::uint32_t) {
            if (object.outcome == WalkedObject::Outcome::missed || t < object.t)
                object.t = t;
            object.outcome = WalkedObject::Outcome::met;
        });
}

void WalkRecorder::add_plain_search(
    std::size_t step, PacketQuery& query, Frame& frame, std::uint32_t element) {
    const std::uint64_t before = query.counts.tests;
    search_plainly(query, frame, element, walking_lane & query.active);
    add_object(step, frame, element, WalkedObject::Outcome::searched).tests =
        query.counts.tests - before;
}

} // namespace vera::detail
