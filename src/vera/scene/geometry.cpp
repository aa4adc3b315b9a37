// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/geometry.h"

#include "vera/base/check.h"
#include "vera/base/diagnostic.h"
#include "vera/scene/bounds.h"
#include "vera/scene/item_names.h"
#include "vera/scene/scene.h"

#include <algorithm>
#include <string>

namespace vera {

Element element_at(const Geometry& geometry, std::uint64_t i) {
    const auto& compounds = geometry.compounds;
    const auto after = std::upper_bound(
        compounds.begin(), compounds.end(), i, [](std::uint64_t element, const Compound& compound) {
            return element < compound.first_element;
        });
    if (after == compounds.begin())
        return {static_cast<std::uint32_t>(i), 0};

    const Compound& compound = *(after - 1);
    const Item& item = geometry.items[compound.item];
    const std::uint64_t within = i - compound.first_element;
    const std::uint64_t size = item.kind == ItemKind::mesh
        ? geometry.meshes[item.index].triangle_count()
        : std::uint64_t{1};
    if (within < size)
        return {compound.item, static_cast<std::uint32_t>(within)};
    return {static_cast<std::uint32_t>(compound.item + 1 + (within - size)), 0};
}

std::uint64_t primitive_number(const Geometry& geometry, Element element) {
    const auto& compounds = geometry.compounds;
    const auto after = std::upper_bound(
        compounds.begin(),
        compounds.end(),
        element.item,
        [](std::uint32_t item, const Compound& compound) { return item < compound.item; });
    if (after == compounds.begin())
        return element.item;

    const Compound& compound = *(after - 1);
    if (compound.item == element.item)
        return compound.first_primitive + element.triangle;
    // The items between the compound and this one hold one primitive each.
    const std::uint64_t next =
        after == compounds.end() ? geometry.primitive_count : after->first_primitive;
    const std::uint64_t next_item = after == compounds.end() ? geometry.items.size() : after->item;
    return next - (next_item - element.item);
}

namespace {

constexpr std::uint64_t most_primitives = std::uint64_t{1} << 62U;
constexpr std::uint64_t most_elements = (std::uint64_t{1} << 32U) - 2;

[[noreturn]] void
refuse(const Scene& scene, const Item& item, const std::string& problem, const char* remedy) {
    Diagnostic diagnostic;
    if (item.file < scene.files.size())
        diagnostic.place = {scene.files[item.file], item.line, 1};
    diagnostic.problem = problem;
    diagnostic.remedy = remedy;
    throw InputError({diagnostic});
}

void number_geometry(const Scene& scene, Geometry& geometry) {
    geometry.compounds.clear();
    std::uint64_t elements = 0;
    std::uint64_t primitives = 0;
    for (std::size_t i = 0; i < geometry.items.size(); ++i) {
        const Item& item = geometry.items[i];
        std::uint64_t item_elements = 1;
        std::uint64_t item_primitives = 1;
        if (item.kind == ItemKind::mesh || item.kind == ItemKind::subscene_call) {
            geometry.compounds.push_back({static_cast<std::uint32_t>(i), elements, primitives});
            if (item.kind == ItemKind::mesh) {
                item_elements = geometry.meshes[item.index].triangle_count();
                item_primitives = item_elements;
            } else {
                const SubsceneCall& call = geometry.calls[item.index];
                item_primitives =
                    scene.subscenes[static_cast<std::size_t>(call.subscene)].primitive_count;
            }
        }
        elements += item_elements;
        primitives += item_primitives;
        if (elements > most_elements)
            refuse(
                scene,
                item,
                "more than 4294967294 primitives in one scene or subscene",
                "move parts of it into subscenes and call them");
        if (primitives > most_primitives)
            refuse(
                scene,
                item,
                "more than 2^62 primitives, with subscenes counted at each call",
                "call the subscenes less often, or with fewer levels of nesting");
    }
    geometry.element_count = elements;
    geometry.primitive_count = primitives;
}

} // namespace

const char* name_of(ItemKind kind) {
    switch (kind) {
    case ItemKind::sphere:
        return "sphere";
    case ItemKind::triangle:
        return "triangle";
    case ItemKind::polygon:
        return "polygon";
    case ItemKind::patch:
        return "patch";
    case ItemKind::rotational_shape:
        return "rotational shape";
    case ItemKind::mesh:
        return "mesh";
    case ItemKind::subscene_call:
        break;
    }
    return "subscene";
}

std::vector<std::size_t> callees_first(const Scene& scene) {
    enum class State : std::uint8_t { unseen, open, done };
    std::vector<State> states(scene.subscenes.size(), State::unseen);
    std::vector<std::size_t> order;
    order.reserve(scene.subscenes.size());

    struct Visit {
        std::size_t subscene;
        std::size_t next_call;
    };

    // A stack of our own: subscenes may nest to any depth.
    std::vector<Visit> stack;
    for (std::size_t root = 0; root < scene.subscenes.size(); ++root) {
        if (states[root] != State::unseen)
            continue;
        stack.push_back({root, 0});
        states[root] = State::open;
        while (!stack.empty()) {
            Visit& visit = stack.back();
            const auto& calls = scene.subscenes[visit.subscene].calls;
            if (visit.next_call == calls.size()) {
                states[visit.subscene] = State::done;
                order.push_back(visit.subscene);
                stack.pop_back();
                continue;
            }
            const auto callee = static_cast<std::size_t>(calls[visit.next_call++].subscene);
            VERA_CHECK(states[callee] != State::open);
            if (states[callee] == State::unseen) {
                states[callee] = State::open;
                stack.push_back({callee, 0});
            }
        }
    }
    return order;
}

void number_primitives(Scene& scene) {
    for (const std::size_t i : callees_first(scene))
        number_geometry(scene, scene.subscenes[i]);
    number_geometry(scene, scene.geometry);
}

void check_reach(const Scene& scene) {
    const std::vector<Box3> subscenes = subscene_bounds(scene);
    const auto check = [&](const Geometry& geometry) {
        for (std::size_t i = 0; i < geometry.items.size(); ++i) {
            const Box3 box = bounds(geometry, i, subscenes);
            const double reach = max_component(max(abs(box.lower), abs(box.upper)));
            const bool holds_nothing = box.lower.x > box.upper.x;
            // Also refuses what is not a number.
            if (!holds_nothing && !(reach <= largest_reach))
                refuse(
                    scene,
                    geometry.items[i],
                    std::string("this ") + name_of(geometry.items[i].kind)
                        + " reaches farther than 1e70 from the origin",
                    "choose a larger unit of length, or bring it nearer");
        }
    };
    // What makes a call reach far is told before the call.
    for (const std::size_t i : callees_first(scene))
        check(scene.subscenes[i]);
    check(scene.geometry);
}

} // namespace vera
