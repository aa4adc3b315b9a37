// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/layers.h"
#include "vera/drawing/paints.h"

#include <cstddef>
#include <functional>
#include <string>

namespace vera::detail {

/// What is written round a layer, by its number: the outlines' is 0, if there are any.
struct LayerMarks {
    std::function<std::string(std::size_t layer, const std::string& name)> begin;
    std::string end;
};

/// The layers' names in their order.
std::vector<std::string> layer_names(const Layers& layers);

/// The drawing in the operators of a PDF page, which an EPS defines for itself (q cm rg RG cs scn
/// CS SCN w J j d re m l c h f S Q). Coordinates are whole numbers, in units of the lattice.
/// Gradient number i is the pattern /Pi. Throws Cancelled.
std::string page_content(
    const Drawing& drawing,
    const DrawingSettings& settings,
    const Lattice& lattice,
    const Layers& layers,
    const Gradients& gradients,
    const LayerMarks& marks,
    const Progress& progress,
    const CancelFlag* cancel);

} // namespace vera::detail
