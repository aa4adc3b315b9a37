// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/layers.h"
#include "vera/drawing/paints.h"

#include <cstddef>
#include <functional>
#include <string>

namespace vera::detail {

/// What is written round layers and groups.
struct PageMarks {
    /// By the layer's number: the outlines' is 0, if there are any.
    std::function<std::string(std::size_t layer, const std::string& name)> begin_layer;
    std::string end_layer;
    /// In the order in which they are painted; what a group of depth 0 is part of is the layer
    /// alone.
    std::function<std::string(const std::string& name, std::size_t depth)> begin_group;
    std::string end_group;
};

/// Groups of a page that are told: viewers list them, and look for each in the list.
inline constexpr std::size_t most_page_groups = 1024;

/// The layers' names in their order.
std::vector<std::string> layer_names(const Layers& layers);

/// The drawing in the operators of a PDF page, which an EPS defines for itself (q cm rg RG cs scn
/// CS SCN w J j d re m l c h f S Q). Coordinates are whole numbers, in units of the lattice; where
/// there are gradients, of which number i is the pattern /Pi, they are in pixels. Groups are told
/// down to the depth to which there are no more than most_page_groups, and outlines without a group
/// by their id. Throws Cancelled.
std::string page_content(
    const Drawing& drawing,
    const DrawingSettings& settings,
    const Lattice& lattice,
    const Layers& layers,
    const Gradients& gradients,
    const PageMarks& marks,
    const Progress& progress,
    const CancelFlag* cancel);

} // namespace vera::detail
