// SPDX-License-Identifier: Apache-2.0
#include "vera/render/effect_ladder.h"

#include <algorithm>

namespace vera {

namespace {

/// Shines in its plain colour from all directions, and does nothing else.
Material plain(const Material& material) {
    Material result;
    result.name = material.name;
    result.sdi = material.drf + material.arf + material.sdi + material.san;
    return result;
}

Material without_highlight(Material material) {
    material.spc = 1;
    return material;
}

void make_flat(Effects& effects) {
    effects.lights.clear();
    std::transform(
        effects.materials.begin(), effects.materials.end(), effects.materials.begin(), plain);
    effects.settings.ambient = {};
}

void make_diffuse(Effects& effects) {
    if (effects.lights.size() > 1)
        effects.lights.resize(1);
    std::transform(
        effects.materials.begin(),
        effects.materials.end(),
        effects.materials.begin(),
        without_highlight);
}

bool any_material(const Effects& effects, bool (*has)(const Material&)) {
    return std::any_of(effects.materials.begin(), effects.materials.end(), has);
}

bool has_highlight(const Material& material) {
    return material.spc < 1;
}

bool sends_rays_on(const Material& material) {
    return !is_black(material.rab) || !is_black(material.tab);
}

} // namespace

Effects effects_at(EffectStep step, const Effects& all) {
    Effects effects = all;
    if (step == EffectStep::rays)
        return effects;
    // Without shadows and deeper rays, RAB and TAB are without effect.
    effects.settings.depth = 1;
    effects.settings.shadows = false;
    if (step == EffectStep::flat || step == EffectStep::antialiased)
        make_flat(effects);
    if (step == EffectStep::flat)
        effects.settings.antialiasing.on = false;
    if (step == EffectStep::diffuse)
        make_diffuse(effects);
    return effects;
}

void give_fallback_material(Scene& scene) {
    // Only the main scene has things without any material: a subscene has its caller's.
    std::vector<Item>& items = scene.geometry.items;
    const auto has_none = [](const Item& item) { return item.material == inherited_material; };
    if (std::none_of(items.begin(), items.end(), has_none))
        return;
    const auto fallback = MaterialId{static_cast<std::uint32_t>(scene.materials.size())};
    scene.materials.push_back(Material::fallback());
    for (Item& item : items)
        if (has_none(item))
            item.material = fallback;
}

std::optional<std::string> why_unchanged(EffectStep step, const Effects& all) {
    const bool has_rays_on = all.settings.depth > 1 && any_material(all, sends_rays_on);
    switch (step) {
    case EffectStep::antialiased:
        if (!all.settings.antialiasing.on)
            return "the settings leave anti-aliasing off";
        break;
    case EffectStep::highlights:
        if (all.lights.empty())
            return "there is no light source";
        if (all.lights.size() == 1 && !any_material(all, has_highlight))
            return "there is one light source, and no material has a highlight";
        break;
    case EffectStep::rays:
        if (!all.settings.shadows && !has_rays_on)
            return "the settings leave shadows off, and nothing mirrors or lets light through";
        break;
    case EffectStep::flat:
    case EffectStep::diffuse:
        break;
    }
    return std::nullopt;
}

} // namespace vera
