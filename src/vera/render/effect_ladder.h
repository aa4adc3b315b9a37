// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vera {

/// The steps from flat colours to a ray traced picture (VERA, figures 1a to 1e). Each has what the
/// step before it has, and one effect more.
enum class EffectStep : std::uint8_t {
    flat,        ///< each surface in its plain colour, one ray a pixel
    antialiased, ///< edges are smoothed
    diffuse,     ///< ambient light, and the first light source by the angle at which it falls
    highlights,  ///< all light sources, and highlights
    rays         ///< shadows, mirrors and glass: the whole picture
};

inline constexpr std::array<EffectStep, 5> effect_steps = {
    EffectStep::flat,
    EffectStep::antialiased,
    EffectStep::diffuse,
    EffectStep::highlights,
    EffectStep::rays};

/// What changes from step to step: of the scene, and of the settings.
struct Effects {
    std::vector<PointLight> lights;
    std::vector<Material> materials;
    PictureSettings settings;
};

/// The effects of a step. Nothing is added that the scene and its settings do not have, so that the
/// last step is these themselves. A plain colour is DRF + ARF + SDI + SAN.
Effects effects_at(EffectStep step, const Effects& all);

/// Gives what has no material at all Material::fallback() as a material of its own, so that steps
/// can change it. Looks the same.
void give_fallback_material(Scene& scene);

/// Why a step cannot change the picture of any scene with these effects, for people ("there is one
/// light source, and no material has a highlight"); nothing where it can.
std::optional<std::string> why_unchanged(EffectStep step, const Effects& all);

} // namespace vera
