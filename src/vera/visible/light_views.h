// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/math/vec3.h"
#include "vera/scene/facets.h"
#include "vera/scene/scene.h"
#include "vera/visible/cells.h"
#include "vera/visible/light_frames.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// How much of each facet a light sees. What lets light through hides nothing from it.
class LitFacets {
public:
    LitFacets(const Scene& scene, const Facets& facets);

    bool is_opaque(std::size_t facet) const { return (states_[facet] & opaque) != 0; }

    /// Only opaque ones are.
    bool is_seen(std::size_t facet) const { return (states_[facet] & seen) != 0; }

    bool is_wholly_seen(std::size_t facet) const {
        return (states_[facet] & (seen | hidden)) == seen;
    }

    /// Whether any view would show it if nothing was before it: it is not seen edge-on, smaller
    /// than a step of the view's grid, or nearer than that goes.
    bool is_shown(std::size_t facet) const { return (states_[facet] & shown) != 0; }

    /// Adds what one view of the light, whose sources are the facets, shows.
    void add(const ScreenScene& view, const Progress& progress, const CancelFlag* cancel);

private:
    enum State : std::uint8_t { opaque = 1, seen = 2, hidden = 4, shown = 8 };

    std::vector<std::uint8_t> states_; ///< hidden: a part of it is
};

/// What a light sees in one direction. The sources are the facets.
struct LightView {
    ScreenScene screen;      ///< opaque ones
    ScreenScene transparent; ///< the others
    Cells cells;             ///< of the opaque ones
};

struct LightViews {
    LitFacets lit;
    std::vector<LightView> views; ///< together of everything in the box
    double coarse_step = 0;       ///< the largest of those of the frames
    double cut_nearness = 0;      ///< what is so near, in the scene's units, they do not show; or 0
};

/// Of those facets that are looked at, by their numbers, and lie between the light and what the
/// frames show: those that light_frames() tells.
LightViews light_views(
    const Scene& scene,
    const Facets& facets,
    std::span<const std::uint32_t> looked_at,
    Vec3 position,
    std::span<const LightFrame> frames,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
