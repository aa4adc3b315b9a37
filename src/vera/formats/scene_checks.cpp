// SPDX-License-Identifier: Apache-2.0
// The checks of SceneBuilder that need the whole scene or subscene.
#include "vera/formats/faces.h"
#include "vera/formats/inner_point_check.h"
#include "vera/formats/item_place.h"
#include "vera/formats/scene_builder.h"
#include "vera/formats/word_reader.h"
#include "vera/scene/inspection.h"

#include <algorithm>

#include <fmt/format.h>

namespace vera {

void SceneBuilder::check_inner_point(const Section& section) {
    if (!section.inner_point)
        return;
    const Geometry& geometry = *section.geometry;
    const auto wrong = faces_with_inner_point_on_wrong_side(
        geometry, section.first_with_inner_point, geometry.items.size());
    for (const std::size_t i : wrong)
        complaints_.warn("inner points on the wrong side of a face", [&] {
            const Item& item = geometry.items[i];
            return diagnostic_at(
                Severity::warning,
                item_place(item, *texts_[item.file]),
                "the inner point is on the wrong side of this face: all other faces with the "
                "same inner point are on the other side",
                "move IP to the inside of the solid");
        });
}

namespace {

/// Says how a subscene comes to call itself: stack holds the subscenes from the first call to the
/// last, which calls the first again.
std::string cycle_problem(const std::deque<Geometry>& subscenes, std::vector<std::size_t> cycle) {
    std::string problem =
        fmt::format("subscene {} calls itself", shown(subscenes[cycle.front()].name));
    constexpr std::size_t most_named = 5;
    for (std::size_t i = 1; i < cycle.size() && i <= most_named; ++i)
        problem += fmt::format(
            "{}{}",
            i == 1                      ? " through "
                : i + 1 == cycle.size() ? " and "
                                        : ", ",
            shown(subscenes[cycle[i]].name));
    if (cycle.size() > most_named + 1)
        problem += fmt::format(" and {} more", cycle.size() - most_named - 1);
    return problem;
}

} // namespace

std::vector<std::size_t> SceneBuilder::check_calls() {
    enum class State : std::uint8_t { unseen, open, done };

    struct Visit {
        std::size_t subscene;
        std::size_t next_call;
    };

    std::vector<State> states(subscenes_.size(), State::unseen);
    std::vector<std::size_t> callees_first;
    // A stack of our own: subscenes may nest to any depth.
    std::vector<Visit> stack;
    for (std::size_t root = 0; root < subscenes_.size(); ++root) {
        if (states[root] == State::unseen)
            stack.push_back({root, 0});
        while (!stack.empty()) {
            Visit& visit = stack.back();
            const std::size_t caller = visit.subscene;
            states[caller] = State::open;
            const Geometry& geometry = subscenes_[caller];
            if (visit.next_call == geometry.calls.size()) {
                states[caller] = State::done;
                callees_first.push_back(caller);
                stack.pop_back();
                continue;
            }
            const std::size_t call = visit.next_call++;
            const auto callee = static_cast<std::size_t>(geometry.calls[call].subscene);
            if (states[callee] == State::unseen) {
                stack.push_back({callee, 0});
            } else if (states[callee] == State::open && !complaints_.full()) {
                const auto item = std::find_if(
                    geometry.items.begin(), geometry.items.end(), [&](const Item& other) {
                        return other.kind == ItemKind::subscene_call && other.index == call;
                    });
                std::vector<std::size_t> cycle;
                for (std::size_t i = stack.size(); i-- > 0;) {
                    cycle.push_back(stack[i].subscene);
                    if (stack[i].subscene == callee)
                        break;
                }
                std::reverse(cycle.begin(), cycle.end());
                complaints_.error(
                    item_place(*item, *texts_[item->file]),
                    cycle_problem(subscenes_, std::move(cycle)));
            }
        }
    }
    return callees_first;
}

void SceneBuilder::check_materials(const std::vector<std::size_t>& callees_first) {
    // Whether something in a subscene takes the material of the call.
    std::vector<bool> inherits(subscenes_.size(), false);
    const auto without_material = [&](const Geometry& geometry, const Item& item) {
        if (item.material != inherited_material)
            return false;
        return item.kind != ItemKind::subscene_call
            || inherits[static_cast<std::size_t>(geometry.calls[item.index].subscene)];
    };
    for (const std::size_t i : callees_first) {
        const Geometry& geometry = subscenes_[i];
        inherits[i] =
            std::any_of(geometry.items.begin(), geometry.items.end(), [&](const Item& item) {
                return without_material(geometry, item);
            });
    }
    const Geometry& geometry = scene_.geometry;
    const auto without = [&](const Item& item) { return without_material(geometry, item); };
    const auto first = std::find_if(geometry.items.begin(), geometry.items.end(), without);
    if (first == geometry.items.end())
        return;
    const auto more = std::count_if(first + 1, geometry.items.end(), without);
    complaints_.warn(
        "things without material",
        item_place(*first, *texts_[first->file]),
        more == 0 ? std::string("this has no material and gets DRF 0.7 0.7 0.7")
                  : fmt::format(
                      "this and {} more statements have no material and get DRF 0.7 0.7 0.7", more),
        "write CM and the name of a material before it");
}

/// Of materials that CM names, but with no surface behind it.
void SceneBuilder::warn_of_idle_materials() {
    const std::vector<bool> used = used_materials(scene_);
    for (std::size_t i = 0; i < used.size(); ++i) {
        const NameTable::Entry& entry = material_names_.entries()[i];
        if (!used[i] && entry.definition && entry.use) {
            const SourcePlace use = source_place(*entry.use);
            complaints_.warn(
                "unused materials",
                *entry.definition,
                fmt::format("material {} is never used", shown(entry.name)),
                fmt::format("no surface follows the CM at {}:{}", use.file, use.line));
        }
    }
}

Scene SceneBuilder::finish() {
    end_subscene();
    check_inner_point(main_);
    define_standard_materials();
    material_names_.complain_of_undefined(complaints_);
    subscene_names_.complain_of_undefined(complaints_);
    // Names that are used and never defined have numbers as well.
    subscenes_.resize(subscene_names_.entries().size());
    scene_.materials.resize(material_names_.entries().size());
    const std::vector<std::size_t> callees_first = check_calls();
    if (complaints_.error_count() > 0)
        return {};

    material_names_.warn_of_unused(complaints_);
    subscene_names_.warn_of_unused(complaints_);
    check_materials(callees_first);
    const bool any_geometry = !scene_.geometry.items.empty();
    if (!any_geometry && !texts_.empty())
        complaints_.warn("scenes without geometry", [&] {
            return Diagnostic{
                .severity = Severity::warning,
                .place = {texts_[0]->name(), 0, 0},
                .problem = "the scene has no geometry: there is nothing to be seen"};
        });
    scene_.subscenes.assign(
        std::make_move_iterator(subscenes_.begin()), std::make_move_iterator(subscenes_.end()));
    warn_of_idle_materials();
    return std::move(scene_);
}

} // namespace vera
