// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/math/color.h"
#include "vera/math/ray.h"
#include "vera/render/generations.h"
#include "vera/render/ray_terms.h"
#include "vera/scene/hit.h"
#include "vera/scene/material.h"
#include "vera/scene/surface.h"
#include "vera/shade/lighting.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace vera {

/// A surface that the way from a place to a light crosses, at t of that way: 0 at the place, 1 at
/// the light.
struct ShadowCrossing {
    double t = 0;
    FaceId face;
    Color tab; ///< the part of the light that it lets through; black: it blocks
};

/// What a light gives to a place, step by step as the lighting formula (VERA 2.3) has it.
struct LightAtPlace {
    double distance = 0;     ///< d, in units of the scene
    Vec3 to_light;           ///< L, unit
    double cos_normal = 0;   ///< L.N
    double cos_viewer = 0;   ///< L.R
    double cos_mirrored = 0; ///< L.S
    double highlight = 0;    ///< f(L.S), before it is squared
    bool behind = false;     ///< the surface itself is between: L.N <= 0, or it stands on the other
                             ///< side of the face than the viewer; then the light gives nothing
    Color intensity;         ///< of the light at the place, before visibility
    Color diffuse_drf;       ///< DRF's part of Dif before visibility
    Color diffuse_arf;       ///< ARF's part of Dif before visibility
    Color visibility = {1, 1, 1}; ///< 1 where nothing was asked: without SHADOWS, and where the
                                  ///< light gives nothing anyway
    LightTerms terms;             ///< Dif and Spk, visibility included

    std::optional<QueryRay> shadow_ray; ///< from the place, t = 0, to the light, t = 1, where asked
    QueryCounts counts;                 ///< what it took to answer that ray alone
    bool crossings_known = true; ///< false where the scene has more than most_listed primitives
    std::vector<ShadowCrossing> crossings; ///< in the order of t

    static constexpr std::uint64_t most_listed = std::uint64_t{1} << 24;
};

/// A ray of the tree, what it meets, and how the colour that it brings comes about.
struct RayNode {
    enum class Kind : std::uint8_t { view, mirrored, refracted, totally_reflected };

    Kind kind = Kind::view;
    std::size_t parent = 0;   ///< number of the node that sends it; of the root 0
    std::uint32_t level = 1;  ///< in the ray tree, at most RTDEPTH
    Color weight = {1, 1, 1}; ///< the part of its colour that reaches the picture
    QueryRay ray;             ///< the direction is a unit vector
    QueryCounts counts;       ///< what it took to answer the ray alone
    Hit hit;                  ///< not found: it leaves the scene
    SurfacePoint surface;     ///< where it meets a face; this and what follows only there
    Incidence incidence;      ///< the vectors and the cosine R.N of the formula
    const Material* material = nullptr;
    std::vector<LightAtPlace> lights; ///< in the order of the scene
    Color luminosity_san;             ///< R.N SAN
    LocalTerms local;                 ///< Amb, Dif, Spk and Slm
    bool is_last_level = false;       ///< rays that the material would send on are not followed
    std::optional<std::size_t> mirrored_ray; ///< number of the node; may be the refracted one too
    std::optional<std::size_t> refracted_ray;
    Color mirrored;  ///< Rfl
    Color refracted; ///< Rfr
    Color color;     ///< (((Amb + Dif) + Spk) + Slm) + Rfl) + Rfr; or the firmament
};

/// The ray tree of a view ray (VERA 1, figure 1f): each node before the rays that it sends, the
/// mirrored one and what that leads to before the refracted one.
struct RayTree {
    std::vector<RayNode> nodes;
    bool complete = true; ///< false: there would be more than most_nodes; colours are missing then

    static constexpr std::size_t most_nodes = 10'000;
};

/// How the colour of a ray comes about. Place by place, as lighting.h says it: the colours are
/// those of a GenerationTracer to the bit. Lists what stands before lights by asking every
/// primitive.
RayTree ray_tree(const TracedScene& traced, const QueryRay& ray);

/// The terms of the tree's first ray, by term_number(): those that a GenerationTracer finds, to the
/// bit.
std::vector<Color> ray_terms(const RayTree& tree, const RayTerms& terms);

} // namespace vera
