// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"

#include <cstdint>
#include <string>

namespace vera {

/// Number of a material in Scene::materials.
enum class MaterialId : std::uint32_t {};

/// The material that is current where a subscene is called; in the main scene, none at all, which
/// looks like Material::fallback().
constexpr MaterialId inherited_material = MaterialId{0xffffffff};

/// MA name {DRF r g b | ARF r g b | SDI r g b | SAN r g b | RAB r g b | TAB r g b | SPC x | REF x}
/// The members have the names of the lighting formula (VERA 2.3).
struct Material {
    std::string name;
    Color drf;      ///< diffuse reflection that depends on the angle between light and surface
    Color arf;      ///< diffuse reflection that depends on the angle between light and viewer
    Color sdi;      ///< self-luminosity, the same in all directions
    Color san;      ///< self-luminosity, strongest towards the normal
    Color rab;      ///< part of the mirrored ray's colour
    Color tab;      ///< part of the refracted ray's colour
    double spc = 1; ///< cosine of the angle from the mirror direction at which a highlight ends
    double ref = 1; ///< index of refraction of the inside, > 0

    /// What stands for a missing material: DRF 0.7 0.7 0.7.
    static Material fallback() {
        Material material;
        material.drf = {0.7, 0.7, 0.7};
        return material;
    }
};

} // namespace vera
