// SPDX-License-Identifier: Apache-2.0
#include "transparency_warning.h"

#include "vera/formats/word_reader.h"
#include "vera/shade/lighting.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace vera {

namespace {

/// What of a scene is called, and what in it shows materials that let light through.
class SeenThrough {
public:
    explicit SeenThrough(const Scene& scene)
        : scene_(scene)
        , shows_inherited_(scene.subscenes.size())
        , is_called_(scene.subscenes.size()) {
        const std::vector<std::size_t> order = callees_first(scene);
        for (const std::size_t number : order)
            shows_inherited_[number] = shows_inherited(scene.subscenes[number]);
        look_at(scene.geometry);
        for (std::size_t i = order.size(); i-- > 0;)
            if (is_called_[order[i]])
                look_at(scene.subscenes[order[i]]);
    }

    const Item* first = nullptr; ///< that has one, or null
    std::set<MaterialId> materials;

private:
    static std::size_t callee(const Geometry& geometry, const Item& item) {
        return static_cast<std::size_t>(geometry.calls[item.index].subscene);
    }

    /// Whether the item's own material is that of something: not of a call whose things all have
    /// another one.
    bool shows_own(const Geometry& geometry, const Item& item) const {
        return item.kind != ItemKind::subscene_call || shows_inherited_[callee(geometry, item)];
    }

    bool shows_inherited(const Geometry& geometry) const {
        return std::ranges::any_of(geometry.items, [&](const Item& item) {
            return item.material == inherited_material && shows_own(geometry, item);
        });
    }

    void look_at(const Geometry& geometry) {
        for (const Item& item : geometry.items) {
            if (item.kind == ItemKind::subscene_call)
                is_called_[callee(geometry, item)] = true;
            if (item.material == inherited_material || !shows_own(geometry, item)
                || is_black(material_of(scene_, item.material).tab))
                continue;
            first = first == nullptr ? &item : first;
            materials.insert(item.material);
        }
    }

    const Scene& scene_;
    std::vector<bool> shows_inherited_; ///< of each subscene
    std::vector<bool> is_called_;       ///< likewise; not by one that nobody calls
};

/// What makes a material opaque that a file of that format has.
const char* words_for_opaque(SceneFormat format) {
    switch (format) {
    case SceneFormat::obj:
        return "'d 1' in the MTL file";
    case SceneFormat::nff:
        return "a T of 0 behind 'f'";
    default:
        return "TAB 0 0 0";
    }
}

} // namespace

std::optional<Diagnostic> transparency_warning(const Scene& scene, SceneFormat format) {
    const SeenThrough seen(scene);
    const Item* const first = seen.first;
    const std::set<MaterialId>& materials = seen.materials;
    if (first == nullptr)
        return std::nullopt;
    Diagnostic warning;
    warning.severity = Severity::warning;
    if (first->file < scene.files.size())
        warning.place = {scene.files[first->file], first->line, 1};
    const std::string& name = material_of(scene, first->material).name;
    warning.problem = fmt::format(
        "{} lets light through{}, and a drawing shows nothing through it and no shadow of it",
        name.empty() ? "the material" : "material " + shown(name),
        materials.size() > 1 ? fmt::format(" (as {} more)", materials.size() - 1) : "");
    warning.remedy = fmt::format(
        "'vera render' follows the light, and {} makes the material opaque",
        words_for_opaque(format));
    return warning;
}

} // namespace vera
