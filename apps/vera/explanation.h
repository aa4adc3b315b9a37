// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/render/exposure.h"
#include "vera/render/picture_layers.h"
#include "vera/render/ray_tree.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "prepared_scene.h"
#include "ray_visits.h"
#include <nlohmann/json_fwd.hpp>

namespace vera {

/// A pixel, and how its colour comes about.
struct Explanation {
    const PreparedScene& prepared;
    const TracedScene& traced;
    std::string index; ///< what found the hits: "bvh", "grid" or "brute"
    std::optional<Exposure> exposure;
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    RayTree tree;
    std::vector<PictureLayer> layers;
    std::vector<LayerSample> samples; ///< of the layers, and of the rounding behind them
    std::vector<RayVisits> visits;    ///< of the tree's rays, where they were asked for; else none
};

/// The pixel's three bytes in a picture without antialiasing.
std::array<std::uint8_t, 3> picture_bytes(const Explanation& explanation);

/// What it is called in lists: "view ray", "mirrored ray".
const char* name_of(RayNode::Kind kind);

/// For people: aligned text of many lines.
std::string explanation_text(const Explanation& explanation);

/// See docs/json.md.
nlohmann::ordered_json explanation_json(const Explanation& explanation);

/// The rays of the tree in the scene, seen from aside, as an SVG text.
std::string
explanation_svg(const Explanation& explanation, const Progress& progress, const CancelFlag& cancel);

} // namespace vera
