// SPDX-License-Identifier: Apache-2.0
#include "ray_visits.h"

#include "vera/base/check.h"

#include <fmt/format.h>

namespace vera {

namespace {

using Outcome = WalkedObject::Outcome;

std::size_t entries(const RayWalk& walk) {
    std::size_t count = walk.steps.size();
    for (const WalkStep& step : walk.steps)
        count += step.objects.size();
    return count;
}

/// The main scene, or what a place was called as.
std::string name_of(const WalkedPlace& place, SceneObjects& objects) {
    if (place.depth == 0)
        return "the scene";
    const SceneObject first = objects.object({place.first_primitive, 0});
    const SceneObject::Call& call = first.calls[place.depth - 1];
    return fmt::format("{}, called at {}", call.subscene, to_text(call.place));
}

std::string outcome_of(const WalkedObject& object, double direction_length) {
    switch (object.outcome) {
    case Outcome::missed:
        return object.is_call ? "not entered" : "missed";
    case Outcome::met:
        return fmt::format("met at distance {:.6g}", object.t * direction_length);
    case Outcome::again:
        return "was tested before";
    case Outcome::entered:
        return "entered";
    case Outcome::searched:
        return fmt::format("its {} objects tested, as it is nested so deeply", object.tests);
    }
    return {};
}

/// What the step is in, as a heading.
std::string heading_of(const RayWalk& walk, const WalkStep& step, SceneObjects& objects) {
    const std::string place = name_of(walk.places[step.place], objects);
    if (step.kind != WalkStep::Kind::cell)
        return "boxes of " + place;
    return fmt::format("grid {} of {}, level {}", step.number, place, step.level);
}

std::string listed(const WalkStep& step) {
    return fmt::format("{} {}", step.listed, step.listed == 1 ? "object" : "objects");
}

std::string text_of(const WalkStep& step) {
    switch (step.kind) {
    case WalkStep::Kind::node:
        return fmt::format("node {}, level {}", step.number, step.level);
    case WalkStep::Kind::leaf:
        return fmt::format("leaf of node {}: {}", step.number, listed(step));
    case WalkStep::Kind::cell:
        break;
    }
    return fmt::format(
        "cell {} {} {}: {}",
        step.cell[0],
        step.cell[1],
        step.cell[2],
        step.is_grid          ? fmt::format("grid {}", step.own_grid)
            : step.listed > 0 ? listed(step)
                              : "empty");
}

bool in_the_same(const WalkStep& a, const WalkStep& b) {
    return a.place == b.place && (a.kind != WalkStep::Kind::cell || a.number == b.number);
}

} // namespace

std::optional<std::vector<RayVisits>>
ray_visits(const RayTree& tree, const RayIndex& index, const CancelFlag& cancel) {
    const auto* const walked = dynamic_cast<const WalkedIndex*>(&index);
    VERA_CHECK(walked != nullptr);
    std::vector<RayVisits> all;
    std::size_t count = 0;
    for (const RayNode& node : tree.nodes) {
        cancel.throw_if_raised();
        RayVisits& visits = all.emplace_back();
        visits.walk = walked->nearest_walk(node.ray);
        count += entries(visits.walk);
        for (const LightAtPlace& light : node.lights) {
            std::optional<RayWalk>& walk = visits.shadow_walks.emplace_back();
            if (!light.shadow_ray)
                continue;
            walk = walked->transmittance_walk(*light.shadow_ray);
            count += entries(*walk);
        }
        if (count > RayVisits::most)
            return std::nullopt;
    }
    return all;
}

SceneObject::Call call_of(const WalkedPlace& place, const WalkedObject& object, SceneObjects& of) {
    return of.object({object.primitive, 0}).calls[place.depth];
}

const char* name_of(Outcome outcome) {
    switch (outcome) {
    case Outcome::missed:
        return "missed";
    case Outcome::met:
        return "met";
    case Outcome::again:
        return "tested_before";
    case Outcome::entered:
        return "entered";
    case Outcome::searched:
        return "searched";
    }
    return "";
}

std::vector<std::string>
visit_lines(const RayWalk& walk, double direction_length, SceneObjects& objects) {
    std::vector<std::string> lines;
    const WalkStep* before = nullptr;
    for (const WalkStep& step : walk.steps) {
        if (before == nullptr || !in_the_same(*before, step))
            lines.push_back(heading_of(walk, step, objects));
        before = &step;
        lines.push_back("  " + text_of(step));
        for (const WalkedObject& object : step.objects) {
            std::string name;
            if (object.is_call) {
                const SceneObject::Call call = call_of(walk.places[step.place], object, objects);
                name = fmt::format("{}, called at {}", call.subscene, to_text(call.place));
            } else {
                name = short_name(objects.object({object.primitive, 0}));
            }
            lines.push_back(fmt::format("    {}: {}", name, outcome_of(object, direction_length)));
        }
    }
    if (lines.empty())
        lines.emplace_back("nothing: it passes by all that there is");
    return lines;
}

} // namespace vera
