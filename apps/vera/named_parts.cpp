// SPDX-License-Identifier: Apache-2.0
#include "named_parts.h"

#include "vera/formats/source_report.h"
#include "vera/formats/word_reader.h"
#include "vera/scene/named_parts.h"

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

/// A part with its primitives, which are numbered from 1 in the scene or subscene.
struct ToldPart {
    const Geometry* geometry = nullptr;
    std::uint32_t number = 0;

    const NamedPart& part() const { return geometry->named_parts[number]; }

    std::uint64_t first() const { return primitive_number(*geometry, part().first) + 1; }

    std::uint64_t count() const {
        const bool ends_all = part().end.item == geometry->items.size();
        const std::uint64_t end =
            ends_all ? geometry->primitive_count : primitive_number(*geometry, part().end);
        return end - (first() - 1);
    }

    std::size_t depth() const { return parts_around(*geometry, number).size() - 1; }
};

/// Materials of the part, each once, in the order in which it has them.
std::vector<std::string> material_names(const Scene& scene, const ToldPart& told) {
    std::vector<std::string> names;
    std::set<MaterialId> told_before;
    const NamedPart& part = told.part();
    for (std::uint32_t i = part.first.item; Element{i, 0} < part.end; ++i) {
        const MaterialId material = told.geometry->items[i].material;
        if (material != inherited_material && told_before.insert(material).second)
            names.push_back(scene.materials[static_cast<std::size_t>(material)].name);
    }
    return names;
}

/// Calls visit(part) for each part of the scene, in its order.
template <typename Visit>
void for_each_part(const Scene& scene, const Visit& visit) {
    const auto of = [&](const Geometry& geometry) {
        for (std::uint32_t i = 0; i < geometry.named_parts.size(); ++i)
            visit(ToldPart{&geometry, i});
    };
    of(scene.geometry);
    for (const Geometry& subscene : scene.subscenes)
        of(subscene);
}

} // namespace

nlohmann::ordered_json named_parts_json(const Scene& scene) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for_each_part(scene, [&](const ToldPart& told) {
        nlohmann::ordered_json json = {
            {"name", told.part().name},
            {"first_primitive", told.first()},
            {"primitives", told.count()}};
        if (auto names = material_names(scene, told); !names.empty())
            json["materials"] = std::move(names);
        if (told.geometry != &scene.geometry && told.depth() == 0)
            json["subscene"] = told.geometry->name;
        // Those that it is within were the last ones of their depths.
        nlohmann::ordered_json* list = &all;
        for (std::size_t depth = told.depth(); depth > 0; --depth)
            list = &list->back()["parts"];
        list->push_back(std::move(json));
    });
    return all;
}

void print_named_parts(const Scene& scene) {
    constexpr std::size_t most = 100;
    std::size_t count = 0;
    for_each_part(scene, [&](const ToldPart&) { ++count; });
    if (count == 0)
        return;
    fmt::print("{:<18}  {}\n", "named parts", count);
    std::size_t told_parts = 0;
    for_each_part(scene, [&](const ToldPart& told) {
        if (++told_parts > most)
            return;
        std::string line(2 + 2 * told.depth(), ' ');
        line += fmt::format(
            "{}, {} from {} on",
            shown(told.part().name),
            counted(told.count(), "primitive", "primitives"),
            told.first());
        for (const std::string& material : material_names(scene, told))
            line += ", " + shown(material);
        if (told.geometry != &scene.geometry && told.depth() == 0)
            line += ", of subscene " + shown(told.geometry->name);
        fmt::print("{}\n", line);
    });
    if (count > most)
        fmt::print("  and {} more, which --json tells\n", count - most);
}

} // namespace vera
